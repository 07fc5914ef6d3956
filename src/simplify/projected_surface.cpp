#include "simplify/projected_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace isoweave {
namespace {

using measure::operator-;
using measure::operator*;
using measure::cross;
using measure::dot;
using measure::Vector;
using measure::vector_of;

constexpr double kLeastSine = 1e-3;  // of the first corner of a face
constexpr double kSeenSlack = 1e-9;  // of lengths, for rounding

}  // namespace

bool ProjectedSurface::look_at(const Corners& face) {
  const Vector side = face[1] - face[0];
  const Vector other = face[2] - face[0];
  const Vector normal = cross(side, other);
  const double size = dot(normal, normal);
  if (!(size > kLeastSine * kLeastSine * dot(side, side) * dot(other, other))) return false;
  origin_ = face[0];
  across_ = (1 / std::sqrt(dot(side, side))) * side;
  up_ = (1 / std::sqrt(size)) * normal;
  along_ = cross(up_, across_);
  clear();
  return true;
}

bool ProjectedSurface::add(const Vec3& a, const Vec3& b, const Vec3& c) {
  if (triangles_.count == SeenTriangles::kRoom) return false;
  const std::size_t at = triangles_.count++;
  std::size_t n = 0;
  for (const Vec3* const corner : {&a, &b, &c}) {
    const Vector from = vector_of(*corner) - origin_;
    triangles_.x[n][at] = dot(from, across_);
    triangles_.y[n][at] = dot(from, along_);
    triangles_.height[n++][at] = dot(from, up_);
  }
  return true;
}

SeenPart ProjectedSurface::seen_part(const Corners& corners, double most) const {
  SeenPart part{};
  part.most = most;
  for (std::size_t n = 0; n < 3; ++n) {
    const Vector from = corners[n] - origin_;
    part.x[n] = dot(from, across_);
    part.y[n] = dot(from, along_);
  }
  part.set_sides();
  for (std::size_t n = 0; n < 3; ++n) {
    part.slack = std::max(part.slack, kSeenSlack * (std::abs(part.left_x[n]) + std::abs(part.left_y[n])));
  }
  return part;
}

// Cuts the polygon at a side of the part, and keeps the piece to the left.
ProjectedSurface::Polygon ProjectedSurface::Polygon::left_of(std::size_t side) const {
  Polygon cut;
  for (std::size_t n = 0; n < count; ++n) {
    const Corner& a = corners[n];
    const Corner& b = corners[n + 1 < count ? n + 1 : 0];
    const double at_a = a.left[side];
    const double at_b = b.left[side];
    if (at_a >= 0) cut.add(a);
    if ((at_a >= 0) == (at_b >= 0)) continue;
    const double t = at_a / (at_a - at_b);
    Corner between;
    for (std::size_t k = 0; k < 3; ++k) between.left[k] = a.left[k] + t * (b.left[k] - a.left[k]);
    between.height = a.height + t * (b.height - a.height);
    cut.add(between);
  }
  return cut;
}

// Whether a triangle, some of whose corners are within the height and others are not, is beyond it somewhere over the
// part.
bool ProjectedSurface::is_high(std::size_t triangle, const SeenPart& part) const {
  Polygon polygon;
  for (std::size_t n = 0; n < 3; ++n) {
    Corner corner;
    for (std::size_t side = 0; side < 3; ++side) {
      corner.left[side] = part.left_of(side, triangles_.x[n][triangle], triangles_.y[n][triangle]);
    }
    corner.height = triangles_.height[n][triangle];
    polygon.add(corner);
  }
  for (std::size_t side = 0; side < 3; ++side) polygon = polygon.left_of(side);
  return std::any_of(polygon.corners.begin(), polygon.corners.begin() + polygon.count,
                     [&](const Corner& corner) { return !(std::abs(corner.height) <= part.most); });
}

// Counts a side, which cancels one in the other direction.
void ProjectedSurface::add_side(std::size_t triangle, std::size_t from, std::size_t to) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  const std::uint64_t from_x = bits(triangles_.x[from][triangle]);
  const std::uint64_t from_y = bits(triangles_.y[from][triangle]);
  const std::uint64_t to_x = bits(triangles_.x[to][triangle]);
  const std::uint64_t to_y = bits(triangles_.y[to][triangle]);
  for (std::size_t n = open_count_; n > 0; --n) {
    const Side& other = open_[n - 1];
    if (((other[0] ^ to_x) | (other[1] ^ to_y) | (other[2] ^ from_x) | (other[3] ^ from_y)) == 0) {
      open_[n - 1] = open_[--open_count_];
      return;
    }
  }
  open_[open_count_++] = {from_x, from_y, to_x, to_y};
}

bool ProjectedSurface::covers(const Corners& corners, double most) {
  const SeenPart part = seen_part(corners, most);
  triangles_.pad();
  std::array<std::uint8_t, SeenTriangles::kRoom> bits;
  kernels_.lie_over(triangles_, part, bits.data());
  for (std::size_t t = 0; t < triangles_.count; ++t) {
    if (bits[t] != 0 && (bits[t] & seen::kNowhereHigh) == 0 && is_high(t, part)) return false;
  }
  open_count_ = 0;
  int over_centre = 0;
  for (std::size_t t = 0; t < triangles_.count; ++t) {
    if (bits[t] == 0) continue;
    if ((bits[t] & seen::kOverCentre) != 0) over_centre += (bits[t] & seen::kFacesUp) != 0 ? 1 : -1;
    for (std::size_t n = 0; n < 3; ++n) {
      if ((bits[t] & (seen::kTouches << n)) != 0) add_side(t, n, (n + 1) % 3);
    }
  }
  return open_count_ == 0 && over_centre != 0;
}

}  // namespace isoweave
