// Bounds on how far the faces that a collapse leaves are from the extracted surface.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "simplify/star.hpp"

namespace isoweave {

// Calls visit(side, a, b) for the faces that stay when two ends merge, until visit() answers false: first for those of
// u, then for those of v. side: the half-edge that starts at the end. a, b: the corners after it.
template <class Visit>
void each_staying_face(const Star& u, const Star& v, const Visit& visit) {
  for (const Star* star : {&u, &v}) {
    const Index gone = star == &u ? v.vertex : u.vertex;
    for (std::size_t n = 0; n < static_cast<std::size_t>(star->faces); ++n) {
      const Index a = star->neighbour[n];
      const Index b = star->neighbour[n + 1 < star->count() ? n + 1 : 0];
      if (a != gone && b != gone && !visit(star->out[n], a, b)) return;
    }
  }
}

// Bounds at the corners of a face that stays, in units: at the merged vertex, and at the two corners after it.
struct FaceBound {
  double merged, a, b;

  double most() const { return std::max({merged, a, b}); }
};

// The bounds of the faces that stay, in that order.
using FaceBounds = std::array<FaceBound, Star::kRoom>;

inline CornerBound bound_at(const ZoneView& zone, Index h) { return zone.triangles[h >> 2].bounds[h & 3]; }

// Rounding of bounds, in units: heights that are 0 but for rounding are not to add up.
inline constexpr double kBoundRounding = 1e-6;

// Rounds a bound up.
inline CornerBound to_bound(double bound) {
  return static_cast<CornerBound>(std::ceil(std::min(bound, double{kBoundUnits}) - kBoundRounding));
}

// Gives the faces that stay their bounds.
inline void keep_bounds(const ZoneView& zone, const Star& u, const Star& v, const FaceBounds& bounds) {
  std::size_t n = 0;
  each_staying_face(u, v, [&](Index side, Index, Index) {
    const FaceBound& bound = bounds[n++];
    std::array<CornerBound, 3>& of = zone.triangles[side >> 2].bounds;
    of[side & 3] = to_bound(bound.merged);
    of[next(side) & 3] = to_bound(bound.a);
    of[previous(side) & 3] = to_bound(bound.b);
    return true;
  });
}

}  // namespace isoweave
