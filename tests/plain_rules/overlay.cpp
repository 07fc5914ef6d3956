#include "plain_rules/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace isoweave::plain {
namespace {

Vector of_unit_length(const Vector& v) { return (1 / std::sqrt(dot(v, v))) * v; }

double area(const Vector& a, const Vector& b) { return a[0] * b[1] - a[1] * b[0]; }

std::vector<Vector> seen_along(const Vector& up, const std::vector<Vector>& places, double most) {
  const Vector axis = std::abs(up[0]) < 0.6 ? Vector{1, 0, 0} : Vector{0, 1, 0};
  const Vector across = cross(axis, up);
  const Vector along = cross(up, across);
  const Vector height = (65536 / most) * up;
  std::vector<Vector> seen;
  for (const Vector& p : places) seen.push_back({dot(p, across), dot(p, along), dot(p, height)});
  return seen;
}

bool faces_up(const Overlaid& before, const std::vector<Vector>& seen) {
  const std::size_t count = before.ring();
  double sum = 0;
  std::size_t rounds = 0;
  std::vector<double> areas;
  for (std::size_t n = 0; n < count; ++n) {
    const Vector& next = seen[(n + 1) % count];
    areas.push_back(area(seen[n], next));
    sum += areas.back();
    if (seen[n][1] < 0 && !(next[1] < 0)) ++rounds;
  }
  for (const auto& [corners, bound] : before.faces) {
    const Vector& a = seen[corners[0]];
    areas.push_back(area(seen[corners[1]] - a, seen[corners[2]] - a));
  }
  const double least = 1e-6 * sum / static_cast<double>(count);
  return rounds == 1 && least > 0 && std::ranges::all_of(areas, [&](double one) { return one > least; });
}

std::vector<Vector> normals_of(const Overlaid& before) {
  std::vector<Vector> normals;
  for (const auto& [corners, bound] : before.faces) {
    const Vector& a = before.places[corners[0]];
    normals.push_back(cross(before.places[corners[1]] - a, before.places[corners[2]] - a));
  }
  for (std::size_t n = 0; n < before.ring(); ++n) {
    normals.push_back(cross(before.places[n], before.places[(n + 1) % before.ring()]));
  }
  for (Vector& normal : normals) {
    if (dot(normal, normal) > 0) normal = of_unit_length(normal);
  }
  return normals;
}

// As all is seen from a direction from which every face faces up; nothing where none is found.
std::vector<Vector> seen_from_above(const Overlaid& before, double most) {
  Vector sum{};
  for (std::size_t n = 0; n < before.ring(); ++n) {
    sum = sum + cross(before.places[n], before.places[(n + 1) % before.ring()]);
  }
  if (!(dot(sum, sum) > 0)) return {};
  Vector up = of_unit_length(sum);
  std::vector<Vector> seen = seen_along(up, before.places, most);
  if (faces_up(before, seen)) return seen;
  const std::vector<Vector> normals = normals_of(before);
  for (int turn = 0; turn < 8; ++turn) {
    std::size_t farthest = 0;
    for (std::size_t n = 1; n < normals.size(); ++n) {
      if (dot(up, normals[n]) < dot(up, normals[farthest])) farthest = n;
    }
    const double cosine = dot(up, normals[farthest]);
    if (cosine > 0.0625) {
      seen = seen_along(up, before.places, most);
      return faces_up(before, seen) ? seen : std::vector<Vector>{};
    }
    up = of_unit_length(up + (0.25 - cosine) * normals[farthest]);
  }
  return {};
}

// The height of a triangle at a point that is seen in it; none where it is not.
std::optional<double> height_at(const std::array<double, 3>& weights, const std::array<Vector, 3>& corners) {
  const double whole = weights[0] + weights[1] + weights[2];
  if (*std::ranges::min_element(weights) < -1e-9 * whole) return {};
  return (weights[0] * corners[0][2] + weights[1] * corners[1][2] + weights[2] * corners[2][2]) / whole;
}

struct Side {
  Vector from, along;
  double bound;
};

// The sides at the two ends, which the ring does not have; each runs away from its end, that between them from the
// first.
std::vector<Side> inner_sides(const Overlaid& before, const std::vector<Vector>& seen) {
  const std::size_t first_end = before.ring();
  std::map<std::pair<std::size_t, std::size_t>, double> bounds;
  for (const auto& [corners, bound] : before.faces) {
    for (std::size_t n = 0; n < 3; ++n) {
      auto [low, high] = std::minmax(corners[n], corners[(n + 1) % 3]);
      if (high < first_end) continue;
      double& most = bounds[low < first_end ? std::pair(high, low) : std::pair(low, high)];
      most = std::max(most, static_cast<double>(bound));
    }
  }
  std::vector<Side> sides;
  for (const auto& [ends, bound] : bounds) {
    sides.push_back({seen[ends.first], seen[ends.second] - seen[ends.first], bound});
  }
  return sides;
}

bool is_between_ends(double at) { return at > -1e-9 && at < 1 + 1e-9; }

// The greatest height between the side to a vertex of the ring and those that it crosses, with their bounds.
double over_sides(const Vector& to, const std::vector<Side>& sides) {
  double most = 0;
  for (const auto& [from, along, bound] : sides) {
    const double turn = area(to, along);
    if (turn == 0) continue;
    const double s = area(from, along) / turn;
    const double t = area(from, to) / turn;
    if (!is_between_ends(s) || !is_between_ends(t)) continue;
    most = std::max(most, std::abs(s * to[2] - (from[2] + t * along[2])) + bound);
  }
  return most;
}

// The greatest bound of the faces at each corner.
std::vector<double> bounds_at_corners(const Overlaid& before) {
  std::vector<double> most(before.places.size(), 0);
  for (const auto& [corners, bound] : before.faces) {
    for (const std::size_t corner : corners) most[corner] = std::max(most[corner], static_cast<double>(bound));
  }
  return most;
}

// The greatest height of the old faces at the merged vertex, with their bounds.
std::optional<double> under_origin(const Overlaid& before, const std::vector<Vector>& seen) {
  std::optional<double> most;
  for (const auto& [corners, bound] : before.faces) {
    const std::array<Vector, 3> at{seen[corners[0]], seen[corners[1]], seen[corners[2]]};
    const auto height = height_at({area(at[1], at[2]), area(at[2], at[0]), area(at[0], at[1])}, at);
    if (height) most = std::max(most.value_or(0), std::abs(*height) + bound);
  }
  return most;
}

}  // namespace

