// Normals and values of vertices.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "isoweave/mesh.hpp"
#include "plain_rules/quadrics.hpp"

namespace isoweave::plain {

// Zero where there is no direction.
inline Point unit_normal(const Vector& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0) || largest > std::numeric_limits<double>::max()) return {0, 0, 0};
  const Vector scaled = (1 / largest) * v;
  const double size = length(scaled);
  return {static_cast<float>(scaled[0] / size), static_cast<float>(scaled[1] / size),
          static_cast<float>(scaled[2] / size)};
}

// What is not a number has no say.
inline double value_between(double a, double b, double t) {
  if (std::isnan(a)) return b;
  if (std::isnan(b)) return a;
  const double value = a + t * (b - a);
  if (std::isfinite(value) || std::isinf(a) || std::isinf(b)) return value;
  return (1 - t) * a + t * b;
}

}  // namespace isoweave::plain
