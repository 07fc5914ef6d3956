// Bounds on how far the faces that a collapse leaves are from the extracted surface.
#pragma once

#include <array>
#include <cstddef>

#include "simplify/star.hpp"

namespace isoweave {

// Calls visit(triangle, a, b) for the faces that stay when two ends merge, with their corners besides the merged
// vertex, until visit() answers false: first for those of u, then for those of v.
template <class Visit>
void each_staying_face(const Star& u, const Star& v, const Visit& visit) {
  for (const Star* star : {&u, &v}) {
    const Index gone = star == &u ? v.vertex : u.vertex;
    for (std::size_t n = 0; n < static_cast<std::size_t>(star->faces); ++n) {
      const Index a = star->neighbour[n];
      const Index b = star->neighbour[n + 1 < star->count() ? n + 1 : 0];
      if (a != gone && b != gone && !visit(star->out[n] >> 2, a, b)) return;
    }
  }
}

// The bounds of the faces that stay, in that order.
using FaceBounds = std::array<FaceBound, Star::kRoom>;

// Gives the faces that stay their bounds.
inline void keep_bounds(const ZoneView& zone, const Star& u, const Star& v, const FaceBounds& bounds) {
  std::size_t n = 0;
  each_staying_face(u, v, [&](Index triangle, Index, Index) {
    zone.triangles[triangle].bound = bounds[n++];
    return true;
  });
}

}  // namespace isoweave