std::optional<std::vector<unsigned>> new_bounds(const Overlaid& before, double most) {
  const std::vector<Vector> seen = seen_from_above(before, most);
  if (seen.empty()) return {};
  const auto merged = under_origin(before, seen);
  if (!merged) return {};
  const std::vector<Side> sides = inner_sides(before, seen);
  const std::vector<double> at_corner = bounds_at_corners(before);
  std::vector<unsigned> bounds;
  std::array<bool, 2> met{};
  for (std::size_t n = 0; n < before.ring(); ++n) {
    const std::size_t next = (n + 1) % before.ring();
    double high = std::max({*merged, over_sides(seen[n], sides), over_sides(seen[next], sides)});
    for (std::size_t end = 0; end < 2; ++end) {
      const Vector& p = seen[before.ring() + end];
      const double of_a = area(p, seen[next]);
      const double of_b = area(seen[n], p);
      const auto height =
          height_at({area(seen[n], seen[next]) - of_a - of_b, of_a, of_b}, {Vector{}, seen[n], seen[next]});
      if (!height) continue;
      met[end] = true;
      high = std::max(high, std::abs(p[2] - *height) + at_corner[before.ring() + end]);
    }
    bounds.push_back(high <= 65534 ? static_cast<unsigned>(std::ceil(high - 1e-6)) : kNoBound);
  }
  if (!met[0] || !met[1]) return {};
  return bounds;
}

}  // namespace isoweave::plain
