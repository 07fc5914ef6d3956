
// Threads: MeasureDistance.*
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "isoweave/measure.hpp"
#include "measure/triangle_tree.hpp"
#include "meshes.hpp"

namespace isoweave::testing::measure_distance_test {
namespace {

using measure::Vector;

Point at_distance(const Point& p, double radius) {
  const double scale = radius / std::sqrt(double{p[0]} * p[0] + double{p[1]} * p[1] + double{p[2]} * p[2]);
  return {static_cast<float>(p[0] * scale), static_cast<float>(p[1] * scale), static_cast<float>(p[2] * scale)};
}

// An octahedron refined and pushed out to the sphere.
TriangleMesh sphere(double radius, int refinements) {
  TriangleMesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                    {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}},
                    {}};
  for (int i = 0; i < refinements; ++i) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
      if (is_new) {
        const Point p = mesh.vertices[a];
        const Point q = mesh.vertices[b];
        mesh.vertices.push_back(at_distance({p[0] + q[0], p[1] + q[1], p[2] + q[2]}, 1));
      }
      return found->second;
    };
    std::vector<meshes::Triangle> finer;
    for (const auto& t : mesh.triangles) {
      const std::uint32_t ab = middle(t[0], t[1]);
      const std::uint32_t bc = middle(t[1], t[2]);
      const std::uint32_t ca = middle(t[2], t[0]);
      for (const meshes::Triangle& f : {meshes::Triangle{t[0], ab, ca}, meshes::Triangle{ab, t[1], bc},
                                        meshes::Triangle{ca, bc, t[2]}, meshes::Triangle{ab, bc, ca}}) {
        finer.push_back(f);
      }
    }
    mesh.triangles = std::move(finer);
  }
  for (Point& p : mesh.vertices) p = at_distance(p, radius);
  return mesh;
}

// Parallel squares, and one corner of them pulled away.
TEST(MeasureDistance, HistogramsCountEverySampleOnce) {
  const TriangleMesh low = meshes::grid(4);
  TriangleMesh high = meshes::grid(4, 3);
  const MeshDistance flat = compare_meshes(low, high, {.samples = 5000, .bins = 8});
  EXPECT_EQ(flat.a_to_b.histogram, (std::vector<std::uint64_t>{0, 0, 0, 0, 0, 0, 0, 5000}));
  EXPECT_EQ(flat.b_to_a.histogram, flat.a_to_b.histogram);
  for (Point& p : high.vertices) p[2] = 1.5F + p[0];  // from 1.5 to 5.5: nothing below a quarter of the largest
  const MeshDistance slanted = compare_meshes(high, low, {.samples = 5000, .bins = 4});
  std::uint64_t samples = 0;
  for (const std::uint64_t count : slanted.a_to_b.histogram) samples += count;
  EXPECT_EQ(samples, 5000u);
  EXPECT_EQ(slanted.a_to_b.histogram[0], 0u);
  EXPECT_GT(slanted.a_to_b.histogram[3], 1000u);
  EXPECT_TRUE(compare_meshes(low, high, {.samples = 10}).a_to_b.histogram.empty());
  const MeshDistance none = compare_meshes(low, low, {.samples = 100, .bins = 3});
  EXPECT_EQ(none.a_to_b.histogram, (std::vector<std::uint64_t>{100, 0, 0}));
}

TEST(MeasureDistance, OfEveryVertex) {
  const TriangleMesh square = meshes::grid(3);
  TriangleMesh points = meshes::tetrahedron();
  points.vertices = {{1, 1, 0.5F}, {0, 0, 0}, {-3, 0, 4}, {5, 3, 0}};
  for (const int threads : {1, 3}) {
    EXPECT_EQ(vertex_distances(points, square, threads), (std::vector<float>{0.5F, 0, 5, 2}));
  }
  EXPECT_THROW(vertex_distances(points, TriangleMesh{}), std::invalid_argument);
}

TEST(MeasureDistance, IdenticalMeshesAreAtZero) {
  const TriangleMesh mesh = sphere(1, 4);
  const MeshDistance d = compare_meshes(mesh, mesh, {.samples = 20000});
  EXPECT_LT(d.max, 1e-14);
}

// All points of one plane are equally far from the other: mean, root mean square and maximum agree.
TEST(MeasureDistance, ParallelPlanes) {
  const MeshDistance d = compare_meshes(meshes::grid(4), meshes::grid(4, 0.25F), {.samples = 5000});
  for (const OneWayDistance& way : {d.a_to_b, d.b_to_a}) {
    EXPECT_NEAR(way.mean, 0.25, 1e-12);
    EXPECT_NEAR(way.rms, 0.25, 1e-12);
    EXPECT_NEAR(way.max, 0.25, 1e-12);
  }
}

