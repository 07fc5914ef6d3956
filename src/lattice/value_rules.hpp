// Values that vertices carry: shared by host and device.
#pragma once

#include "lattice/vec3.hpp"
#include "parallel/annotations.hpp"

namespace isoweave {

ISOWEAVE_HD inline bool is_infinite(double x) { return x == x && x - x != 0; }

// The linear interpolation from a at 0 to b at 1. Where one of the two is NaN the other one counts.
ISOWEAVE_HD inline double value_between(double a, double b, double t) {
  if (a != a) return b;
  if (b != b) return a;
  const double value = a + t * (b - a);
  if (value - value == 0) return value;
  return is_infinite(a) || is_infinite(b) ? value : (1 - t) * a + t * b;  // the difference is beyond the largest number
}

// The place of x along an edge, from 0 to 1. Both vectors are measured from the edge's beginning.
ISOWEAVE_HD inline double place_along(const Vec3& edge, const Vec3& x) {
  const double squared = dot(edge, edge);
  if (!(squared > 0)) return 0.5;
  const double t = dot(x, edge) / squared;
  return t < 0 ? 0 : t > 1 ? 1 : t;
}

}  // namespace isoweave
