// From positions inside the pipeline (index * spacing) to coordinates of the output.
#pragma once

#include <array>

#include "isoweave/pipeline.hpp"
#include "lattice/vec3.hpp"

namespace isoweave {

class World {
 public:
  World() = default;  // leaves positions as they are

  // offset: that of the output; coordinates are relative to it.
  World(const Geometry& geometry, OutputSpace space, const std::array<double, 3>& offset = {0, 0, 0});

  // The world of a mesh that stays at its place and gets another offset.
  World(const std::array<double, 3>& before, const std::array<double, 3>& offset)
      : origin_{before[0] - offset[0], before[1] - offset[1], before[2] - offset[2]}, offset_(offset) {}

  const std::array<double, 3>& offset() const { return offset_; }

  Vec3 place(Vec3 p) const {
    return {dot(rows_[0], p) + origin_.x, dot(rows_[1], p) + origin_.y, dot(rows_[2], p) + origin_.z};
  }

  // The same in 32 bits.
  Point point(Vec3 p) const {
    const Vec3 at = place(p);
    return {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(at.z)};
  }

  // A triangle in the output, turned over where the world mirrors.
  std::array<Point, 3> triangle(const std::array<Vec3, 3>& p) const {
    return {point(p[0]), point(p[mirrors_ ? 2 : 1]), point(p[mirrors_ ? 1 : 2])};
  }

  // Normals are covectors: they turn with the inverse transpose, here by its multiple, the cofactors.
  Point normal(Point n) const;

  // A mirroring world needs triangles turned over to stay outward.
  bool mirrors() const { return mirrors_; }

 private:
  std::array<Vec3, 3> rows_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  std::array<Vec3, 3> cofactors_{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 origin_;  // relative to the offset
  std::array<double, 3> offset_{0, 0, 0};
  bool mirrors_ = false;
};

// The most by which rounding should move a vertex.
double most_rounding(const VolumeInfo& volume);

// How far rounding moves a vertex at the farthest corner of the volume, in 64 bits or in 32.
double rounding_of_places(const VolumeInfo& volume, OutputSpace space, bool to_64_bits);

}  // namespace isoweave
