// On which side of a plane, or of a line in a plane, a point lies: the exact sign for float32 coordinates, whatever
// they are. Double arithmetic decides where its error bound lets it, exact sums elsewhere (Shewchuk 1997, "Adaptive
// Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates").
#pragma once

#include <cstddef>

#include "isoweave/mesh.hpp"

namespace isoweave::measure {

// The sign of (b - a) x (c - a) . (d - a): 1 when d is where a, b, c are seen counter-clockwise, 0 when the four lie in
// one plane, -1 else.
int orientation(const Point& a, const Point& b, const Point& c, const Point& d);

// The sign of the area of a, b, c seen along an axis: 1 when they are counter-clockwise in the two axes that follow it.
int orientation_along(std::size_t axis, const Point& a, const Point& b, const Point& c);

}  // namespace isoweave::measure
