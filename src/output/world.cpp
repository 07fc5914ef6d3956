#include "output/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "parallel/float_environment.hpp"

namespace isoweave {
namespace {

bool turns(const Geometry& geometry, OutputSpace space) {
  return (space == OutputSpace::kLps && geometry.space == Space::kRas) ||
         (space == OutputSpace::kRas && geometry.space == Space::kLps);
}

// The place of the first sample in the output.
std::array<double, 3> origin_in(const Geometry& geometry, OutputSpace space) {
  const auto& o = geometry.origin;
  if (space == OutputSpace::kIndex) return {0, 0, 0};
  return turns(geometry, space) ? std::array{-o[0], -o[1], o[2]} : o;
}

// Half the last place of a number of this size. A size beyond half the largest number counts as that.
template <class Real>
double half_last_place(double size) {
  const auto number = static_cast<Real>(std::min(size, double{std::numeric_limits<Real>::max()} / 2));
  return (double{std::nextafter(number, std::numeric_limits<Real>::infinity())} - double{number}) / 2;
}

// The farthest coordinate of a corner of the volume from 0, on any axis, where the first sample lies at `origin`.
double farthest_corner(const VolumeInfo& volume, const std::array<double, 3>& origin) {
  const Geometry& geometry = volume.geometry;
  double farthest = 0;
  for (std::size_t row = 0; row < 3; ++row) {
    double low = origin[row];
    double high = origin[row];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double along =
          geometry.direction[3 * row + axis] * geometry.spacing[axis] * static_cast<double>(volume.dims[axis]);
      (along < 0 ? low : high) += along;
    }
    farthest = std::max({farthest, std::abs(low), std::abs(high)});
  }
  return farthest;
}

}  // namespace

World::World(const Geometry& geometry, OutputSpace space, const std::array<double, 3>& offset) : offset_(offset) {
  const std::array<double, 3> origin = origin_in(geometry, space);
  origin_ = {origin[0] - offset[0], origin[1] - offset[1], origin[2] - offset[2]};
  if (space == OutputSpace::kIndex) return;
  const auto& d = geometry.direction;
  rows_ = {{{d[0], d[1], d[2]}, {d[3], d[4], d[5]}, {d[6], d[7], d[8]}}};
  if (turns(geometry, space)) {
    rows_[0] = -rows_[0];
    rows_[1] = -rows_[1];
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

double most_rounding(const VolumeInfo& volume) {
  constexpr double kPartOfSpacing = 1e-3;
  const auto& spacing = volume.geometry.spacing;
  return kPartOfSpacing * std::min({spacing[0], spacing[1], spacing[2]});
}

double rounding_of_places(const VolumeInfo& volume, OutputSpace space, bool to_64_bits) {
  const double farthest = farthest_corner(volume, origin_in(volume.geometry, space));
  return to_64_bits ? half_last_place<double>(farthest) : half_last_place<float>(farthest);
}

std::string space_of_mesh(const Geometry& volume, OutputSpace space) {
  if (space == OutputSpace::kIndex) return "index";
  if (volume.space == Space::kUnknown) return "";  // coordinates are those of the volume, whatever was asked for
  const bool as_lps = space == OutputSpace::kLps || (space == OutputSpace::kAsVolume && volume.space == Space::kLps);
  return as_lps ? "LPS" : "RAS";
}

std::array<double, 3> output_place(const VolumeInfo& volume, OutputSpace space, const std::array<double, 3>& index) {
  const StandardFloats floats;
  const auto& spacing = volume.geometry.spacing;
  const Vec3 at =
      World(volume.geometry, space).place({index[0] * spacing[0], index[1] * spacing[1], index[2] * spacing[2]});
  return {at.x, at.y, at.z};
}

// An offset is worth it where it removes most of the rounding. Else the volume is large, and not far away.
std::array<double, 3> mesh_offset(const VolumeInfo& volume, OutputSpace space) {
  const StandardFloats floats;
  constexpr double kLeft = 1.0 / 16;
  const double rounding = rounding_of_places(volume, space, false);
  const double left = half_last_place<float>(farthest_corner(volume, {0, 0, 0}));
  const bool is_far = rounding > most_rounding(volume) && left <= kLeft * rounding;
  return is_far ? origin_in(volume.geometry, space) : std::array<double, 3>{0, 0, 0};
}

}  // namespace isoweave
