#include "pipeline/parts/block_mesh.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "isoweave/error.hpp"
#include "pipeline/back_end.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kLeastBlock = 8;

}  // namespace

void check_blocks(const SliceSource& volume, const BlockOptions& blocks) {
  if (blocks.size < kLeastBlock) {
    throw std::invalid_argument("blocks: expected a size of " + std::to_string(kLeastBlock) + " or more, found " +
                                std::to_string(blocks.size));
  }
  require_skipping(volume);
}

Task resolve_blocks(RunKind kind, const SliceSource& volume, const MeshOptions& options, const BlockOptions& blocks,
                    const RunControl& control, const std::array<double, 3>& offset) {
  require_possible(kind, options, control);
  check_blocks(volume, blocks);
  return resolve(volume.info(), options, control, offset, kind);
}

void check_memory_of_blocks(const Task& task, const RunControl& control, std::int64_t size) {
  const std::uint64_t found = control.memory > 0 ? system::resident_bytes() : 0;
  if (found <= control.memory) return;
  throw OverMemory(task.volume.path + ": expected the process to stay below " + std::to_string(control.memory) +
                   " bytes, found " + std::to_string(found) + ": blocks of " + std::to_string(size) +
                   " cells take more here");
}

TaskIdentity identity_of_tasks(const TaskMesh& mesh, const Task& task) {
  return {identity_of(task), mesh.blocks.size, mesh.blocks.first,
          task.simplify.goal.given() ? head_start_cost(mesh.head_start, task.volume) : kUnknownCost};
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

BlockIndex BlockRange::nearest(BlockIndex block) const {
  for (std::size_t axis = 0; axis < 3; ++axis) block[axis] = std::clamp(block[axis], first[axis], last[axis]);
  return block;
}

BlockRange BlockStages::takers(std::size_t stage, const BlockIndex& block) const {
  BlockRange range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [first, last] = points(stage, axis, block[axis]);
    range.first[axis] = grids[stage + 1].block_of(axis, first);
    range.last[axis] = grids[stage + 1].block_of(axis, last);
  }
  return range;
}

BlockRange BlockStages::givers(std::size_t stage, const BlockIndex& block) const {
  BlockRange range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto [first, last] = points(stage, axis, block[axis]);
    if (stage == 1) {  // blocks of cells: the last lattice points of one are the first ones of the next
      first = std::max(first - 1, all.first[axis]);
      last = std::min(last, all.end[axis] - 1);
    }
    range.first[axis] = grids[stage - 1].block_of(axis, first);
    range.last[axis] = grids[stage - 1].block_of(axis, last);
  }
  return range;
}

std::pair<std::int64_t, std::int64_t> BlockStages::points(std::size_t stage, std::size_t axis,
                                                          std::int64_t block) const {
  const std::int64_t end = grids[stage].begin(axis, block + 1);
  return {std::max(grids[stage].begin(axis, block), all.first[axis]),
          std::min(stage == 0 ? end : end - 1, all.end[axis])};
}

std::vector<std::uint64_t> BlockStages::takers_of(std::uint64_t task) const {
  const TaskList list = tasks();
  const std::size_t stage = list.stage_of(task);
  if (stage + 1 == grids.size()) return {};
  return tasks_of(stage + 1, takers(stage, block(stage, task - list.first_of(stage))));
}

std::vector<std::uint64_t> BlockStages::givers_of(std::uint64_t task) const {
  const TaskList list = tasks();
  const std::size_t stage = list.stage_of(task);
  if (stage == 0) return {};
  return tasks_of(stage - 1, givers(stage, block(stage, task - list.first_of(stage))));
}

std::vector<std::uint64_t> BlockStages::tasks_of(std::size_t stage, const BlockRange& range) const {
  std::vector<std::uint64_t> tasks;
  const std::uint64_t first = this->tasks().first_of(stage);
  for (std::int64_t z = range.first[2]; z <= range.last[2]; ++z) {
    for (std::int64_t y = range.first[1]; y <= range.last[1]; ++y) {
      for (std::int64_t x = range.first[0]; x <= range.last[0]; ++x) tasks.push_back(first + number(stage, {x, y, z}));
    }
  }
  return tasks;
}

bool BlockStages::may_have_surface(const CellBox& cells) const {
  bool touches = !cells.empty();
  for (std::size_t axis = 0; inside && axis < 3; ++axis) {
    touches = touches && cells.first[axis] < inside->end[axis] && cells.end[axis] >= inside->first[axis];
  }
  return touches;
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
