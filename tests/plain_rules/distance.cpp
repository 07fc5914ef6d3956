#include "plain_rules/distance.hpp"

#include <algorithm>

#include "plain_rules/simplifier.hpp"

namespace isoweave::plain {
namespace {

// From p to the nearest point of a segment, squared.
double squared_to_segment(const Vector& p, const Vector& a, const Vector& b) {
  const Vector along = b - a;
  const double squared = dot(along, along);
  const double t = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0;
  const Vector to = p - (a + t * along);
  return dot(to, to);
}

// Whether p lies above or below a triangle with an area.
bool is_over(const Vector& p, const Triangle& triangle, const Vector& normal) {
  for (std::size_t n = 0; n < 3; ++n) {
    const Vector side = triangle[(n + 1) % 3] - triangle[n];
    if (dot(normal, cross(side, p - triangle[n])) < 0) return false;
  }
  return true;
}

double squared_to_triangle(const Vector& p, const Triangle& triangle) {
  const auto& [a, b, c] = triangle;
  const Vector normal = cross(b - a, c - a);
  const double squared = dot(normal, normal);
  const double height = dot(p - a, normal);
  if (squared > 0 && is_over(p, triangle, normal)) return height * height / squared;
  return std::min({squared_to_segment(p, a, b), squared_to_segment(p, b, c), squared_to_segment(p, c, a)});
}

// By its longest side, of equally long ones the first.
std::array<Triangle, 2> halves(const Triangle& part) {
  std::size_t longest = 0;
  const auto squared = [&](std::size_t n) { return dot(part[(n + 1) % 3] - part[n], part[(n + 1) % 3] - part[n]); };
  for (std::size_t n = 1; n < 3; ++n) longest = squared(n) > squared(longest) ? n : longest;
  const Vector& a = part[longest];
  const Vector& b = part[(longest + 1) % 3];
  const Vector& c = part[(longest + 2) % 3];
  const Vector middle = 0.5 * (a + b);
  return {Triangle{a, middle, c}, Triangle{middle, b, c}};
}

}  // namespace

Distances::Distances(const Surface& surface, double most) : most_(most) {
  for (const auto& [a, b, c] : surface.triangles) {
    triangles_.push_back({surface.corners[a].place, surface.corners[b].place, surface.corners[c].place});
  }
}

bool Distances::is_near(const Vector& p, const Triangle& triangle) const {
  return squared_to_triangle(p, triangle) <= most_ * most_;
}

// Triangles whose boxes come near the box of a part: the other ones would take most of the time.
Distances::List Distances::near_box(const Triangle& part, const List& triangles) const {
  const auto is_far = [&](const Triangle& t, std::size_t n) {
    const auto [low, high] = std::minmax({t[0][n], t[1][n], t[2][n]});
    const auto [part_low, part_high] = std::minmax({part[0][n], part[1][n], part[2][n]});
    return part_high < low - 1.01 * most_ || part_low > high + 1.01 * most_;
  };
  List list;
  for (const Triangle* t : triangles) {
    if (!is_far(*t, 0) && !is_far(*t, 1) && !is_far(*t, 2)) list.push_back(t);
  }
  return list;
}

bool Distances::holds(const Triangle& face) const {
  List all;
  for (const Triangle& t : triangles_) all.push_back(&t);
  const List near_face = near_box(face, all);
  std::vector<Triangle> parts{face};
  while (!parts.empty()) {
    const Triangle part = parts.back();
    parts.pop_back();
    const List near_part = near_box(part, near_face);
    const bool all_near_one = std::ranges::any_of(near_part, [&](const Triangle* t) {
      return std::ranges::all_of(part, [&](const Vector& corner) { return is_near(corner, *t); });
    });
    if (all_near_one) continue;
    const Vector centre = (1.0 / 3) * (part[0] + part[1] + part[2]);
    double radius = 0;
    for (const Vector& corner : part) radius = std::max(radius, length(corner - centre));
    const bool near = std::ranges::any_of(near_part, [&](const Triangle* t) { return is_near(centre, *t); });
    if (!near || radius <= most_ / 16) return false;
    for (const Triangle& half : halves(part)) parts.push_back(half);
  }
  return true;
}

}  // namespace isoweave::plain
