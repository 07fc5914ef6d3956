// Bounds that follow from the faces that a collapse replaces, against distances computed point by point.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "lattice/triangles.hpp"
#include "measure/triangle_tree.hpp"
#include "plain_rules/overlay.hpp"
#include "simplify/overlay.hpp"

namespace isoweave::testing::simplify_overlay_test {
namespace {

using measure::operator+;
using measure::operator*;
using measure::Vector;

Vector vector_at(const Vec3& p) { return {p.x, p.y, p.z}; }

// Two neighbours and the ring around both, as a zone without twins.
class Ring {
 public:
  // The ring's vertices, counter-clockwise. u has the first `around_u` of them, v has the last of these, all others and
  // the first.
  Ring(const Vec3& u, const Vec3& v, const std::vector<Vec3>& ring, std::size_t around_u) {
    vertices_.resize(ring.size() + 2);
    vertices_[0].position = u;
    vertices_[1].position = v;
    for (std::size_t n = 0; n < ring.size(); ++n) vertices_[n + 2].position = ring[n];
    fill(u_, 0, 1, 0, around_u);
    fill(v_, 1, 0, around_u - 1, ring.size() + 1);
    share(0, v_.count() - 1);
    share(u_.count() - 1, 0);
    zone_.vertices = vertices_;
    zone_.triangles = triangles_;
    zone_.options.most_distance = kMost;
  }

  void set_bound(std::size_t old_face, FaceBound bound) { triangles_[old_face].bound = bound; }
  std::size_t old_faces() const { return triangles_.size(); }
  std::size_t new_faces() const { return vertices_.size() - 2; }

  bool bound(const Vec3& place, FaceBounds& bounds) const { return Overlay(zone_, u_, v_, place).bound(bounds); }

  // The same by the rules written a second time.
  std::optional<std::vector<unsigned>> plain_bound(const Vec3& place) const {
    plain::Overlaid before;
    const auto number = [&](Index v) { return v < 2 ? new_faces() + v : v - 2; };
    for (Index v = 2; v < vertices_.size() + 2; ++v) {
      const Vec3 from_place = vertices_[v % vertices_.size()].position - place;
      before.places.push_back({from_place.x, from_place.y, from_place.z});
    }
    for (const Triangle& triangle : triangles_) {
      const auto& [a, b, c] = triangle.sides;
      if (a.vertex == kNone) continue;
      before.faces.push_back({{number(a.vertex), number(b.vertex), number(c.vertex)}, triangle.bound});
    }
    return plain::new_bounds(before, kMost);
  }

  // The least distance of a point to an old face together with its bound, in units.
  double known_at(const Vector& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      if (triangles_[t].sides[0].vertex == kNone) continue;
      const auto corner = [&](std::size_t c) { return vector_at(vertices_[triangles_[t].sides[c].vertex].position); };
      const double distance = std::sqrt(measure::squared_distance(p, {corner(0), corner(1), corner(2)}));
      least = std::min(least, distance * kBoundUnits / kMost + triangles_[t].bound);
    }
    return least;
  }

  measure::TriangleCorners new_face(std::size_t n, const Vec3& place) const {
    const std::size_t next = (n + 1) % new_faces();
    return {vector_at(place), vector_at(vertices_[n + 2].position), vector_at(vertices_[next + 2].position)};
  }

  static constexpr double kMost = 2;

 private:
  // A star: the other end, and the ring from one place to another.
  void fill(Star& star, Index vertex, Index other, std::size_t from, std::size_t to) {
    star.vertex = vertex;
    std::vector<Index> around{other};
    for (std::size_t n = from; n < to; ++n) around.push_back(static_cast<Index>(2 + n % (vertices_.size() - 2)));
    star.faces = star.neighbours = static_cast<int>(around.size());
    for (std::size_t n = 0; n < around.size(); ++n) {
      Triangle triangle;
      triangle.sides[0].vertex = vertex;
      triangle.sides[1].vertex = around[n];
      triangle.sides[2].vertex = around[(n + 1) % around.size()];
      star.neighbour[n] = around[n];
      star.out[n] = half_edge(static_cast<Index>(triangles_.size()), 0);
      triangles_.push_back(triangle);
    }
  }

