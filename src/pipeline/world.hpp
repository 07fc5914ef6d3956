// From positions inside the pipeline (index * spacing) to coordinates of the output.
#pragma once

#include <array>

#include "isoweave/pipeline.hpp"
#include "slab/vec3.hpp"

namespace isoweave {

class World {
 public:
  World() = default;  // leaves positions as they are
  World(const Geometry& geometry, OutputSpace space);

  Point point(Vec3 p) const {
    return {static_cast<float>(dot(rows_[0], p) + origin_.x), static_cast<float>(dot(rows_[1], p) + origin_.y),
            static_cast<float>(dot(rows_[2], p) + origin_.z)};
  }

  // Turned over where the world mirrors.
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
  Vec3 origin_;
  bool mirrors_ = false;
};

}  // namespace isoweave
