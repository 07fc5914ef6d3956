// A mesh in blocks, resolved: its task, its grids, and the numbers of its blocks.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "isoweave/tasks.hpp"
#include "pipeline/parts/block_grid.hpp"
#include "pipeline/parts/task_file.hpp"
#include "pipeline/task.hpp"

namespace isoweave {

// Resolves a mesh in blocks of a volume, by one process or several. Throws what mesh_in_blocks throws for its options
// and its volume.
Task resolve_blocks(RunKind kind, const SliceSource& volume, const MeshOptions& options, const BlockOptions& blocks,
                    const RunControl& control, const std::array<double, 3>& offset);

// Refuses blocks that are too small, and a volume that has to be read from its beginning. Throws std::invalid_argument
// and BadInput.
void check_blocks(const SliceSource& volume, const BlockOptions& blocks);

// The mesh that the files of tasks belong to.
TaskIdentity identity_of_tasks(const TaskMesh& mesh, const Task& task);

// The shape of the parts of a task's surface, whatever has been handed over so far.
PartShape cut_part_shape(const SimplifyTask& task);

// Ends a run in blocks of a size that has gone beyond its cap: slabs are chosen for it, but a block of a later stage is
// as large as it is. Throws OverMemory.
void check_memory_of_blocks(const Task& task, const RunControl& control, std::int64_t size);

// The blocks of a stage from one to another along each axis.
struct BlockRange {
  BlockIndex first{}, last{};

  // The block itself, or the nearest one in the range.
  BlockIndex nearest(BlockIndex block) const;
};

// The grids of the stages of a task.
struct BlockStages {
  BlockStages(const Task& task, const BlockOptions& blocks)
      : all(CellBox::of_volume(task.volume.dims, task.surface.closed)),
        grids(stage_grids(
            all, blocks.size,
            {all.first[0] + blocks.first[0], all.first[1] + blocks.first[1], all.first[2] + blocks.first[2]})) {}

  // The first block of a stage, and how many there are along each axis.
  BlockIndex first_block(std::size_t stage) const { return grids[stage].block_of(all.first); }
  BlockIndex counts(std::size_t stage) const;

  // A block of a stage by its number, and its number.
  BlockIndex block(std::size_t stage, std::uint64_t number) const;
  std::uint64_t number(std::size_t stage, const BlockIndex& block) const;

  // The blocks of the next stage that a block leaves triangles to, and those of the stage before that leave it some:
  // blocks that have a lattice point in common with it.
  BlockRange takers(std::size_t stage, const BlockIndex& block) const;
  BlockRange givers(std::size_t stage, const BlockIndex& block) const;

  // The same of a task, as tasks, ascending.
  std::vector<std::uint64_t> takers_of(std::uint64_t task) const;
  std::vector<std::uint64_t> givers_of(std::uint64_t task) const;

  TaskList tasks() const;

  // Whether blocks of cells may have some surface: whether they touch a box of samples.
  bool may_have_surface(const CellBox& cells) const;

  CellBox all;
  std::vector<BlockGrid> grids;
  std::optional<Region> inside{};  // samples; those beside the box are all outside

 private:
  std::vector<std::uint64_t> tasks_of(std::size_t stage, const BlockRange& range) const;

  // The first and the last lattice point of a block along an axis, of those there are.
  std::pair<std::int64_t, std::int64_t> points(std::size_t stage, std::size_t axis, std::int64_t block) const;
};

}  // namespace isoweave
