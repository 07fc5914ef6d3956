// Meshes as input: what is not an oriented manifold stays where it is, the rest is simplified.
// Threads: none, mesh_pieces.cpp has the same runs
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "meshes.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::simplify_mesh_test {
namespace {

struct Result {
  TriangleMesh mesh;
  MeshReport report;
};

Result simplify(const TriangleMesh& mesh, int threads = 1) {
  MemorySink sink;
  SimplifyOptions options;
  options.error = Length::voxels(0.5);
  RunControl control;
  control.threads = threads;
  Result result;
  result.report = simplify_mesh(mesh, sink, options, control);
  result.mesh = std::move(sink.mesh);
  return result;
}

bool has_vertex(const TriangleMesh& mesh, const Point& p) {
  return std::find(mesh.vertices.begin(), mesh.vertices.end(), p) != mesh.vertices.end();
}

// Two flat squares that have one corner in common.
TriangleMesh two_squares_sharing_a_corner(std::uint32_t n) {
  TriangleMesh mesh = meshes::grid(n);
  const auto shared = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (const Point& p : meshes::grid(n).vertices) {
    mesh.vertices.push_back({p[0] + static_cast<float>(n), p[1] + static_cast<float>(n), p[2]});
  }
  for (auto t : meshes::grid(n).triangles) {
    for (std::uint32_t& v : t) v = v == 0 ? shared : v + shared + 1;
    mesh.triangles.push_back(t);
  }
  return mesh;
}

// A grid of 24 x 24 squares in waves.
TriangleMesh waves() {
  TriangleMesh mesh = meshes::grid(24);
  for (Point& p : mesh.vertices) p[2] = std::sin(p[0] * 0.4F) * std::cos(p[1] * 0.3F);
  return mesh;
}

TEST(SimplifyMesh, AManifoldHasNothingLocked) {
  EXPECT_EQ(simplify(meshes::cube()).report.locked_vertices, 0u);
  const Result flat = simplify(meshes::grid(12));
  EXPECT_EQ(flat.report.locked_vertices, 0u);
  EXPECT_LT(flat.report.triangles, 8u);
}

TEST(SimplifyMesh, AVertexOfTwoFansStays) {
  EXPECT_EQ(simplify(meshes::two_tetrahedra_sharing_a_vertex()).report.locked_vertices, 1u);
  const TriangleMesh squares = two_squares_sharing_a_corner(10);
  for (const int threads : {1, 3}) {
    const Result result = simplify(squares, threads);
    EXPECT_EQ(result.report.locked_vertices, 1u);
    EXPECT_TRUE(has_vertex(result.mesh, {10, 10, 0}));
    EXPECT_LT(result.report.triangles, squares.triangles.size() / 4);
    EXPECT_EQ(check_mesh(result.mesh).nonmanifold_vertices, 1u);
    EXPECT_EQ(result.report.nonmanifold_vertices, 1u);
  }
}

TEST(SimplifyMesh, EndsOfNonManifoldAndMisorientedEdgesStay) {
  const Result edge = simplify(meshes::two_tetrahedra_sharing_an_edge());
  EXPECT_EQ(edge.report.locked_vertices, 2u);
  EXPECT_EQ(edge.report.nonmanifold_edges, 1u);
  EXPECT_EQ(simplify(meshes::cube_with_a_flipped_triangle()).report.locked_vertices, 3u);
  EXPECT_GT(simplify(meshes::moebius_strip()).report.locked_vertices, 0u);
}

// The cost of such an error is beyond float32.
TEST(SimplifyMesh, HugeErrorsLeaveWhatLargeOnesLeave) {
  for (const Schedule schedule : {Schedule::kQueue, Schedule::kLocal, Schedule::kRounds}) {
    const auto left = [&](double error) {
      MemorySink sink;
      RunControl control;
      control.schedule = schedule;
      return simplify_mesh(waves(), sink, {.error = Length::voxels(error)}, control).digest;
    };
    const std::uint64_t expected = left(1e15);
    for (const double error : {1e19, 1e30, 1e300}) EXPECT_EQ(left(error), expected) << error;
  }
}

TEST(SimplifyMesh, TrianglesThatRepeatAVertexAreLeftOut) {
  TriangleMesh mesh = meshes::grid(6);
  mesh.triangles.insert(mesh.triangles.begin() + 3, {4, 4, 5});
  const Result result = simplify(mesh);
  EXPECT_EQ(result.report.locked_vertices, 0u);
  ASSERT_EQ(result.report.warnings.size(), 1u);
  EXPECT_NE(result.report.warnings.front().find("1 triangles that repeat a vertex"), std::string::npos);
  EXPECT_EQ(result.report.digest, simplify(meshes::grid(6)).report.digest);
}

// Of a plate whose values are the places along x: each is what its place asks for, in between too.
TEST(SimplifyMesh, ValuesGoWithTheirPlaces) {
  const TriangleMesh plain = waves();
  TriangleMesh mesh = plain;
  for (const Point& p : mesh.vertices) mesh.values.push_back(p[0]);
  for (const int threads : {1, 3}) {
    const Result with = simplify(mesh, threads);
    EXPECT_EQ(with.report.digest, simplify(plain, threads).report.digest) << "the mesh is the same without values";
    ASSERT_EQ(with.mesh.values.size(), with.mesh.vertices.size());
    EXPECT_LT(with.mesh.vertices.size(), mesh.vertices.size() / 3);
    double off = 0;
    for (std::size_t v = 0; v < with.mesh.vertices.size(); ++v) {
      off = std::max(off, std::abs(double{with.mesh.values[v]} - with.mesh.vertices[v][0]));
    }
    EXPECT_LT(off, 1) << "of 24 along x";
    EXPECT_GT(off, 0) << "interpolated, not looked up";
  }
}

TEST(SimplifyMesh, ValuesAndNormalsThatDoNotFit) {
  TriangleMesh mesh = meshes::grid(6);
  mesh.values.assign(3, 1);
  EXPECT_THROW(simplify(mesh), std::invalid_argument);
  mesh.values.clear();
  mesh.normals.assign(mesh.vertices.size(), {0, 0, 1});
  EXPECT_EQ(simplify(mesh).report.warnings, std::vector<std::string>{"the normals of the mesh are not kept"});
}

TEST(SimplifyMesh, AVertexThatTheMeshDoesNotHaveIsRefused) {
  TriangleMesh mesh = meshes::grid(6);
  mesh.triangles[5][2] = 0xfffffff0U;
  for (const int threads : {1, 3}) EXPECT_THROW(simplify(mesh, threads), std::invalid_argument);
}

}  // namespace
}  // namespace isoweave::testing::simplify_mesh_test