  // Makes a face of v, which both ends have, that of u.
  void share(std::size_t u_face, std::size_t v_face) {
    triangles_[v_.out[v_face] >> 2].sides[0].vertex = kNone;
    v_.out[v_face] = u_.out[u_face];
  }

  std::vector<Vertex> vertices_;
  std::vector<Triangle> triangles_;
  Star u_, v_;
  ZoneView zone_;
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }

  Vector in(const measure::TriangleCorners& t) {
    double a = number(0, 1);
    double b = number(0, 1);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    return (1 - a - b) * t[0] + a * t[1] + b * t[2];
  }

 private:
  std::mt19937 engine_;
};

// A ring around ends at (-0.5, 0) and (0.5, 0): its first vertex lies behind both, and the one before `around_u` in
// front of them. far(), level(): its distances from the middle, and heights.
template <class Far, class Level>
std::vector<Vec3> ring_of(std::size_t around_u, std::size_t count, const Far& far, const Level& level) {
  constexpr double kHalf = 3.14159265358979;
  std::vector<Vec3> ring;
  for (std::size_t n = 0; n < count; ++n) {
    const double of_u = static_cast<double>(n) / static_cast<double>(around_u - 1);
    const double of_v = static_cast<double>(n - around_u + 1) / static_cast<double>(count - around_u + 1);
    const double angle = kHalf * (0.5 + (n < around_u ? of_u : 1 + of_v));
    const double length = far();
    ring.push_back({length * std::cos(angle), length * std::sin(angle), level()});
  }
  return ring;
}

Vec3 tilted(const Vec3& p, double tilt) {
  return {std::cos(tilt) * p.x - std::sin(tilt) * p.z, p.y, std::sin(tilt) * p.x + std::cos(tilt) * p.z};
}

// wild: how far its vertices are moved, so that some faces fold.
Ring rough_ring(Random& random, double height, std::size_t around_u, std::size_t count, double wild = 0) {
  const double tilt = random.number(0, 3);
  const auto level = [&] { return random.number(-height, height); };
  std::vector<Vec3> ring = ring_of(
      around_u, count, [&] { return random.number(1.5, 2.5); }, level);
  for (Vec3& p : ring) {
    const double by[3] = {random.number(-wild, wild), random.number(-wild, wild), random.number(-wild, wild)};
    p = tilted(p + Vec3{by[0], by[1], by[2]}, tilt);
  }
  return {tilted({-0.5, 0, level()}, tilt), tilted({0.5, 0, level()}, tilt), ring, around_u};
}

// Every point of a new face is as near an old one as its bound says, the old one's included.
TEST(Overlay, BoundsHoldAtEveryPoint) {
  Random random(3);
  int bounded = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const auto around_u = static_cast<std::size_t>(random.number(3, 7));
    const auto around_v = static_cast<std::size_t>(random.number(3, 7));
    Ring ring = rough_ring(random, trial % 2 == 0 ? 0.2 : 0.7, around_u, around_u + around_v - 2);
    for (std::size_t t = 0; t < ring.old_faces(); ++t) {
      if (trial % 3 > 0) ring.set_bound(t, static_cast<FaceBound>(random.number(0, 9000)));
    }
    const Vec3 place{random.number(-0.4, 0.4), random.number(-0.4, 0.4), random.number(-0.4, 0.4)};
    FaceBounds bounds;
    if (!ring.bound(place, bounds)) continue;
    for (std::size_t n = 0; n < ring.new_faces(); ++n) {
      if (bounds[n] == kUnbounded) continue;
      ++bounded;
      const measure::TriangleCorners face = ring.new_face(n, place);
      for (int point = 0; point < 200; ++point) ASSERT_LE(ring.known_at(random.in(face)), bounds[n] + 1e-3) << trial;
    }
  }
  EXPECT_GT(bounded, 1000);
}

