// How far a point is from a triangle.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lattice/vec3.hpp"

namespace isoweave {

// The distance of a point from a triangle, which may have no area: that from the plane where the point lies above or
// below the triangle, else that from the nearest side.
inline double distance(const Vec3& p, const std::array<Vec3, 3>& triangle) {
  const Vec3 normal = cross(triangle[1] - triangle[0], triangle[2] - triangle[0]);
  const double size = dot(normal, normal);
  bool above = size > 0;
  double nearest = std::numeric_limits<double>::infinity();  // squared
  for (std::size_t n = 0; n < 3; ++n) {
    const Vec3 side = triangle[(n + 1) % 3] - triangle[n];
    const Vec3 from = p - triangle[n];
    above = above && dot(from, cross(normal, side)) >= 0;
    const double length = dot(side, side);
    const double along = length > 0 ? std::clamp(dot(from, side) / length, 0.0, 1.0) : 0;
    const Vec3 rest = from - along * side;
    nearest = std::min(nearest, dot(rest, rest));
  }
  return above ? std::abs(dot(p - triangle[0], normal)) / std::sqrt(size) : std::sqrt(nearest);
}

}  // namespace isoweave
