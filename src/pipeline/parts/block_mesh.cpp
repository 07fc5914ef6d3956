#include "pipeline/parts/block_mesh.hpp"

#include <limits>
#include <stdexcept>
#include <string>

#include "isoweave/error.hpp"
#include "pipeline/back_end.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kLeastBlock = 8;

}  // namespace

Task resolve_blocks(const SliceSource& volume, const MeshOptions& options, const BlockOptions& blocks,
                    const RunControl& control, const std::array<double, 3>& offset) {
  require_possible(RunKind::kBlocks, options, control);
  if (blocks.size < kLeastBlock) {
    throw std::invalid_argument("blocks: expected a size of " + std::to_string(kLeastBlock) + " or more, found " +
                                std::to_string(blocks.size));
  }
  if (!volume.skips()) {
    throw BadInput(volume.info().path +
                   ": expected a volume that can be read anywhere, for blocks, found one that has "
                   "to be read from its beginning: unpack it first");
  }
  return resolve(volume.info(), options, control, offset, RunKind::kBlocks);
}

PartShape cut_part_shape(const SimplifyTask& task) {
  PartShape shape = part_shape(task);
  shape.ends.assign(task.level_costs.size() + 1, {kNotHandedOver, std::numeric_limits<std::uint32_t>::max()});
  return shape;
}

// Stage 0 has blocks of cells, the others of lattice points.
BlockIndex BlockStages::counts(std::size_t stage) const {
  BlockIndex counts;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t last = stage == 0 ? all.end[axis] - 1 : all.end[axis];
    counts[axis] = grids[stage].block_of(axis, last) - first_block(stage)[axis] + 1;
  }
  return counts;
}

BlockIndex BlockStages::block(std::size_t stage, std::uint64_t number) const {
  const BlockIndex first = first_block(stage);
  const BlockIndex each = counts(stage);
  const auto n = static_cast<std::int64_t>(number);
  return {first[0] + n % each[0], first[1] + n / each[0] % each[1], first[2] + n / each[0] / each[1]};
}

std::uint64_t BlockStages::number(std::size_t stage, const BlockIndex& block) const {
  const BlockIndex first = first_block(stage);
  const BlockIndex each = counts(stage);
  return static_cast<std::uint64_t>(((block[2] - first[2]) * each[1] + (block[1] - first[1])) * each[0] +
                                    (block[0] - first[0]));
}

TaskList BlockStages::tasks() const {
  TaskList list;
  for (std::size_t stage = 0; stage < grids.size(); ++stage) {
    const BlockIndex each = counts(stage);
    list.stages.push_back(static_cast<std::uint64_t>(each[0] * each[1] * each[2]));
  }
  return list;
}

std::uint64_t TaskList::count() const { return first_of(stages.size()); }

std::uint64_t TaskList::first_of(std::size_t stage) const {
  std::uint64_t first = 0;
  for (std::size_t n = 0; n < stage; ++n) first += stages[n];
  return first;
}

std::size_t TaskList::stage_of(std::uint64_t task) const {
  std::size_t stage = 0;
  for (std::uint64_t end = 0; stage < stages.size(); ++stage) {
    end += stages[stage];
    if (task < end) return stage;
  }
  throw std::invalid_argument("task: expected a number below " + std::to_string(count()) + ", found " +
                              std::to_string(task));
}

}  // namespace isoweave
