// Bounds that follow from the faces that a collapse replaces, against distances computed point by point.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "lattice/triangles.hpp"
#include "measure/triangle_tree.hpp"
#include "sanitized.hpp"
#include "simplify/overlay.hpp"

namespace isoweave::testing::simplify_overlay_test {
namespace {

using measure::operator+;
using measure::operator-;
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

  // Sets an old face's bounds: at the end that it belongs to, and at the two corners after that.
  void set_bounds(std::size_t old_face, const std::array<CornerBound, 3>& bounds) {
    triangles_[old_face].bounds = bounds;
  }
  std::size_t old_faces() const { return triangles_.size(); }
  std::size_t new_faces() const { return vertices_.size() - 2; }

  bool bound(const Vec3& place, FaceBounds& bounds) const { return Overlay(zone_, u_, v_, place).bound(bounds); }

  // The least distance of a point to a place on an old face together with the bound there, in units.
  double known_at(const Vector& p) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : triangles_) {
      if (triangle.sides[0].vertex != kNone) least = std::min(least, known_on(triangle, p));
    }
    return least;
  }

  measure::TriangleCorners new_face(std::size_t n, const Vec3& place) const {
    const std::size_t next = (n + 1) % new_faces();
    return {vector_at(place), vector_at(vertices_[n + 2].position), vector_at(vertices_[next + 2].position)};
  }

  static constexpr double kMost = 2;

 private:
  // Both the distance and the bound are convex on a face, so the least sum is found by narrowing each coordinate down.
  double known_on(const Triangle& triangle, const Vector& p) const {
    const auto corner = [&](std::size_t c) { return vector_at(vertices_[triangle.sides[c].vertex].position); };
    const Vector at[3] = {corner(0), corner(1), corner(2)};
    const auto known = [&](double a, double b) {
      const double c = 1 - a - b;
      const Vector to = a * at[0] + b * at[1] + c * at[2] - p;
      const double bound = a * triangle.bounds[0] + b * triangle.bounds[1] + c * triangle.bounds[2];
      return std::sqrt(measure::dot(to, to)) * kBoundUnits / kMost + bound;
    };
    return least_between(1, [&](double a) { return least_between(1 - a, [&](double b) { return known(a, b); }); });
  }

  // The least value of a convex function between 0 and another number.
  template <class Function>
  static double least_between(double high, const Function& function) {
    double low = 0;
    for (int n = 0; n < 20; ++n) {
      const double third = (high - low) / 3;
      if (function(low + third) < function(high - third)) {
        high -= third;
      } else {
        low += third;
      }
    }
    return function(0.5 * (low + high));
  }

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

  // The weights of the corners of a triangle at a point in it.
  std::array<double, 3> weights() {
    double a = number(0, 1);
    double b = number(0, 1);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    return {1 - a - b, a, b};
  }

  CornerBound bound(double most) { return static_cast<CornerBound>(number(0, most)); }

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
  for (int trial = 0; trial < (kSanitized ? 8 : 60); ++trial) {
    const auto around_u = static_cast<std::size_t>(random.number(3, 7));
    const auto around_v = static_cast<std::size_t>(random.number(3, 7));
    Ring ring = rough_ring(random, trial % 2 == 0 ? 0.2 : 0.7, around_u, around_u + around_v - 2);
    for (std::size_t t = 0; t < ring.old_faces(); ++t) {
      if (trial % 3 > 0) ring.set_bounds(t, {random.bound(60), random.bound(60), random.bound(60)});
    }
    const Vec3 place{random.number(-0.4, 0.4), random.number(-0.4, 0.4), random.number(-0.4, 0.4)};
    FaceBounds bounds;
    if (!ring.bound(place, bounds)) continue;
    for (std::size_t n = 0; n < ring.new_faces(); ++n) {
      if (bounds[n].most() > 100 * kBoundUnits) continue;
      ++bounded;
      const auto& [a, b, c] = ring.new_face(n, place);
      for (int point = 0; point < 5; ++point) {
        const auto [of_a, of_b, of_c] = random.weights();
        const double bound = of_a * bounds[n].merged + of_b * bounds[n].a + of_c * bounds[n].b;
        ASSERT_LE(ring.known_at(of_a * a + of_b * b + of_c * c), bound + 0.01) << trial;
      }
    }
  }
  EXPECT_GT(bounded, kSanitized ? 10 : 150);
}

TEST(Overlay, AFlatRingAddsTheHeightOfThePlace) {
  const auto flat = ring_of(
      4, 7, [] { return 2.0; }, [] { return 0.25; });
  Ring ring({-0.5, 0, 0.25}, {0.5, 0, 0.25}, flat, 4);
  for (std::size_t t = 0; t < ring.old_faces(); ++t) ring.set_bounds(t, {77, 77, 77});
  FaceBounds bounds;
  ASSERT_TRUE(ring.bound({0.2, 0.1, 0.25}, bounds));
  for (std::size_t n = 0; n < ring.new_faces(); ++n) EXPECT_EQ(to_bound(bounds[n].most()), 77) << "nothing may add up";
  ASSERT_TRUE(ring.bound({0.2, 0.1, 0.35}, bounds));
  for (std::size_t n = 0; n < ring.new_faces(); ++n) {
    EXPECT_NEAR(bounds[n].merged, 77 + 0.1 / Ring::kMost * kBoundUnits, 1e-5);
    EXPECT_EQ(bounds[n].a, 77) << "on the ring nothing changes";
    EXPECT_EQ(bounds[n].b, 77);
  }
  ASSERT_TRUE(ring.bound({0.2, 0.1, 3}, bounds));
  for (std::size_t n = 0; n < ring.new_faces(); ++n) EXPECT_EQ(to_bound(bounds[n].merged), kBoundUnits);
}

// The bound of an old face reaches the new faces above it, and no others.
TEST(Overlay, WhatIsNotKnownSpreadsNoFartherThanItsFace) {
  const auto flat = ring_of(
      5, 9, [] { return 2.0; }, [] { return 0.0; });
  Ring ring({-0.5, 0, 0}, {0.5, 0, 0}, flat, 5);
  ring.set_bounds(2, {kBoundUnits, kBoundUnits, kBoundUnits});  // between the second and the third vertex of the ring
  FaceBounds bounds;
  ASSERT_TRUE(ring.bound({0.3, 0, 0}, bounds));
  for (std::size_t n = 0; n < ring.new_faces(); ++n) EXPECT_EQ(to_bound(bounds[n].most()) > 0, n <= 2) << n;
}

// A bound that one of the faces at a vertex of the ring has stays there.
TEST(Overlay, ABoundOnTheRingStaysThere) {
  const auto flat = ring_of(
      5, 9, [] { return 2.0; }, [] { return 0.0; });
  for (const bool is_after : {true, false}) {
    Ring ring({-0.5, 0, 0}, {0.5, 0, 0}, flat, 5);
    // At the second vertex of the ring: of the face that follows it around u, and of the one before.
    if (is_after) {
      ring.set_bounds(2, {0, 50, 0});
    } else {
      ring.set_bounds(1, {0, 0, 50});
    }
    FaceBounds bounds;
    ASSERT_TRUE(ring.bound({-0.5, 0, 0}, bounds));
    for (std::size_t n = 0; n < ring.new_faces(); ++n) {
      EXPECT_EQ(to_bound(bounds[n].merged), 0) << n;
      EXPECT_EQ(bounds[n].a, n == 1 ? 50 : 0) << n;
      EXPECT_EQ(bounds[n].b, n == 0 ? 50 : 0) << n;
    }
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