// A small square within a large one: at zero one way, not the other. The farthest point of the large one is a corner,
// 3 sqrt 2 away, and the mean distance from [0,4]^2 to [0,1]^2 is a little calculus.
TEST(MeasureDistance, TheTwoWaysDiffer) {
  const MeshDistance d = compare_meshes(meshes::grid(1), meshes::grid(4), {.samples = 50000});
  EXPECT_LT(d.a_to_b.max, 1e-12);
  EXPECT_NEAR(d.b_to_a.max, 3 * std::numbers::sqrt2, 0.1);
  const double strips = 2 * 3 * 1.5;  // two strips of 1 x 3, mean distance 1.5
  const double corner = 27 * (std::numbers::sqrt2 + std::log(1 + std::numbers::sqrt2)) / 3;  // 3 x 3 from its corner
  EXPECT_NEAR(d.b_to_a.mean, (strips + corner) / 16, 0.02);
  EXPECT_DOUBLE_EQ(d.mean, (d.a_to_b.mean + d.b_to_a.mean) / 2);
  EXPECT_DOUBLE_EQ(d.rms, std::sqrt((d.a_to_b.rms * d.a_to_b.rms + d.b_to_a.rms * d.b_to_a.rms) / 2));
  EXPECT_DOUBLE_EQ(d.max, d.b_to_a.max);
}

// Concentric spheres are the difference of the radii apart, up to the sagitta of their triangles.
TEST(MeasureDistance, ConcentricSpheres) {
  const MeshDistance d = compare_meshes(sphere(1, 5), sphere(1.5, 5), {.samples = 4000});
  EXPECT_NEAR(d.mean, 0.5, 2e-3);
  EXPECT_NEAR(d.max, 0.5, 4e-3);
}

// Equal spheres, centres 0.5 apart: the farthest point of each is on the axis, 0.5 from the other.
TEST(MeasureDistance, OffsetSpheres) {
  TriangleMesh moved = sphere(1, 5);
  for (Point& p : moved.vertices) p[0] += 0.5F;
  const MeshDistance d = compare_meshes(sphere(1, 5), moved, {.samples = 6000});
  EXPECT_NEAR(d.a_to_b.max, 0.5, 4e-3);
  // The mean over the unit sphere of | |x - c| - 1 | with |c| = 1/2, integrated over s = |x - c| from 1/2 to 3/2:
  // the density of s is s / (2 |c|) = s, so it is the integral of |s - 1| s = 1/4.
  EXPECT_NEAR(d.a_to_b.mean, 0.25, 8e-3);
  EXPECT_NEAR(d.b_to_a.mean, 0.25, 8e-3);
}

TEST(MeasureDistance, SameForAnyNumberOfThreads) {
  const TriangleMesh a = sphere(1, 4);
  const TriangleMesh b = sphere(1.01, 3);
  const MeshDistance one = compare_meshes(a, b, {.samples = 9000, .threads = 1});
  for (const int threads : {2, 3, 8}) {
    const MeshDistance many = compare_meshes(a, b, {.samples = 9000, .threads = threads});
    EXPECT_EQ(one.a_to_b.mean, many.a_to_b.mean);
    EXPECT_EQ(one.a_to_b.rms, many.a_to_b.rms);
    EXPECT_EQ(one.b_to_a.max, many.b_to_a.max);
    EXPECT_EQ(one.rms, many.rms);
  }
}

TEST(MeasureDistance, SymmetricAndSeeded) {
  const TriangleMesh a = sphere(1, 3);
  const TriangleMesh b = meshes::cube();
  const MeshDistance ab = compare_meshes(a, b, {.samples = 3000});
  const MeshDistance ba = compare_meshes(b, a, {.samples = 3000});
  EXPECT_EQ(ab.a_to_b.mean, ba.b_to_a.mean);
  EXPECT_EQ(ab.rms, ba.rms);
  EXPECT_NE(ab.rms, compare_meshes(a, b, {.samples = 3000, .seed = 2}).rms);
}

// Samples follow area, not the number of triangles: a thousand slivers in a corner must not outweigh the rest.
TEST(MeasureDistance, SamplesFollowArea) {
  TriangleMesh mesh = meshes::grid(1);
  for (int i = 0; i < 1000; ++i) {
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {{5, 0, 0}, {5.001F, 0, 0}, {5, 0.001F, 0}});
    mesh.triangles.push_back({base, base + 1, base + 2});
  }
  EXPECT_NEAR(compare_meshes(mesh, meshes::grid(1), {.samples = 10000}).a_to_b.mean, 4 * 5e-4, 5e-4);
}

// Triangles without area are segments or points; nothing may become NaN.
TEST(MeasureDistance, MeshesWithoutArea) {
  const TriangleMesh segment{{{0, 0, 1}, {1, 0, 1}}, {{0, 1, 1}}, {}};
  const TriangleMesh point{{{0, 0, 0}}, {{0, 0, 0}}, {}};
  EXPECT_NEAR(compare_meshes(point, segment, {.samples = 100}).a_to_b.max, 1, 1e-15);
  EXPECT_NEAR(compare_meshes(segment, point, {.samples = 1000}).a_to_b.max, std::numbers::sqrt2, 0.01);
  // Two points that count alike: half of the samples are at 0, half at 2.
  const TriangleMesh two{{{0, 0, 0}, {2, 0, 0}}, {{1, 1, 1}, {0, 0, 0}}, {}};
  EXPECT_DOUBLE_EQ(compare_meshes(two, point, {.samples = 1000}).a_to_b.mean, 1);
}

