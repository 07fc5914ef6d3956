#include "simplify/projected_surface.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "simplify/point_distance.hpp"

namespace isoweave {
namespace {

using measure::operator-;
using measure::operator+;
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
    between.x = a.x + t * (b.x - a.x);
    between.y = a.y + t * (b.y - a.y);
    between.height = a.height + t * (b.height - a.height);
    cut.add(between);
  }
  return cut;
}

double ProjectedSurface::highest(std::size_t triangle) const {
  double most = 0;
  for (const auto& height : triangles_.height) most = std::max(most, std::abs(height[triangle]));
  return most;
}

ProjectedSurface::Polygon ProjectedSurface::polygon_over(std::size_t triangle, const SeenPart& part) const {
  Polygon polygon;
  for (std::size_t n = 0; n < 3; ++n) {
    Corner corner;
    corner.x = triangles_.x[n][triangle];
    corner.y = triangles_.y[n][triangle];
    corner.height = triangles_.height[n][triangle];
    for (std::size_t side = 0; side < 3; ++side) corner.left[side] = part.left_of(side, corner.x, corner.y);
    polygon.add(corner);
  }
  for (std::size_t side = 0; side < 3; ++side) polygon = polygon.left_of(side);
  return polygon;
}

// Whether all of the part that a triangle lies over is near the triangle. The points near a triangle form a convex set,
// so the corners tell. What is not farther than others is not looked at, so the answer does not depend on the order.
bool ProjectedSurface::is_near(std::size_t triangle, const SeenPart& part, double& farthest) {
  if (highest(triangle) <= farthest) return true;
  const auto corner = [&](std::size_t n) {
    return Vec3{triangles_.x[n][triangle], triangles_.y[n][triangle], triangles_.height[n][triangle]};
  };
  const std::array<Vec3, 3> corners{corner(0), corner(1), corner(2)};
  const Polygon polygon = polygon_over(triangle, part);
  double most = farthest;
  for (std::size_t n = 0; n < polygon.count; ++n) {
    const Corner& at = polygon.corners[n];
    if (std::abs(at.height) <= most) continue;
    most = std::max(most, distance({at.x, at.y, 0}, corners));
    if (most <= part.most) continue;
    far_point_ = origin_ + at.x * across_ + at.y * along_;
    return false;
  }
  farthest = most;
  return true;
}

// Drops the triangles that do not lie over the part, and those that are not near it.
void ProjectedSurface::keep_near(const SeenPart& part, std::uint8_t* bits, double& farthest) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < triangles_.count; ++t) {
    if (bits[t] == 0 || !is_near(t, part, farthest)) continue;
    for (std::size_t n = 0; n < 3; ++n) {
      triangles_.x[n][kept] = triangles_.x[n][t];
      triangles_.y[n][kept] = triangles_.y[n][t];
      triangles_.height[n][kept] = triangles_.height[n][t];
    }
    bits[kept++] = bits[t];
  }
  triangles_.count = kept;
  triangles_.pad();
}

// The number of a side, which is a new one where it has not been met.
std::size_t ProjectedSurface::number_of(const Side& side) {
  const std::uint64_t mixed = (side[0] ^ (side[1] << 1) ^ (side[2] << 2) ^ (side[3] << 3)) * 0x9e3779b97f4a7c15U;
  std::size_t slot = mixed >> (64 - kSlotBits);
  for (; slots_[slot] != 0; slot = (slot + 1) % slots_.size()) {
    if (sides_[slots_[slot] - 1U] == side) return slots_[slot] - 1U;
  }
  sides_[side_count_] = side;
  counts_[side_count_++] = 0;
  slots_[slot] = static_cast<std::uint16_t>(side_count_);
  return side_count_ - 1;
}

// Counts a side: +1 in one direction, -1 in the other.
void ProjectedSurface::count_side(std::size_t triangle, std::size_t from, std::size_t to) {
  const auto end = [&](std::size_t corner) {
    return std::array{std::bit_cast<std::uint64_t>(triangles_.x[corner][triangle]),
                      std::bit_cast<std::uint64_t>(triangles_.y[corner][triangle])};
  };
  auto a = end(from);
  auto b = end(to);
  const bool turned = b < a;
  if (turned) std::swap(a, b);
  counts_[number_of({a[0], a[1], b[0], b[1]})] += turned ? -1 : 1;
}

void ProjectedSurface::list_open_sides(const std::uint8_t* bits) {
  side_count_ = 0;
  slots_.fill(0);
  for (std::size_t t = 0; t < triangles_.count; ++t) {
    for (std::size_t n = 0; n < 3; ++n) {
      if ((bits[t] & (seen::kTouches << n)) != 0) count_side(t, n, (n + 1) % 3);
    }
  }
  open_count_ = 0;
  for (std::size_t n = 0; n < side_count_; ++n) {
    if (counts_[n] != 0) sides_[open_count_++] = sides_[n];
  }
}

bool ProjectedSurface::survey(const Corners& corners, double most, double& farthest) {
  const SeenPart part = seen_part(corners, most);
  far_point_.reset();
  triangles_.pad();
  std::array<std::uint8_t, SeenTriangles::kRoom> bits;
  kernels_.lie_over(triangles_, part, bits.data());
  keep_near(part, bits.data(), farthest);
  list_open_sides(bits.data());
  return open_count_ == 0 && kernels_.count_over(triangles_, part.centre_x, part.centre_y) != 0;
}

// Whether a side touches a part: no side of the part, nor the side itself, parts the two.
bool ProjectedSurface::touches(const Side& side, const SeenPart& part) {
  const auto [ax, ay, bx, by] = std::bit_cast<std::array<double, 4>>(side);
  const double left_x = ay - by;
  const double left_y = bx - ax;
  const double reach = part.slack * (std::abs(left_x) + std::abs(left_y));
  bool all_left = true;
  bool all_right = true;
  for (std::size_t n = 0; n < 3; ++n) {
    const double beside = -part.slack * (std::abs(part.left_x[n]) + std::abs(part.left_y[n]));
    if (part.left_of(n, ax, ay) < beside && part.left_of(n, bx, by) < beside) return false;
    const double left = left_x * (part.x[n] - ax) + left_y * (part.y[n] - ay);
    all_left &= left > reach;
    all_right &= left < -reach;
  }
  return !all_left && !all_right;
}

bool ProjectedSurface::covers(const Corners& corners) const {
  const SeenPart part = seen_part(corners, 0);
  for (std::size_t n = 0; n < open_count_; ++n) {
    if (touches(sides_[n], part)) return false;
  }
  return kernels_.count_over(triangles_, part.centre_x, part.centre_y) != 0;
}

}  // namespace isoweave
