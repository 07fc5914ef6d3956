// Orientations against integers, pairs of triangles against the theorem of separating axes, whole meshes against all
// pairs. Small integers as coordinates make most cases touching, coplanar or both.
// Threads: MeasureSelfIntersections.*
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "isoweave/measure.hpp"
#include "measure/orientation.hpp"
#include "measure/triangle_pair.hpp"
#include "meshes.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::measure_self_intersections_test {
namespace {

using measure::orientation;
using measure::orientation_along;
using measure::TrianglePoints;

__extension__ using Wide = __int128;  // determinants of 24-bit integers have 76 bits
template <class T>
using Integers = std::array<T, 3>;

template <class T>
Integers<T> operator-(const Integers<T>& a, const Integers<T>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

template <class T>
Integers<T> cross(const Integers<T>& a, const Integers<T>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T>
T dot(const Integers<T>& a, const Integers<T>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class T>
Integers<T> integers_of(const Point& p) {
  return {static_cast<T>(p[0]), static_cast<T>(p[1]), static_cast<T>(p[2])};
}

template <class T>
int sign_of(T x) {
  return (x > 0) - (x < 0);
}

int expected_orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  const auto apex = integers_of<Wide>(a);
  return sign_of(dot(cross(integers_of<Wide>(b) - apex, integers_of<Wide>(c) - apex), integers_of<Wide>(d) - apex));
}

int expected_orientation_along(std::size_t axis, const Point& a, const Point& b, const Point& c) {
  const auto apex = integers_of<Wide>(a);
  return sign_of(cross(integers_of<Wide>(b) - apex, integers_of<Wide>(c) - apex)[axis]);
}

class Points {
 public:
  // Whole coordinates in [-reach, reach].
  Point next(int reach) {
    std::uniform_int_distribution<int> number(-reach, reach);
    return {static_cast<float>(number(random_)), static_cast<float>(number(random_)),
            static_cast<float>(number(random_))};
  }

  int next_number(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  TrianglePoints next_triangle(int reach) {
    TrianglePoints t;
    do {
      for (Point& p : t) p = next(reach);
    } while (!measure::has_area(t));
    return t;
  }

 private:
  std::mt19937 random_{11};
};

// Beside a plane by nothing or a few units in the last place, in numbers that use all 24 bits.
TEST(MeasureOrientation, IsThatOfIntegers) {
  Points points;
  for (int n = 0; n < 20000; ++n) {
    const Point a = points.next(1 << 20);
    const Point u = points.next(1 << 10);
    const Point v = points.next(1 << 10);
    std::array<Point, 3> others{};
    for (Point& p : others) {
      const auto s = static_cast<float>(points.next_number(-4000, 4000));
      const auto t = static_cast<float>(points.next_number(-4000, 4000));
      for (std::size_t axis = 0; axis < 3; ++axis) {
        p[axis] = a[axis] + s * u[axis] + t * v[axis] + static_cast<float>(points.next_number(-1, 1) * (n % 2));
      }
    }
    EXPECT_EQ(orientation(a, others[0], others[1], others[2]),
              expected_orientation(a, others[0], others[1], others[2]));
    for (const std::size_t axis : {0U, 1U, 2U}) {
      EXPECT_EQ(orientation_along(axis, a, others[0], others[1]),
                expected_orientation_along(axis, a, others[0], others[1]));
    }
  }
}

// Differences of such numbers are no doubles. The plane is z = x.
TEST(MeasureOrientation, IsExactOverAllExponents) {
  const std::vector<float> numbers{0,       1,    -3,    1e30F,   -1e38F, 1e-30F, 1e-45F,
                                   3.4e38F, -1.F, 1e-3F, 7.7e12F, -5e7F,  1e7F,   0.1F};
  Points points;
  const auto number = [&] { return numbers[static_cast<std::size_t>(points.next_number(0, 13))]; };
  for (int n = 0; n < 20000; ++n) {
    std::array<Point, 4> p{};
    for (Point& q : p) {
      const float x = number();
      q = {x, number(), x};
    }
    EXPECT_EQ(orientation(p[0], p[1], p[2], p[3]), 0);
    // As seen from where z is larger, that is from above the plane.
    const int turn = orientation_along(2, p[0], p[1], p[2]);
    Point above = p[3];
    above[2] = std::nextafter(above[2], std::numeric_limits<float>::infinity());
    EXPECT_EQ(orientation(p[0], p[1], p[2], above), std::isinf(above[2]) ? 0 : turn);
    Point below = p[3];
    below[2] = std::nextafter(below[2], -std::numeric_limits<float>::infinity());
    EXPECT_EQ(orientation(p[0], p[1], p[2], below), -turn);
  }
}

using Hull = std::vector<Integers<long>>;  // of a segment or a triangle

Hull hull_of(std::span<const Point> points) {
  Hull hull;
  for (const Point& p : points) hull.push_back(integers_of<long>(p));
  return hull;
}

bool separates(const Integers<long>& axis, const Hull& a, const Hull& b) {
  const auto range = [&](const Hull& hull) {
    std::vector<long> along;
    for (const auto& p : hull) along.push_back(dot(axis, p));
    return std::pair(*std::min_element(along.begin(), along.end()), *std::max_element(along.begin(), along.end()));
  };
  const auto [low_a, high_a] = range(a);
  const auto [low_b, high_b] = range(b);
  return high_a < low_b || high_b < low_a;
}

// Convex hulls without a common point lie apart along a side, a normal of two sides, or, in one plane, a normal of a
// side in that plane (separating axes).
bool hulls_meet(const Hull& a, const Hull& b) {
  std::vector<Integers<long>> sides;
  for (const Hull* hull : {&a, &b}) {
    for (std::size_t i = 0; i < hull->size(); ++i) sides.push_back((*hull)[(i + 1) % hull->size()] - (*hull)[i]);
  }
  std::vector<Integers<long>> axes = sides;
  for (const auto& s : sides) {
    for (const auto& t : sides) {
      const Integers<long> normal = cross(s, t);
      axes.push_back(normal);
      for (const auto& side : sides) axes.push_back(cross(normal, side));
    }
  }
  return std::none_of(axes.begin(), axes.end(), [&](const auto& axis) { return separates(axis, a, b); });
}

bool expected_meet(const TrianglePoints& s, const TrianglePoints& t) { return hulls_meet(hull_of(s), hull_of(t)); }

// A ray from the vertex leaves one of the triangles first, through the side across, while in the other.
bool expected_meet_beyond_vertex(const TrianglePoints& s, const TrianglePoints& t) {
  return hulls_meet(hull_of(std::span(s).subspan(1)), hull_of(t)) ||
         hulls_meet(hull_of(std::span(t).subspan(1)), hull_of(s));
}

// The normals of both with the edge as first side are the same but for length.
bool expected_meet_beyond_edge(const TrianglePoints& s, const TrianglePoints& t) {
  const auto a = hull_of(s);
  const auto b = hull_of(t);
  const auto n = cross(a[1] - a[0], a[2] - a[0]);
  const auto m = cross(b[1] - b[0], b[2] - b[0]);
  return cross(n, m) == Integers<long>{0, 0, 0} && dot(n, m) > 0;
}

constexpr int kPairs = testing::kSanitized ? 3000 : 60000;

// In a cube of 3 x 3 x 3 points about half of the pairs touch; in a larger one more are in general position.
TEST(MeasureTrianglePair, MeetingIsThatOfSeparatingAxes) {
  Points points;
  int met = 0;
  for (int n = 0; n < kPairs; ++n) {
    const int reach = n % 3 + 1;
    const TrianglePoints s = points.next_triangle(reach);
    const TrianglePoints t = points.next_triangle(reach);
    const bool expected = expected_meet(s, t);
    met += expected ? 1 : 0;
    ASSERT_EQ(measure::triangles_meet(s, t), expected) << n;
    ASSERT_EQ(measure::triangles_meet(t, {s[1], s[0], s[2]}), expected) << n;
  }
  EXPECT_GT(met, kPairs / 5);
  EXPECT_LT(met, kPairs * 4 / 5);
}

TEST(MeasureTrianglePair, InOnePlane) {
  Points points;
  for (int n = 0; n < kPairs; ++n) {
    std::array<TrianglePoints, 2> pair{points.next_triangle(2), points.next_triangle(2)};
    for (TrianglePoints& t : pair) {
      for (Point& p : t) p[static_cast<std::size_t>(n % 3)] = p[static_cast<std::size_t>((n + 1) % 3)] + 1;
    }
    if (!measure::has_area(pair[0]) || !measure::has_area(pair[1])) continue;
    ASSERT_EQ(measure::triangles_meet(pair[0], pair[1]), expected_meet(pair[0], pair[1])) << n;
  }
}

TEST(MeasureTrianglePair, BeyondACommonVertex) {
  Points points;
  int met = 0;
  for (int n = 0; n < kPairs; ++n) {
    const TrianglePoints s = points.next_triangle(n % 3 + 1);
    TrianglePoints t = points.next_triangle(n % 3 + 1);
    t[0] = s[0];
    if (!measure::has_area(t)) continue;
    const bool expected = expected_meet_beyond_vertex(s, t);
    met += expected ? 1 : 0;
    ASSERT_EQ(measure::triangles_meet_beyond_vertex(s, t), expected) << n;
    ASSERT_EQ(measure::triangles_meet_beyond_vertex({t[0], t[2], t[1]}, s), expected) << n;
  }
  EXPECT_GT(met, kPairs / 10);
}

TEST(MeasureTrianglePair, BeyondACommonEdge) {
  Points points;
  int met = 0;
  for (int n = 0; n < kPairs; ++n) {
    const TrianglePoints s = points.next_triangle(1);
    const TrianglePoints t{s[0], s[1], points.next(1)};
    if (!measure::has_area(t)) continue;
    const bool expected = expected_meet_beyond_edge(s, t);
    met += expected ? 1 : 0;
    ASSERT_EQ(measure::triangles_meet_beyond_edge(s, t), expected) << n;
  }
  EXPECT_GT(met, kPairs / 50);
}

// Of all pairs, by the same definition.
SelfIntersections expected_counts(const TriangleMesh& mesh) {
  SelfIntersections result;
  std::vector<bool> in_pair(mesh.triangles.size(), false);
  const auto points = [&](const std::vector<std::uint32_t>& t) -> TrianglePoints {
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t j = i + 1; j < mesh.triangles.size(); ++j) {
      std::vector<std::uint32_t> s(mesh.triangles[i].begin(), mesh.triangles[i].end());
      std::vector<std::uint32_t> t(mesh.triangles[j].begin(), mesh.triangles[j].end());
      std::sort(s.begin(), s.end());
      const auto is_shared = [&](std::uint32_t v) { return std::count(s.begin(), s.end(), v) > 0; };
      std::sort(t.begin(), t.end());
      const auto shared = std::stable_partition(t.begin(), t.end(), is_shared) - t.begin();
      std::stable_partition(s.begin(), s.end(), [&](std::uint32_t v) { return std::count(t.begin(), t.end(), v) > 0; });
      bool meets = shared == 3;
      if (shared == 0) meets = expected_meet(points(s), points(t));
      if (shared == 1) meets = expected_meet_beyond_vertex(points(s), points(t));
      if (shared == 2) meets = expected_meet_beyond_edge(points(s), points(t));
      if (!meets) continue;
      ++(shared == 0 ? result.apart : shared == 1 ? result.at_vertex : result.at_edge);
      result.first.push_back({i, j});
      in_pair[i] = in_pair[j] = true;
    }
  }
  result.triangles = static_cast<std::uint64_t>(std::count(in_pair.begin(), in_pair.end(), true));
  return result;
}

void expect_same(const SelfIntersections& found, const SelfIntersections& expected) {
  EXPECT_EQ(found.apart, expected.apart);
  EXPECT_EQ(found.at_vertex, expected.at_vertex);
  EXPECT_EQ(found.at_edge, expected.at_edge);
  EXPECT_EQ(found.triangles, expected.triangles);
  EXPECT_EQ(found.first, expected.first);
}

// Triangles with area over few vertices, so that many share some.
TriangleMesh soup(std::size_t triangles, int reach) {
  Points points;
  TriangleMesh mesh;
  for (int v = 0; v < 80; ++v) mesh.vertices.push_back(points.next(reach));
  while (mesh.triangles.size() < triangles) {
    std::array<std::uint32_t, 3> t{};
    for (std::uint32_t& v : t) v = static_cast<std::uint32_t>(points.next_number(0, 79));
    if (measure::has_area({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]})) mesh.triangles.push_back(t);
  }
  return mesh;
}

constexpr std::size_t kAll = 1 << 20;

TEST(MeasureSelfIntersections, AreThoseOfAllPairs) {
  for (const int reach : {2, 8, 100}) {
    const TriangleMesh mesh = soup(testing::kSanitized ? 40 : 200, reach);
    const SelfIntersections expected = expected_counts(mesh);
    EXPECT_GT(expected.apart, 100U);
    EXPECT_GT(expected.at_vertex, 10U);
    expect_same(count_self_intersections(mesh, kAll), expected);
  }
}

TEST(MeasureSelfIntersections, DoNotDependOnThreads) {
  const TriangleMesh mesh = soup(testing::kSanitized ? 600 : 3000, 50);
  const SelfIntersections expected = count_self_intersections(mesh, 17, 1);
  EXPECT_EQ(expected.first.size(), 17U);
  EXPECT_TRUE(std::is_sorted(expected.first.begin(), expected.first.end()));
  for (const int threads : {2, 3, 8}) expect_same(count_self_intersections(mesh, 17, threads), expected);
}

TEST(MeasureSelfIntersections, SoundSurfacesHaveNone) {
  for (const TriangleMesh& mesh :
       {meshes::tetrahedron(), meshes::cube(), meshes::grid(30), meshes::two_tetrahedra_sharing_a_vertex(),
        meshes::two_tetrahedra_sharing_an_edge(), TriangleMesh{}}) {
    EXPECT_EQ(count_self_intersections(mesh).pairs(), 0U);
    EXPECT_EQ(count_self_intersections(mesh).triangles, 0U);
  }
}

// Two triangles folded onto each other along their edge, the same triangle twice, and once turned over.
TEST(MeasureSelfIntersections, FoldsAndDoubles) {
  const TriangleMesh fold{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 0, 3}}, {}};
  EXPECT_EQ(count_self_intersections(fold).at_edge, 1U);
  TriangleMesh hinge = fold;
  hinge.vertices[3][2] = 1e-45F;
  EXPECT_EQ(count_self_intersections(hinge).pairs(), 0U);
  TriangleMesh twice = meshes::tetrahedron();
  twice.triangles.push_back({0, 1, 2});
  const SelfIntersections found = count_self_intersections(twice);
  EXPECT_EQ(found.at_edge, 1U);
  EXPECT_EQ(found.triangles, 2U);
  EXPECT_EQ(found.first, (std::vector<std::array<std::uint64_t, 2>>{{0, 4}}));
}

