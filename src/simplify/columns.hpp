// Columns of the volume, along z. The zone holds the vertices and triangles of a column side by side, and one worker
// decides the edges of a column one after the other, so that the column stays in a cache.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "lattice/vec3.hpp"

namespace isoweave {

class Columns {
 public:
  static constexpr std::uint32_t kAlong = 32;  // columns along x or y; then the numbers begin again
  static constexpr std::size_t kCount = std::size_t{kAlong} * kAlong;

  // a0: mean voxel face, length squared.
  explicit Columns(double a0) : per_length_(1 / (kSide * std::sqrt(a0))) {}

  // The column of a point: less than kCount for any point, as a mesh file may lie anywhere.
  std::uint32_t operator()(const Vec3& p) const { return part(p.x) + kAlong * part(p.y); }

 private:
  static constexpr double kSide = 24;                             // voxels
  static constexpr double kFar = double{std::uint64_t{1} << 40};  // columns

  std::uint32_t part(double p) const {
    const double number = p * per_length_ + kFar;
    const double positive = number > 0 ? number : 0;
    return static_cast<std::uint32_t>(static_cast<std::uint64_t>(positive < 2 * kFar ? positive : 0) % kAlong);
  }

  double per_length_;
};

}  // namespace isoweave
