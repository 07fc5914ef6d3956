// The triangulation of a polygon whose diagonals are shortest: of all that only use allowed diagonals, the one with the
// least sum of their squared lengths, by dynamic programming (Klincsek, 1980). Shared by host and device.
//
// The choice depends on the polygon's geometry alone. So a surface has no preferred direction, and a volume whose axes
// are permuted gives the permuted surface, but for sums that tie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "lattice/vec3.hpp"
#include "parallel/annotations.hpp"

namespace isoweave {

ISOWEAVE_HD inline double squared_distance(const Vec3& a, const Vec3& b) { return dot(a - b, a - b); }

// For polygons of 3 to kMost corners, numbered around it.
template <std::size_t kMost>
class ShortestDiagonals {
 public:
  // weigh(a, b): the squared length of the diagonal from corner a to b, or infinity where it is not allowed.
  template <class Weigh>
  ISOWEAVE_HD ShortestDiagonals(std::size_t size, const Weigh& weigh) : size_(size) {
    for (std::size_t a = 0; a + 1 < size; ++a) sums_[a][a + 1] = 0;
    for (std::size_t span = 2; span < size; ++span) {
      for (std::size_t a = 0; a + span < size; ++a) cut(a, a + span, span + 1 < size ? weigh(a, a + span) : 0);
    }
  }

  // Whether allowed diagonals triangulate the polygon.
  ISOWEAVE_HD bool exist() const { return sums_[0][size_ - 1] < std::numeric_limits<double>::infinity(); }

  // Calls see(a, b, c) for the corners of every triangle, in the order around the polygon.
  template <class See>
  ISOWEAVE_HD void for_each_triangle(const See& see) const {
    std::size_t left[kMost][2];
    std::size_t count = 0;
    const auto push = [&](std::size_t a, std::size_t c) {
      if (c - a < 2) return;
      left[count][0] = a;
      left[count++][1] = c;
    };
    push(0, size_ - 1);
    while (count > 0) {
      const std::size_t a = left[--count][0];
      const std::size_t c = left[count][1];
      const std::size_t b = apexes_[a][c];
      see(a, b, c);
      push(b, c);
      push(a, b);
    }
  }

 private:
  // Finds the best apex of the triangle at the diagonal, or side, from a to c. There is no branch, as the best one
  // cannot be predicted.
  ISOWEAVE_HD void cut(std::size_t a, std::size_t c, double weight) {
    double best = std::numeric_limits<double>::infinity();
    std::size_t apex = a + 1;
    for (std::size_t b = a + 1; b < c; ++b) {
      const double sum = sums_[a][b] + sums_[b][c];
      const bool is_less = sum < best;
      best = is_less ? sum : best;
      apex += (b - apex) & (std::size_t{0} - std::size_t{is_less});
    }
    sums_[a][c] = best + weight;
    apexes_[a][c] = static_cast<std::uint8_t>(apex);
  }

  std::size_t size_;
  double sums_[kMost][kMost];
  std::uint8_t apexes_[kMost][kMost];
};

}  // namespace isoweave
