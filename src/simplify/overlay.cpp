#include "simplify/overlay.hpp"

#include <algorithm>
#include <cmath>

namespace isoweave {
namespace {

constexpr double kLeastArea = 1e-6;  // of a face that is seen, in terms of the mean new one
constexpr double kRounding = 1e-6;   // units of bounds, so that heights of 0 do not add up
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
  double height(const Vec3& at_a, const Vec3& at_b, const Vec3& at_c) const {
    return (a * at_a.z + b * at_b.z + c * at_c.z) / (a + b + c);
  }
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
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c, Index side) {
    const double bound = zone.triangles[side >> 2].bound;
    old_faces_[old_count_++] = {a, b, c, bound};
    for (const std::size_t corner : {a, b, c}) {
      if (corner >= at_u()) end_bounds_[corner - at_u()] = std::max(end_bounds_[corner - at_u()], bound);
    }
  };
  for (std::size_t n = 0; n < u_faces_; ++n) {
    add(at_u(), around_u(n), n + 1 < u_faces_ ? around_u(n + 1) : at_v(), u.out[n]);
  }
  for (std::size_t n = 1; n + 1 < v_faces_; ++n) add(at_v(), around_v(n), around_v(n + 1), v.out[n]);
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
    return turn(seen_[face.b] - seen_[face.a], seen_[face.c] - seen_[face.a]) > least_area_;
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
    add(cross(places_[face.b] - places_[face.a], places_[face.c] - places_[face.a]));
  }
  for (std::size_t n = 0; n < count_; ++n) add(cross(places_[n], places_[after(n)]));
}

bool Overlay::see_merged_vertex() {
  for (const OldFace& face : std::span(old_faces_.data(), old_count_)) {
    const Vec3& a = seen_[face.a];
    const Vec3& b = seen_[face.b];
    const Vec3& c = seen_[face.c];
    const Weights weights{turn(b, c), turn(c, a), turn(a, b)};
    if (weights.are_inside()) merged_ = std::max(merged_, std::abs(weights.height(a, b, c)) + face.bound);
  }
  return merged_ >= 0;
}

// Lists the sides of the old faces that end at one of the two, with the larger bound of the faces beside each.
void Overlay::list_old_sides() {
  const auto add = [&](std::size_t from, std::size_t to, const OldFace& one, const OldFace& other) {
    old_sides_.add(seen_[from], seen_[to], std::max(one.bound, other.bound));
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

// Takes the greatest height, and bound, of all corners of a new face's parts. Those on the ring need no look: the
// height is 0 there, and no part has others only.
bool Overlay::see_new_faces(FaceBounds& bounds) {
  list_old_sides();
  std::array<double, kRoom> crossings;
  const Kernels& best = kernels();
  for (std::size_t n = 0; n < count_; ++n) crossings[n] = best.height_of_crossings(seen_[n], old_sides_);
  bool u_seen = false;
  bool v_seen = false;
  for (std::size_t n = 0; n < count_; ++n) {
    const std::size_t next = after(n);
    double most = std::max({merged_, crossings[n], crossings[next]});
    u_seen |= see_old_vertex(at_u(), n, most);
    v_seen |= see_old_vertex(at_v(), n, most);
    bounds[n] = most <= kMostBound ? static_cast<FaceBound>(std::ceil(most - kRounding)) : kUnbounded;
  }
  return u_seen && v_seen;
}

bool Overlay::see_old_vertex(std::size_t old, std::size_t face, double& most) const {
  const Vec3& p = seen_[old];
  const Vec3& a = seen_[face];
  const Vec3& b = seen_[after(face)];
  const double of_a = turn(p, b);
  const double of_b = turn(a, p);
  const Weights weights{areas_[face] - of_a - of_b, of_a, of_b};
  if (!weights.are_inside()) return false;
  most = std::max(most, std::abs(p.z - weights.height({}, a, b)) + end_bounds_[old - at_u()]);
  return true;
}

}  // namespace isoweave
