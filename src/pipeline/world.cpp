#include "pipeline/world.hpp"

#include <cmath>

namespace isoweave {

World::World(const Geometry& geometry, OutputSpace space) {
  if (space == OutputSpace::kIndex) return;
  const auto& d = geometry.direction;
  const auto& o = geometry.origin;
  rows_ = {{{d[0], d[1], d[2]}, {d[3], d[4], d[5]}, {d[6], d[7], d[8]}}};
  origin_ = {o[0], o[1], o[2]};
  const bool turn = (space == OutputSpace::kLps && geometry.space == Space::kRas) ||
                    (space == OutputSpace::kRas && geometry.space == Space::kLps);
  if (turn) {
    rows_[0] = -rows_[0];
    rows_[1] = -rows_[1];
    origin_ = {-origin_.x, -origin_.y, origin_.z};
  }
  cofactors_ = {{cross(rows_[1], rows_[2]), cross(rows_[2], rows_[0]), cross(rows_[0], rows_[1])}};
  mirrors_ = dot(rows_[0], cofactors_[0]) < 0;
  if (mirrors_) {
    for (Vec3& row : cofactors_) row = -row;
  }
}

Point World::normal(Point n) const {
  const Vec3 v{n[0], n[1], n[2]};
  const Vec3 turned{dot(cofactors_[0], v), dot(cofactors_[1], v), dot(cofactors_[2], v)};
  const double length = std::sqrt(dot(turned, turned));
  if (!(length > 0)) return {0, 0, 0};
  return {static_cast<float>(turned.x / length), static_cast<float>(turned.y / length),
          static_cast<float>(turned.z / length)};
}

}  // namespace isoweave
