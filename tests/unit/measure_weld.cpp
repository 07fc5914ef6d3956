// Welding of doubled vertices, and the seams that tell of them.
#include <gtest/gtest.h>

#include <stdexcept>

#include "isoweave/measure.hpp"
#include "isoweave/weld.hpp"
#include "meshes.hpp"

namespace isoweave::testing::measure_weld_test {
namespace {

using meshes::Triangle;

// Each triangle with vertices of its own.
TriangleMesh soup(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    for (const std::uint32_t v : t) result.vertices.push_back(mesh.vertices[v]);
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

// Both meshes, moved apart along x.
TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, float along_x) {
  const auto first = static_cast<std::uint32_t>(a.vertices.size());
  for (const Point& p : b.vertices) a.vertices.push_back({p[0] + along_x, p[1], p[2]});
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

TEST(Weld, ASoupBecomesTheMeshThatItWas) {
  TriangleMesh mesh = soup(meshes::cube());
  EXPECT_EQ(check_mesh(mesh).open_edges, 36U);
  EXPECT_EQ(count_seam_edges(mesh), 36U);
  EXPECT_EQ(weld_vertices(mesh), 28U);
  const MeshCheck check = check_mesh(mesh);
  EXPECT_EQ(check.vertices, 8U);
  EXPECT_EQ(check.open_edges, 0U);
  EXPECT_EQ(check.digest, check_mesh(meshes::cube()).digest);
  EXPECT_EQ(count_seam_edges(mesh), 0U);
  EXPECT_EQ(weld_vertices(mesh), 0U);
}

TEST(Weld, TheFirstStaysWithItsNormalAndValue) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {0, 0, 0}, {-0.0F, 0, -0.0F}, {0, 1, 0}, {1, -0.0F, 0}, {0, 0, 1}};
  mesh.normals = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  mesh.values = {10, 11, 12, 13, 14, 15};
  mesh.triangles = {{1, 0, 3}, {2, 5, 4}, {2, 1, 3}};
  EXPECT_EQ(weld_vertices(mesh), 2U);
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(mesh.normals, (std::vector<Point>{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, -1}}));
  EXPECT_EQ(mesh.values, (std::vector<float>{10, 11, 13, 15}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{1, 0, 2}, {1, 3, 0}, {1, 1, 2}}))
      << "the last one has no area left";
}

TEST(Weld, MoreVerticesThanTheTableStartsWith) {
  TriangleMesh mesh = soup(meshes::grid(40));
  EXPECT_EQ(weld_vertices(mesh), 3U * 2 * 40 * 40 - 41 * 41);
  EXPECT_EQ(check_mesh(mesh).open_edges, 160U);
}

TEST(Weld, SeamsAreBordersOnBorders) {
  EXPECT_EQ(count_seam_edges(meshes::grid(5)), 0U) << "a border without another";
  EXPECT_EQ(count_seam_edges(joined(meshes::grid(5), meshes::grid(5), 5)), 10U) << "five edges, from both sides";
  EXPECT_EQ(count_seam_edges(joined(meshes::cube(), meshes::cube(), 1)), 0U) << "two closed cubes that touch";
  EXPECT_EQ(count_seam_edges({}), 0U);
  // A slit: the seam between two triangles of a square has one doubled end.
  TriangleMesh slit = meshes::grid(1);
  slit.vertices.push_back(slit.vertices[3]);
  slit.triangles[1][1] = 4;
  EXPECT_EQ(count_seam_edges(slit), 2U);
}

TEST(Weld, AVertexThatTheMeshDoesNotHaveIsRefused) {
  TriangleMesh mesh = meshes::cube();
  mesh.triangles[3][1] = 8;
  EXPECT_THROW(weld_vertices(mesh), std::invalid_argument);
  EXPECT_THROW(count_seam_edges(mesh), std::invalid_argument);
}

}  // namespace
}  // namespace isoweave::testing::measure_weld_test