// Boxes that lie on each other with nothing between touch; one float apart they do not.
TEST(MeasureSelfIntersections, TouchingCounts) {
  const TriangleMesh low = meshes::grid(1);
  for (const float z : {0.0F, 1e-45F}) {
    TriangleMesh both = low;
    for (const Point& p : meshes::grid(1, z).vertices) both.vertices.push_back(p);
    both.triangles.push_back({4, 5, 7});
    EXPECT_EQ(count_self_intersections(both).apart, z == 0 ? 2U : 0U);
  }
}

TEST(MeasureSelfIntersections, TrianglesWithoutAreaAreLeftOut) {
  TriangleMesh mesh = meshes::cube();
  mesh.vertices.push_back({-1, 0.5F, 0.5F});
  mesh.vertices.push_back({2, 0.5F, 0.5F});
  mesh.vertices.push_back({0.5F, 0.5F, 0.5F});
  mesh.triangles.push_back({8, 9, 10});
  mesh.triangles.push_back({8, 8, 9});
  const SelfIntersections found = count_self_intersections(mesh);
  EXPECT_EQ(found.without_area, 2U);
  EXPECT_EQ(found.pairs(), 0U);
}

TEST(MeasureSelfIntersections, ListsNoMoreThanAsked) {
  const TriangleMesh mesh = soup(60, 3);
  const SelfIntersections all = count_self_intersections(mesh, kAll);
  ASSERT_EQ(all.first.size(), all.pairs());
  EXPECT_TRUE(count_self_intersections(mesh, 0).first.empty());
  const SelfIntersections few = count_self_intersections(mesh, 3);
  EXPECT_EQ(few.pairs(), all.pairs());
  EXPECT_TRUE(std::equal(few.first.begin(), few.first.end(), all.first.begin(), all.first.begin() + 3));
}

TEST(MeasureSelfIntersections, WrongMeshesAreErrors) {
  TriangleMesh mesh = meshes::cube();
  mesh.triangles[3][1] = 8;
  EXPECT_THROW(count_self_intersections(mesh), std::invalid_argument);
  mesh = meshes::cube();
  mesh.vertices[3][1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(count_self_intersections(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace isoweave::testing::measure_self_intersections_test
