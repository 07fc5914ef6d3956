#include "pipeline/parts/block_grid.hpp"

#include <algorithm>

namespace isoweave {

CellBox BlockGrid::cells(const BlockIndex& block, const CellBox& all) const {
  CellBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.first[axis] = std::max(begin(axis, block[axis]), all.first[axis]);
    box.end[axis] = std::min(begin(axis, block[axis] + 1), all.end[axis]);
  }
  return box;
}

std::vector<BlockGrid> stage_grids(const CellBox& all, std::int64_t size, const std::array<std::int64_t, 3>& first) {
  std::vector<BlockGrid> grids;
  const auto add = [&](std::int64_t block, std::int64_t shift) {
    grids.push_back({block, {first[0] + shift, first[1] + shift, first[2] + shift}});
  };
  for (const std::int64_t quarters : {0, 2, 1, 3}) add(size, quarters * size / 4);
  std::int64_t longest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) longest = std::max(longest, all.end[axis] - all.first[axis] + 1);
  for (std::int64_t block = 2 * size; block < longest; block *= 2) add(block, block / 2);
  grids.push_back({longest, all.first});
  return grids;
}

}  // namespace isoweave
