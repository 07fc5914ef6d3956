// Normals from differences of the samples, shared by host and device. `Samples` is any type that gives rows of samples.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "isoweave/mesh.hpp"
#include "lattice/vec3.hpp"
#include "parallel/annotations.hpp"

namespace isoweave {

// Whether doubles cannot hold all samples of a type.
template <class T>
inline constexpr bool kIsWide = std::is_integral_v<T> && sizeof(T) == 8;

// The number that wide samples are counted from, so that differences are exact before they are rounded.
template <class T>
struct SampleBase {
  ISOWEAVE_HD double number(T sample) const { return static_cast<double>(sample); }
};

template <class T>
requires kIsWide<T>
struct SampleBase<T> {
  T base = 0;

  ISOWEAVE_HD double number(T sample) const {
    const auto up = static_cast<std::uint64_t>(sample) - static_cast<std::uint64_t>(base);
    return sample >= base ? static_cast<double>(up) : -static_cast<double>(-up);
  }
};

// A row of samples; NaN outside the volume.
template <class T>
struct SampleRow {
  const T* samples = nullptr;
  std::int64_t size = 0;  // 0 for a row outside
  [[no_unique_address]] SampleBase<T> base{};

  ISOWEAVE_HD double operator[](std::int64_t i) const {
    if (static_cast<std::uint64_t>(i) >= static_cast<std::uint64_t>(size)) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    return base.number(samples[i]);
  }
};

// The difference of samples over two steps, a mean. It is over one step where a neighbour is missing or NaN, and 0
// where both are.
ISOWEAVE_HD inline double central_slope(double low, double here, double high, double spacing) {
  const bool has_low = low == low, has_high = high == high;
  const int steps = has_low + has_high;
  return steps > 0 ? ((has_high ? high : here) - (has_low ? low : here)) / (steps * spacing) : 0;
}

// The differences per unit length along the axes, of the samples times `scale`.
template <class Samples>
ISOWEAVE_HD inline Vec3 gradient_at(const Samples& samples, const std::array<std::int64_t, 3>& at,
                                    const std::array<double, 3>& spacing, double scale) {
  const double here = scale * samples.row(at[1], at[2])[at[0]];
  double slope[3] = {0, 0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<std::int64_t, 3> left = at, right = at;
    --left[axis];
    ++right[axis];
    const double low = scale * samples.row(left[1], left[2])[left[0]];
    const double high = scale * samples.row(right[1], right[2])[right[0]];
    slope[axis] = central_slope(low, here, high, spacing[axis]);
  }
  return {slope[0], slope[1], slope[2]};
}

// The vector at unit length, or zero when it has no direction.
ISOWEAVE_HD inline Point unit_point(Vec3 v) {
  const double largest = fmax(fabs(v.x), fmax(fabs(v.y), fabs(v.z)));
  if (!(largest > 0) || largest > std::numeric_limits<double>::max()) return {0, 0, 0};
  const Vec3 scaled = (1 / largest) * v;
  const double length = sqrt(dot(scaled, scaled));
  return {static_cast<float>(scaled.x / length), static_cast<float>(scaled.y / length),
          static_cast<float>(scaled.z / length)};
}

// A crossing between two samples: f0 at `low`, and f1 one step further along the axes of a direction.
struct Crossing {
  std::array<std::int64_t, 3> low;
  std::uint8_t direction;  // bits x, y, z
  double f0, f1;
  double t;  // where, from low on
  bool low_inside;

