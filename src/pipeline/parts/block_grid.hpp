// The grids that cut space into blocks, stage after stage.
//
// Undecided triangles of a stage lie near the planes of its grid. The grids of the second to the fourth stage are
// shifted by a half, a quarter and three quarters of a block, so that triangles at a plane of one grid lie inside the
// blocks of another. The blocks of each later stage are twice as large, up to one that holds the whole surface: chains
// of decisions may be as long.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/lattice.hpp"

namespace isoweave {

// The number of a block along each axis.
using BlockIndex = std::array<std::int64_t, 3>;

struct BlockGrid {
  std::int64_t size = 1;                       // cells along each axis
  std::array<std::int64_t, 3> first{0, 0, 0};  // the cell at which block (0, 0, 0) begins

  // The block of cell or lattice point `at` of an axis, and where a block begins.
  std::int64_t block_of(std::size_t axis, std::int64_t at) const {
    const std::int64_t from = at - first[axis];
    return from >= 0 ? from / size : -((size - 1 - from) / size);
  }
  std::int64_t begin(std::size_t axis, std::int64_t block) const { return first[axis] + block * size; }

  BlockIndex block_of(const std::array<std::int64_t, 3>& point) const {
    return {block_of(0, point[0]), block_of(1, point[1]), block_of(2, point[2])};
  }

  // The cells of a block, of those in `all`.
  CellBox cells(const BlockIndex& block, const CellBox& all) const;
};

// The grids of all stages over `all` cells, for blocks of a size, one of which begins at cell `first`.
std::vector<BlockGrid> stage_grids(const CellBox& all, std::int64_t size, const std::array<std::int64_t, 3>& first);

}  // namespace isoweave
