// Normals from differences of the samples.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "isoweave/mesh.hpp"
#include "slab/slice_window.hpp"
#include "slab/vec3.hpp"

namespace isoweave {

// A row of samples; NaN outside the volume.
template <class T>
struct SampleRow {
  const T* samples = nullptr;
  std::int64_t size = 0;  // 0 for a row outside

  double operator[](std::int64_t i) const {
    if (static_cast<std::uint64_t>(i) >= static_cast<std::uint64_t>(size)) return std::nan("");
    return static_cast<double>(samples[i]);
  }
};

// Read access to the samples a window holds; NaN outside the volume.
template <class T>
class SampleView {
 public:
  explicit SampleView(const SliceWindow& window) : window_(window), dims_(window.info().dims) {}

  SampleRow<T> row(std::int64_t j, std::int64_t k) const {
    if (j < 0 || k < 0 || j >= dims_[1] || k >= dims_[2]) return {};
    return {reinterpret_cast<const T*>(window_.slice(k)) + j * dims_[0], dims_[0]};
  }

  double operator()(std::int64_t i, std::int64_t j, std::int64_t k) const { return row(j, k)[i]; }

  // Central difference per unit length, one-sided where a neighbour is missing or NaN, 0 where both are.
  Vec3 gradient(std::array<std::int64_t, 3> at, const std::array<double, 3>& spacing) const {
    const double here = (*this)(at[0], at[1], at[2]);
    std::array<double, 3> slope{0, 0, 0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<std::int64_t, 3> left = at, right = at;
      --left[axis];
      ++right[axis];
      const double low = (*this)(left[0], left[1], left[2]);
      const double high = (*this)(right[0], right[1], right[2]);
      const bool has_low = low == low, has_high = high == high;
      const int steps = has_low + has_high;
      if (steps > 0) slope[axis] = ((has_high ? high : here) - (has_low ? low : here)) / (steps * spacing[axis]);
    }
    return {slope[0], slope[1], slope[2]};
  }

 private:
  const SliceWindow& window_;
  std::array<std::int64_t, 3> dims_;
};

// Unit length, or zero when there is no direction.
inline Point unit_point(Vec3 v) {
  const double largest = std::fmax(std::fabs(v.x), std::fmax(std::fabs(v.y), std::fabs(v.z)));
  if (!(largest > 0) || std::isinf(largest)) return {0, 0, 0};
  const Vec3 scaled = (1 / largest) * v;
  const double length = std::sqrt(dot(scaled, scaled));
  return {static_cast<float>(scaled.x / length), static_cast<float>(scaled.y / length),
          static_cast<float>(scaled.z / length)};
}

}  // namespace isoweave