  ISOWEAVE_HD bool along(std::size_t axis) const { return (direction >> axis & 1) != 0; }
  ISOWEAVE_HD std::array<std::int64_t, 3> high() const {
    return {low[0] + (direction & 1), low[1] + (direction >> 1 & 1), low[2] + (direction >> 2)};
  }
};

// The gradient at a crossing, of the samples times `scale`.
template <class Samples>
ISOWEAVE_HD inline Vec3 crossing_gradient(const Samples& samples, const Crossing& crossing,
                                          const std::array<double, 3>& spacing, double scale) {
  const Vec3 g0 = gradient_at(samples, crossing.low, spacing, scale);
  return g0 + crossing.t * (gradient_at(samples, crossing.high(), spacing, scale) - g0);
}

// The normal of a cap, where the surface hugs the inside sample at one end of an edge: the cap faces along the axes on
// which the other end lies outside the volume, or along the edge where the other end is NaN.
template <class Samples>
ISOWEAVE_HD inline Point cap_normal(const Samples& samples, const Crossing& crossing) {
  const std::array<std::int64_t, 3> outside = crossing.low_inside ? crossing.high() : crossing.low;
  bool leaves[3];
  for (std::size_t axis = 0; axis < 3; ++axis) leaves[axis] = !samples.reaches(axis, outside[axis]);
  const bool any = leaves[0] || leaves[1] || leaves[2];
  const double step = crossing.low_inside ? 1 : -1;
  double normal[3];
  for (std::size_t axis = 0; axis < 3; ++axis) normal[axis] = (any ? leaves[axis] : crossing.along(axis)) ? step : 0;
  return unit_point({normal[0], normal[1], normal[2]});
}

ISOWEAVE_HD inline bool is_finite(Vec3 v) { return v.x - v.x == 0 && v.y - v.y == 0 && v.z - v.z == 0; }

// The normal at a crossing, outwards.
template <class Samples>
ISOWEAVE_HD inline Point normal_at(const Samples& samples, const Crossing& crossing,
                                   const std::array<double, 3>& spacing, bool above) {
  if ((crossing.f0 == crossing.f0) != (crossing.f1 == crossing.f1)) return cap_normal(samples, crossing);
  Vec3 g = crossing_gradient(samples, crossing, spacing, 1);
  if (!is_finite(g)) {  // a difference is beyond the largest number: directions are those of smaller samples
    constexpr double kSmall = 0x1p-124;
    const Vec3 small = crossing_gradient(samples, crossing, spacing, kSmall);
    if (is_finite(small)) g = small;
  }
  return unit_point(above ? -g : g);
}

// The mean of two differences that is 0 where they go apart and near the smaller one where they are far from alike: the
// harmonic mean (van Leer, 1974). Beside a sharp edge of the surface one of them crosses the edge, and the other does
// not.
inline double limited_slope(double down, double up) {
  if (down != down) return up == up ? up : 0;
  if (up != up) return down;
  return down * up > 0 ? 2 * (down * up / (down + up)) : 0;
}

// The normal at a crossing of an edge of a cube, outwards, from as few samples as tell it: those at the ends of the
// edge, and the places beside the crossing on the edges beside its own. Sharp edges of a surface stay sharp.
template <class Samples>
inline Point sharp_normal_at(const Samples& samples, const Crossing& crossing, const std::array<double, 3>& spacing,
                             bool above) {
  if ((crossing.f0 == crossing.f0) != (crossing.f1 == crossing.f1)) return cap_normal(samples, crossing);
  const auto at = [&](std::size_t axis, int step) {
    std::array<std::int64_t, 3> low = crossing.low, high = crossing.high();
    low[axis] += step;
    high[axis] += step;
    const double f0 = samples.row(low[1], low[2])[low[0]];
    return f0 + crossing.t * (samples.row(high[1], high[2])[high[0]] - f0);
  };
  const double here = crossing.f0 + crossing.t * (crossing.f1 - crossing.f0);
  std::array<double, 3> slope;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    slope[axis] =
        (crossing.along(axis) ? crossing.f1 - crossing.f0 : limited_slope(here - at(axis, -1), at(axis, 1) - here)) /
        spacing[axis];
  }
  const Vec3 gradient{slope[0], slope[1], slope[2]};
  return unit_point(above ? -gradient : gradient);
}

// The normal at a place inside the cell that begins with a sample, outwards: the gradients at its corners, weighed.
// Zero where one of them is no number.
template <class Samples>
inline Point cell_normal(const Samples& samples, const std::array<std::int64_t, 3>& low, const Vec3& at,
                         const std::array<double, 3>& spacing, bool above) {
  Vec3 sum;
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    const double weight = (x != 0 ? at.x : 1 - at.x) * (y != 0 ? at.y : 1 - at.y) * (z != 0 ? at.z : 1 - at.z);
    sum = sum + weight * gradient_at(samples, {low[0] + x, low[1] + y, low[2] + z}, spacing, 1);
  }
  if (!is_finite(sum)) return {0, 0, 0};
  return unit_point(above ? -sum : sum);
}

}  // namespace isoweave
