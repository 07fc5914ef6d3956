#include "simplify/overlay.hpp"

#include <algorithm>
#include <cmath>

namespace isoweave {
namespace {

constexpr double kLeastArea = 1e-6;  // of a face that is seen, in terms of the mean new one
constexpr int kTurns = 8;            // of the direction
constexpr double kLeastCosine = 1.0 / 16;
constexpr double kTurnedCosine = 1.0 / 4;

// Twice the area, as it is seen, of a triangle with a corner at the origin.
double turn(const Vec3& a, const Vec3& b) { return a.x * b.y - a.y * b.x; }

Vec3 unit(const Vec3& v) { return (1 / std::sqrt(dot(v, v))) * v; }

// The weights of a triangle's corners at a point that is seen in the triangle. What touches it counts as inside.
struct Weights {
  double a, b, c;

  bool are_inside() const { return std::min({a, b, c}) >= -kTouching * (a + b + c); }
  double mean(double at_a, double at_b, double at_c) const { return (a * at_a + b * at_b + c * at_c) / (a + b + c); }
};

}  // namespace

Overlay::Overlay(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place)
    : units_(kBoundUnits / zone.options.most_distance),
      u_faces_(static_cast<std::size_t>(u.faces)),
      v_faces_(static_cast<std::size_t>(v.faces)),
      count_(u_faces_ + v_faces_ - 4) {
  const auto from_place = [&](Index w) { return zone.vertices[w].position - place; };
  for (std::size_t n = 0; n < u_faces_; ++n) places_[around_u(n)] = from_place(u.neighbour[n]);
  for (std::size_t n = 0; n < v_faces_; ++n) places_[around_v(n)] = from_place(v.neighbour[n]);
  list_old_faces(zone, u, v);
}

void Overlay::list_old_faces(const ZoneView& zone, const Star& u, const Star& v) {
  const auto add = [&](const std::array<std::size_t, 3>& corners, Index side) {
    const std::array<Index, 3> halves{side, next(side), previous(side)};
    OldFace& face = old_faces_[old_count_++];
    face.corners = corners;
    for (std::size_t n = 0; n < 3; ++n) {
      face.bounds[n] = bound_at(zone, halves[n]);
      bounds_[corners[n]] = std::max(bounds_[corners[n]], face.bounds[n]);
    }
  };
  for (std::size_t n = 0; n < u_faces_; ++n) {
    add({at_u(), around_u(n), n + 1 < u_faces_ ? around_u(n + 1) : at_v()}, u.out[n]);
  }
  for (std::size_t n = 1; n + 1 < v_faces_; ++n) add({at_v(), around_v(n), around_v(n + 1)}, v.out[n]);
}

bool Overlay::bound(FaceBounds& bounds) {
  Vec3 area{};
  for (std::size_t n = 0; n < count_; ++n) area = area + cross(places_[n], places_[after(n)]);
  if (!(dot(area, area) > 0)) return false;
  const Vec3 up = unit(area);
  return (look_along(up) || turn_until_faces_face_up(up)) && see_merged_vertex() && see_new_faces(bounds);
}

// Sees everything along a direction. Returns whether all faces face up, and the new ones go around their vertex once.
// Then both triangulations cover the same polygon.
bool Overlay::look_along(const Vec3& up) {
  const Vec3 across = cross(std::abs(up.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, up);
  const Vec3 along = cross(up, across);
  const Vec3 height = units_ * up;
  for (std::size_t n = 0; n < count_ + 2; ++n) {
    seen_[n] = {dot(places_[n], across), dot(places_[n], along), dot(places_[n], height)};
  }
  return new_faces_face_up() && old_faces_face_up();
}

bool Overlay::new_faces_face_up() {
  double area = 0;
  int rounds = 0;
  for (std::size_t n = 0; n < count_; ++n) {
    areas_[n] = turn(seen_[n], seen_[after(n)]);
    area += areas_[n];
    if (seen_[n].y < 0 && seen_[after(n)].y >= 0) ++rounds;
  }
  least_area_ = kLeastArea * area / static_cast<double>(count_);
  return rounds == 1 && least_area_ > 0 && *std::min_element(areas_.begin(), areas_.begin() + count_) > least_area_;
}

bool Overlay::old_faces_face_up() const {
  return std::all_of(old_faces_.begin(), old_faces_.begin() + old_count_, [&](const OldFace& face) {
    const auto& [a, b, c] = face.corners;
    return turn(seen_[b] - seen_[a], seen_[c] - seen_[a]) > least_area_;
  });
}

// Turns the direction towards the normal that it is farthest from, until it is near enough to all of them (Rosenblatt's
// perceptron, 1958).
bool Overlay::turn_until_faces_face_up(Vec3 up) {
  list_normals();
  for (int turns = 0; turns < kTurns; ++turns) {
    const auto cosine = [&](const Vec3& normal) { return dot(up, normal); };
    const Vec3& farthest = *std::ranges::min_element(std::span(normals_.data(), normal_count_), {}, cosine);
    if (cosine(farthest) > kLeastCosine) return look_along(up);
    up = unit(up + (kTurnedCosine - cosine(farthest)) * farthest);
  }
  return false;
}

void Overlay::list_normals() {
  const auto add = [&](const Vec3& normal) {
    normals_[normal_count_++] = dot(normal, normal) > 0 ? unit(normal) : normal;
  };
  for (const OldFace& face : std::span(old_faces_.data(), old_count_)) {
    const auto& [a, b, c] = face.corners;
    add(cross(places_[b] - places_[a], places_[c] - places_[a]));
  }
  for (std::size_t n = 0; n < count_; ++n) add(cross(places_[n], places_[after(n)]));
}

bool Overlay::see_merged_vertex() {
  for (const OldFace& face : std::span(old_faces_.data(), old_count_)) {
    const Vec3& a = seen_[face.corners[0]];
    const Vec3& b = seen_[face.corners[1]];
    const Vec3& c = seen_[face.corners[2]];
    const Weights weights{turn(b, c), turn(c, a), turn(a, b)};
    if (!weights.are_inside()) continue;
    const double bound = weights.mean(face.bounds[0], face.bounds[1], face.bounds[2]);
    merged_ = std::max(merged_, std::abs(weights.mean(a.z, b.z, c.z)) + bound);
  }
  return merged_ >= 0;
}

// Lists the sides of the old faces that end at one of the two.
void Overlay::list_old_sides() {
  const auto add = [&](std::size_t from, std::size_t to, const OldFace& one, const OldFace& other) {
    const auto at = [&](std::size_t corner) { return std::max(one.bound_at(corner), other.bound_at(corner)); };
    old_sides_.add(seen_[from], seen_[to], at(from), at(to));
  };
  for (std::size_t n = 0; n < u_faces_; ++n) {
    add(at_u(), around_u(n), old_faces_[n], old_faces_[n > 0 ? n - 1 : u_faces_ - 1]);
  }
  const auto beside_v = [&](std::size_t n) {
    const bool is_shared = n == 0 || n + 1 == v_faces_;
    return is_shared ? old_faces_[n == 0 ? u_faces_ - 1 : 0] : old_faces_[u_faces_ + n - 1];
  };
  for (std::size_t n = 1; n < v_faces_; ++n) add(at_v(), around_v(n), beside_v(n), beside_v(n - 1));
  old_sides_.pad();
}

// Takes the least bound at the merged vertex that holds at all corners of a new face's parts.
bool Overlay::see_new_faces(FaceBounds& bounds) {
  list_old_sides();
  std::array<double, kRoom> crossings;
  const Kernels& best = kernels();
  for (std::size_t n = 0; n < count_; ++n) crossings[n] = best.bound_of_crossings(seen_[n], bounds_[n], old_sides_);
  bool u_seen = false;
  bool v_seen = false;
  for (std::size_t n = 0; n < count_; ++n) {
    const std::size_t next = after(n);
    double merged = std::max({merged_, crossings[n], crossings[next]});
    u_seen |= see_old_vertex(at_u(), n, merged);
    v_seen |= see_old_vertex(at_v(), n, merged);
    bounds[n] = {merged, bounds_[n], bounds_[next]};
  }
  return u_seen && v_seen;
}

bool Overlay::see_old_vertex(std::size_t old, std::size_t face, double& merged) const {
  const Vec3& p = seen_[old];
  const std::size_t next = after(face);
  const Vec3& a = seen_[face];
  const Vec3& b = seen_[next];
  const double of_a = turn(p, b);
  const double of_b = turn(a, p);
  const Weights weights{areas_[face] - of_a - of_b, of_a, of_b};
  if (!weights.are_inside()) return false;
  const double least = std::abs(p.z - weights.mean(0, a.z, b.z)) + bounds_[old];
  const double rest = least - weights.mean(0, bounds_[face], bounds_[next]) - kBoundRounding;
  merged = std::max(merged, rest / std::max(weights.a / areas_[face], kLeastWeight));
  return true;
}

}  // namespace isoweave