TEST(Overlay, BoundsAreThoseOfTheRulesWrittenASecondTime) {
  Random random(5);
  int known = 0;
  int unknown = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const auto around_u = static_cast<std::size_t>(random.number(3, 8));
    const auto around_v = static_cast<std::size_t>(random.number(3, 8));
    Ring ring = rough_ring(random, random.number(0, 2), around_u, around_u + around_v - 2, trial % 4);
    for (std::size_t t = 0; t < ring.old_faces(); ++t) {
      const double bound = random.number(-9000, 9000);
      ring.set_bound(t, bound < -8000 ? kUnbounded : static_cast<FaceBound>(std::max(0.0, bound)));
    }
    const Vec3 place{random.number(-0.6, 0.6), random.number(-0.6, 0.6), random.number(-0.6, 0.6)};
    FaceBounds bounds;
    const auto expected = ring.plain_bound(place);
    ASSERT_EQ(ring.bound(place, bounds), expected.has_value()) << trial;
    ++(expected ? known : unknown);
    for (std::size_t n = 0; expected && n < ring.new_faces(); ++n) ASSERT_EQ(bounds[n], (*expected)[n]) << trial;
  }
  EXPECT_GT(known, 500);
  EXPECT_GT(unknown, 500);
}

TEST(Overlay, AFlatRingAddsTheHeightOfThePlace) {
  const auto flat = ring_of(
      4, 7, [] { return 2.0; }, [] { return 0.25; });
  Ring ring({-0.5, 0, 0.25}, {0.5, 0, 0.25}, flat, 4);
  for (std::size_t t = 0; t < ring.old_faces(); ++t) ring.set_bound(t, 77);
  FaceBounds bounds;
  ASSERT_TRUE(ring.bound({0.2, 0.1, 0.25}, bounds));
  for (std::size_t n = 0; n < ring.new_faces(); ++n) EXPECT_EQ(bounds[n], 77) << "nothing may add up";
  ASSERT_TRUE(ring.bound({0.2, 0.1, 0.35}, bounds));
  for (std::size_t n = 0; n < ring.new_faces(); ++n) {
    EXPECT_NEAR(bounds[n], 77 + 0.1 / Ring::kMost * kBoundUnits, 1.001);
  }
  ASSERT_TRUE(ring.bound({0.2, 0.1, 3}, bounds));
  for (std::size_t n = 0; n < ring.new_faces(); ++n) EXPECT_EQ(bounds[n], kUnbounded) << "beyond what is allowed";
}

// The bound of a face that nothing is known of reaches the new faces above it, and no others.
TEST(Overlay, WhatIsNotKnownSpreadsNoFartherThanItsFace) {
  const auto flat = ring_of(
      5, 9, [] { return 2.0; }, [] { return 0.0; });
  Ring ring({-0.5, 0, 0}, {0.5, 0, 0}, flat, 5);
  ring.set_bound(2, kUnbounded);  // between the second and the third vertex of the ring
  FaceBounds bounds;
  ASSERT_TRUE(ring.bound({0.3, 0, 0}, bounds));
  for (std::size_t n = 0; n < ring.new_faces(); ++n) {
    EXPECT_EQ(bounds[n] == kUnbounded, n <= 2) << n;
  }
}

// The sides of a thin wedge: along the area, which is that of the larger one, the other one faces away. From above both
// face up.
TEST(Overlay, TurnsUntilAllFacesFaceUp) {
  const auto roof = [](double x, double y) { return Vec3{x, y, x < 0 ? 6 * x : -6 * x}; };
  std::vector<Vec3> ring;
  for (const auto& [x, y] : {std::pair(0.0, 2.0), {-4.0, 1.0}, {-4.0, -1.0}, {0.0, -2.0}, {0.4, -1.0}, {0.4, 1.0}}) {
    ring.push_back(roof(x, y));
  }
  const Ring wedge(roof(0, 0.5), roof(0.2, -0.5), ring, 4);
  FaceBounds bounds;
  EXPECT_TRUE(wedge.bound(roof(0, 0.1), bounds));
}

// Faces that fold back lie above no common polygon.
TEST(Overlay, KnowsNothingOfFolds) {
  auto folded = ring_of(
      4, 7, [] { return 2.0; }, [] { return 0.0; });
  folded[2] = {3, 0.1, 0.5};
  const Ring ring({-0.5, 0, 0}, {0.5, 0, 0}, folded, 4);
  FaceBounds bounds;
  EXPECT_FALSE(ring.bound({0.2, 0.1, 0}, bounds));
}

}  // namespace
}  // namespace isoweave::testing::simplify_overlay_test
