// The number of triangles at which a run stops.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace isoweave {

struct TriangleGoal {
  std::uint64_t triangles = 0;
  double share = 0;  // above 0: this share of all triangles, in place of a number

  bool given() const { return triangles > 0 || share > 0; }

  // The number for a surface of so many triangles: the nearest one to a share, and at least 1. 0: there is none.
  std::uint64_t of(std::uint64_t all) const {
    if (!(share > 0)) return triangles;
    return std::max<std::uint64_t>(static_cast<std::uint64_t>(std::llround(share * static_cast<double>(all))), 1);
  }
};

}  // namespace isoweave
