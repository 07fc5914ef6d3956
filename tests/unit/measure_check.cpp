// Every count on a mesh small enough to count by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "isoweave/measure.hpp"
#include "meshes.hpp"

namespace isoweave::testing::measure_check_test {
namespace {

// What holds for a closed, oriented manifold.
void expect_clean(const MeshCheck& check) {
  EXPECT_EQ(check.unused_vertices, 0U);
  EXPECT_EQ(check.degenerate_triangles, 0U);
  EXPECT_EQ(check.open_edges, 0U);
  EXPECT_EQ(check.nonmanifold_edges, 0U);
  EXPECT_EQ(check.misoriented_edges, 0U);
  EXPECT_EQ(check.nonmanifold_vertices, 0U);
}

// Nu x nv quads on a torus: the simplest surface whose Euler number is not that of a sphere.
TriangleMesh torus(std::uint32_t nu, std::uint32_t nv) {
  TriangleMesh mesh;
  for (std::uint32_t u = 0; u < nu; ++u) {
    for (std::uint32_t v = 0; v < nv; ++v) {
      mesh.vertices.push_back({static_cast<float>(u), static_cast<float>(v), 0});
      const auto at = [&](std::uint32_t i, std::uint32_t j) { return (i % nu) * nv + j % nv; };
      mesh.triangles.push_back({at(u, v), at(u + 1, v), at(u + 1, v + 1)});
      mesh.triangles.push_back({at(u, v), at(u + 1, v + 1), at(u, v + 1)});
    }
  }
  return mesh;
}

TEST(MeasureCheck, Tetrahedron) {
  const MeshCheck check = check_mesh(meshes::tetrahedron());
  expect_clean(check);
  EXPECT_EQ(check.vertices, 4U);
  EXPECT_EQ(check.triangles, 4U);
  EXPECT_EQ(check.components, 1U);
  EXPECT_EQ(check.euler, 2);
  EXPECT_DOUBLE_EQ(check.volume, 1.0 / 6);
  EXPECT_DOUBLE_EQ(check.area, 1.5 + std::sqrt(3.0) / 2);
}

TEST(MeasureCheck, Cube) {
  const MeshCheck check = check_mesh(meshes::cube());
  expect_clean(check);
  EXPECT_EQ(check.vertices, 8U);
  EXPECT_EQ(check.triangles, 12U);
  EXPECT_EQ(check.euler, 2);  // 8 - 18 + 12
  EXPECT_DOUBLE_EQ(check.volume, 1);
  EXPECT_DOUBLE_EQ(check.area, 6);
}

// A tunnel lowers the Euler number by two: n - 3n + 2n.
TEST(MeasureCheck, Torus) {
  const MeshCheck check = check_mesh(torus(5, 4));
  expect_clean(check);
  EXPECT_EQ(check.euler, 0);
  EXPECT_EQ(check.components, 1U);
}

// Turned inside out, only the sign of the volume and the digest change.
TEST(MeasureCheck, InsideOutCubeHasNegativeVolume) {
  TriangleMesh mesh = meshes::cube();
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  const MeshCheck check = check_mesh(mesh);
  expect_clean(check);
  EXPECT_DOUBLE_EQ(check.volume, -1);
  EXPECT_NE(check.digest, check_mesh(meshes::cube()).digest);
}

// Far from the origin the tetrahedra over the origin are huge and cancel; over a point of the mesh they do not.
TEST(MeasureCheck, VolumeFarFromTheOrigin) {
  TriangleMesh mesh = meshes::cube();
  for (Point& p : mesh.vertices) p = {p[0] / 3 + 100000.3F, p[1] / 3 - 70000.2F, p[2] / 3 + 130000.4F};
  // Rounding to float32 moved the faces, but left a box.
  const Point& low = mesh.vertices[0];
  const Point& high = mesh.vertices[7];
  const double box = (double{high[0]} - low[0]) * (double{high[1]} - low[1]) * (double{high[2]} - low[2]);
  EXPECT_DOUBLE_EQ(check_mesh(mesh).volume, box);
}

// A disc: open along its rim, which is not a defect of its vertices.
TEST(MeasureCheck, OpenGrid) {
  const MeshCheck check = check_mesh(meshes::grid(3));
  EXPECT_EQ(check.open_edges, 12U);
  EXPECT_EQ(check.nonmanifold_edges, 0U);
  EXPECT_EQ(check.misoriented_edges, 0U);
  EXPECT_EQ(check.nonmanifold_vertices, 0U);
  EXPECT_EQ(check.euler, 1);
  EXPECT_DOUBLE_EQ(check.area, 9);
}

// Every edge has two triangles, yet around vertex 0 there are two fans.
TEST(MeasureCheck, TwoTetrahedraSharingAVertex) {
  const MeshCheck check = check_mesh(meshes::two_tetrahedra_sharing_a_vertex());
  EXPECT_EQ(check.open_edges, 0U);
  EXPECT_EQ(check.nonmanifold_edges, 0U);
  EXPECT_EQ(check.misoriented_edges, 0U);
  EXPECT_EQ(check.nonmanifold_vertices, 1U);
  EXPECT_EQ(check.components, 1U);
  EXPECT_EQ(check.euler, 3);  // 7 - 12 + 8
  EXPECT_DOUBLE_EQ(check.volume, 2.0 / 6);
}

// One edge has four triangles, and both its ends count with it. An edge of four is not called misoriented.
TEST(MeasureCheck, TwoTetrahedraSharingAnEdge) {
  const MeshCheck check = check_mesh(meshes::two_tetrahedra_sharing_an_edge());
  EXPECT_EQ(check.open_edges, 0U);
  EXPECT_EQ(check.nonmanifold_edges, 1U);
  EXPECT_EQ(check.misoriented_edges, 0U);
  EXPECT_EQ(check.nonmanifold_vertices, 2U);
  EXPECT_EQ(check.components, 1U);
  EXPECT_EQ(check.euler, 3);  // 6 - 11 + 8
  EXPECT_DOUBLE_EQ(check.volume, 2.0 / 6);
}

// No choice of orientations makes a one-sided strip agree along all its edges.
TEST(MeasureCheck, MoebiusStrip) {
  const MeshCheck check = check_mesh(meshes::moebius_strip());
  EXPECT_EQ(check.open_edges, 5U);
  EXPECT_EQ(check.nonmanifold_edges, 0U);
  EXPECT_EQ(check.nonmanifold_vertices, 0U);
  EXPECT_EQ(check.misoriented_edges % 2, 1U);
  EXPECT_EQ(check.euler, 0);
}

TEST(MeasureCheck, FlippedTriangle) {
  const MeshCheck check = check_mesh(meshes::cube_with_a_flipped_triangle());
  EXPECT_EQ(check.misoriented_edges, 3U);
  EXPECT_EQ(check.nonmanifold_vertices, 0U);
  EXPECT_EQ(check.euler, 2);
  EXPECT_NE(check.digest, check_mesh(meshes::cube()).digest);
}

// The same triangle twice: its edges have three triangles.
TEST(MeasureCheck, DoubledTriangle) {
  TriangleMesh mesh = meshes::cube();
  mesh.triangles.push_back(mesh.triangles[0]);
  const MeshCheck check = check_mesh(mesh);
  EXPECT_EQ(check.nonmanifold_edges, 3U);
  EXPECT_EQ(check.nonmanifold_vertices, 3U);
}

// A triangle with a repeated vertex has no three sides: it is counted, and everything else is as without it.
TEST(MeasureCheck, DegenerateTrianglesAreSetAside) {
  TriangleMesh mesh = meshes::cube();
  mesh.triangles.push_back({0, 0, 7});
  mesh.triangles.push_back({3, 3, 3});
  const MeshCheck check = check_mesh(mesh);
  EXPECT_EQ(check.triangles, 14U);
  EXPECT_EQ(check.degenerate_triangles, 2U);
  EXPECT_EQ(check.open_edges, 0U);
  EXPECT_EQ(check.nonmanifold_edges, 0U);
  EXPECT_EQ(check.nonmanifold_vertices, 0U);
  EXPECT_EQ(check.euler, 2);
}

TEST(MeasureCheck, UnusedVerticesAndComponents) {
  TriangleMesh mesh = meshes::cube();
  mesh.vertices.push_back({9, 9, 9});
  const TriangleMesh other = meshes::tetrahedron();
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
  const MeshCheck check = check_mesh(mesh);
  EXPECT_EQ(check.unused_vertices, 1U);
  EXPECT_EQ(check.vertices, 12U);
  EXPECT_EQ(check.components, 2U);
  EXPECT_EQ(check.euler, 4);
}

TEST(MeasureCheck, EmptyMesh) {
  const MeshCheck check = check_mesh({});
  expect_clean(check);
  EXPECT_EQ(check.triangles, 0U);
  EXPECT_EQ(check.euler, 0);
  EXPECT_EQ(check.digest, 0U);
}

// A triangle whose smallest angle lies at the origin.
TriangleMesh triangle_with_angle(double degrees) {
  const double angle = degrees * std::acos(-1.0) / 180;
  return {{{0, 0, 0}, {1, 0, 0}, {static_cast<float>(std::cos(angle)), 0, static_cast<float>(std::sin(angle))}},
          {{0, 1, 2}},
          {}};
}

TEST(MeasureAngles, OfHalvedSquares) {
  const TriangleAngles angles = check_mesh(meshes::grid(3)).angles;
  EXPECT_EQ(angles.triangles, 18U);
  EXPECT_DOUBLE_EQ(angles.smallest, 45);
  EXPECT_DOUBLE_EQ(angles.largest, 90);
  EXPECT_EQ(angles.under_5_degrees, 0U);
  EXPECT_EQ(angles.smallest_in_bins, (std::array<std::uint64_t, 10>{0, 0, 0, 0, 0, 0, 0, 18, 0, 0}));
}

TEST(MeasureAngles, OnBothSidesOfEveryLimit) {
  for (std::size_t bin = 0; bin < 10; ++bin) {
    for (const double degrees : {6.0 * static_cast<double>(bin) + 0.001, 6.0 * static_cast<double>(bin) + 5.999}) {
      const TriangleAngles angles = check_mesh(triangle_with_angle(degrees)).angles;
      EXPECT_NEAR(angles.smallest, degrees, 1e-5);
      EXPECT_NEAR(angles.largest, 90 - degrees / 2, 1e-3);
      EXPECT_EQ(angles.smallest_in_bins[bin], 1U) << degrees;
    }
  }
  EXPECT_EQ(check_mesh(triangle_with_angle(4.999)).angles.under_5_degrees, 1U);
  EXPECT_EQ(check_mesh(triangle_with_angle(5.001)).angles.under_5_degrees, 0U);
}

TEST(MeasureAngles, WithoutAreaTheyAre0And180) {
  for (const Point& third : {Point{2, 4, 6}, Point{1, 2, 3}}) {
    const TriangleAngles angles = check_mesh({{{0, 0, 0}, {1, 2, 3}, third}, {{0, 1, 2}}, {}}).angles;
    EXPECT_EQ(angles.smallest, 0);
    EXPECT_EQ(angles.largest, 180);
    EXPECT_EQ(angles.under_5_degrees, 1U);
    EXPECT_EQ(angles.smallest_in_bins[0], 1U);
  }
}

// A triangle with a repeated vertex has no angles.
TEST(MeasureAngles, DegenerateTrianglesHaveNone) {
  EXPECT_TRUE(std::isnan(check_mesh({}).angles.smallest));
  TriangleMesh mesh = meshes::cube();
  mesh.triangles.push_back({0, 0, 7});
  const TriangleAngles angles = check_mesh(mesh).angles;
  EXPECT_EQ(angles.triangles, 12U);
  EXPECT_DOUBLE_EQ(angles.smallest, 45);
}

TEST(MeasureCheck, IndexOutOfRangeIsAnError) {
  TriangleMesh mesh = meshes::cube();
  mesh.triangles[3][1] = 8;
  EXPECT_THROW(check_mesh(mesh), std::invalid_argument);
}

// Numbering, order and rotation are accidents of how a mesh was made.
TEST(MeasureCheck, NothingChangesUnderPermutationAndRotation) {
  std::mt19937 random(3);
  TriangleMesh mesh = torus(7, 5);
  const MeshCheck before = check_mesh(mesh);
  std::vector<std::uint32_t> number(mesh.vertices.size());
  for (std::uint32_t i = 0; i < number.size(); ++i) number[i] = i;
  std::shuffle(number.begin(), number.end(), random);
  TriangleMesh other;
  other.vertices.resize(mesh.vertices.size());
  for (std::size_t i = 0; i < number.size(); ++i) other.vertices[number[i]] = mesh.vertices[i];
  for (const auto& t : mesh.triangles) {
    const std::size_t turn = random() % 3;
    other.triangles.push_back({number[t[turn]], number[t[(turn + 1) % 3]], number[t[(turn + 2) % 3]]});
  }
  std::shuffle(other.triangles.begin(), other.triangles.end(), random);
  const MeshCheck after = check_mesh(other);
  expect_clean(after);
  EXPECT_EQ(after.digest, before.digest);
  EXPECT_EQ(after.euler, before.euler);
  EXPECT_EQ(after.components, before.components);
}

TEST(MeasureCheck, DigestSeesOneBitOfOneCoordinate) {
  TriangleMesh mesh = meshes::cube();
  const std::uint64_t before = check_mesh(mesh).digest;
  mesh.vertices[5][1] = std::nextafter(mesh.vertices[5][1], 1.0F);
  EXPECT_NE(check_mesh(mesh).digest, before);
}

}  // namespace
}  // namespace isoweave::testing::measure_check_test