TEST(MeasureDistance, BadArgumentsAreRefused) {
  TriangleMesh mesh = meshes::cube();
  EXPECT_THROW(compare_meshes(mesh, {}), std::invalid_argument);
  EXPECT_THROW(compare_meshes({}, mesh), std::invalid_argument);
  EXPECT_THROW(compare_meshes(mesh, mesh, {.samples = 0}), std::invalid_argument);
  mesh.triangles[0][0] = 99;
  EXPECT_THROW(compare_meshes(meshes::cube(), mesh), std::invalid_argument);
  mesh = meshes::cube();
  mesh.vertices[0][0] = std::numeric_limits<float>::infinity();
  EXPECT_THROW(compare_meshes(mesh, meshes::cube()), std::invalid_argument);
}

// Above the face, beside each edge, beyond each corner: the seven regions of a triangle.
TEST(MeasureDistance, PointToTriangleInEveryRegion) {
  const measure::TriangleCorners t{Vector{0, 0, 0}, Vector{4, 0, 0}, Vector{0, 4, 0}};
  EXPECT_DOUBLE_EQ(measure::squared_distance({1, 1, 3}, t), 9) << "above the face";
  EXPECT_DOUBLE_EQ(measure::squared_distance({1, 1, -3}, t), 9) << "below it";
  EXPECT_DOUBLE_EQ(measure::squared_distance({2, -1, 2}, t), 5) << "beside a b";
  EXPECT_DOUBLE_EQ(measure::squared_distance({-2, 3, 1}, t), 5) << "beside c a";
  EXPECT_DOUBLE_EQ(measure::squared_distance({4, 4, 0}, t), 8) << "beside b c";
  EXPECT_DOUBLE_EQ(measure::squared_distance({-1, -2, 2}, t), 9) << "beyond a";
  EXPECT_DOUBLE_EQ(measure::squared_distance({6, -1, 2}, t), 9) << "beyond b";
  EXPECT_DOUBLE_EQ(measure::squared_distance({-1, 6, 2}, t), 9) << "beyond c";
}

// The normal of three points on a line is rounding noise. Above the line beyond its end all signs are noise too, and
// taken seriously they would say that the point is above the triangle.
TEST(MeasureDistance, PointToTriangleOnALine) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vector a{anywhere(random), anywhere(random), 0};
    const Vector b{anywhere(random), anywhere(random), 0};
    const auto on_line = [&](double s, double z) {
      return Vector{a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), z};
    };
    const Vector p = on_line(3, anywhere(random));
    const double expected = measure::squared_distance(p, {a, b, b});
    EXPECT_NEAR(measure::squared_distance(p, {a, b, on_line(0.4, 0)}), expected, 1e-12) << i;
  }
}

// The tree against the definition, on triangles of all sizes, duplicates among them so that centres tie.
TEST(MeasureDistance, TreeAgreesWithTryingAllTriangles) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> anywhere(-1, 1);
  for (const std::size_t count : {1U, 2U, 4U, 5U, 9U, 100U, 1000U}) {
    TriangleMesh mesh;
    for (std::uint32_t t = 0; t < count; ++t) {
      const float size = t % 7 == 0 ? 1.0F : 0.05F;
      const Point a{anywhere(random), anywhere(random), anywhere(random)};
      for (int c = 0; c < 3; ++c) {
        mesh.vertices.push_back(
            {a[0] + size * anywhere(random), a[1] + size * anywhere(random), a[2] + size * anywhere(random)});
      }
      const std::uint32_t source = t % 3 == 0 ? t / 2 : t;
      mesh.triangles.push_back({3 * source, 3 * source + 1, 3 * source + 2});
    }
    const measure::TriangleTree tree(mesh, Executor(2));
    std::size_t hint = measure::TriangleTree::kNoHint;
    for (int i = 0; i < 200; ++i) {
      const Vector p{2 * double{anywhere(random)}, 2 * double{anywhere(random)}, 2 * double{anywhere(random)}};
      double expected = std::numeric_limits<double>::infinity();
      for (std::size_t t = 0; t < count; ++t) {
        expected = std::min(expected, measure::squared_distance(p, measure::corners_of(mesh, t)));
      }
      EXPECT_EQ(tree.squared_distance_from(p, hint), expected) << count << " triangles, point " << i;
      std::size_t none = measure::TriangleTree::kNoHint;
      EXPECT_EQ(tree.squared_distance_from(p, none), expected) << "without a hint";
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::measure_distance_test
