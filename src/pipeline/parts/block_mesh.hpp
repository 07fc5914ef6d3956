// A mesh in blocks, resolved: its task, its grids, and the numbers of its blocks.
#pragma once

#include <cstdint>
#include <memory>

#include "isoweave/tasks.hpp"
#include "pipeline/parts/block_grid.hpp"
#include "pipeline/parts/task_file.hpp"
#include "pipeline/task.hpp"

namespace isoweave {

// Resolves a mesh in blocks of a volume. Throws what mesh_in_blocks throws for its options and its volume.
Task resolve_blocks(const SliceSource& volume, const MeshOptions& options, const BlockOptions& blocks,
                    const RunControl& control, const std::array<double, 3>& offset);

// The shape of the parts of a task's surface, whatever has been handed over so far.
PartShape cut_part_shape(const SimplifyTask& task);

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

  TaskList tasks() const;

  CellBox all;
  std::vector<BlockGrid> grids;
};

}  // namespace isoweave
