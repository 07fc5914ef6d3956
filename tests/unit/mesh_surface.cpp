// Pieces of a mesh: together they are the mesh, and each says what is still to come.
// Threads: none, mesh_pieces.cpp has the same loops
#include "pipeline/mesh_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>

#include "meshes.hpp"

namespace isoweave::testing::mesh_surface_test {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

struct Taken {
  Triangles triangles;  // by the mesh's vertices
  std::vector<std::size_t> sizes;
  std::uint64_t dropped = 0;
};

bool has_later_triangle(const TriangleMesh& mesh, std::uint32_t v, std::size_t end) {
  for (std::size_t t = end; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    if ((v == a || v == b || v == c) && a != b && b != c && c != a) return true;
  }
  return false;
}

// Takes all pieces, and looks at what each says of its vertices.
Taken take_all(const TriangleMesh& mesh, const MeshSurface::Pieces& pieces, int threads) {
  const Executor executor(threads);
  MeshSurface surface(mesh, executor, pieces);
  Taken taken;
  MeshReport report;
  std::vector<std::uint32_t> incomplete;
  std::map<std::uint32_t, int> seen;
  while (!surface.complete()) {
    SurfacePiece piece;
    surface.read({}, report);
    surface.make(piece, report);
    EXPECT_EQ(piece.inherited, incomplete.size());
    std::vector<std::uint32_t> vertices = incomplete;
    for (std::size_t n = 0; n < piece.ids.size(); ++n) {
      const auto v = static_cast<std::uint32_t>(piece.ids[n]);
      EXPECT_EQ(++seen[v], 1) << v;
      const Point& p = mesh.vertices[v];
      EXPECT_TRUE(piece.positions[n].x == p[0] && piece.positions[n].y == p[1] && piece.positions[n].z == p[2]);
      vertices.push_back(v);
    }
    for (const auto& [a, b, c] : piece.triangles) {
      taken.triangles.push_back({vertices.at(a), vertices.at(b), vertices.at(c)});
    }
    taken.sizes.push_back(piece.triangles.size());
    const std::size_t end = taken.triangles.size() + surface.dropped();
    std::vector<bool> listed(vertices.size(), false);
    incomplete.clear();
    for (const std::uint32_t n : piece.incomplete) {
      listed.at(n) = true;
      incomplete.push_back(vertices[n]);
    }
    for (std::size_t n = 0; n < vertices.size(); ++n) {
      EXPECT_EQ(listed[n], has_later_triangle(mesh, vertices[n], end)) << n;
    }
  }
  EXPECT_TRUE(incomplete.empty());
  taken.dropped = surface.dropped();
  return taken;
}

TEST(MeshSurface, PiecesAreTheMesh) {
  const TriangleMesh mesh = meshes::grid(20);
  for (const std::uint64_t size : {1U, 7U, 100U, 799U, 800U, 10000U}) {
    for (const int threads : {1, 3}) {
      const Taken taken = take_all(mesh, {.triangles = size, .exactly = true}, threads);
      EXPECT_EQ(taken.triangles, mesh.triangles);
      EXPECT_EQ(taken.sizes.size(), (mesh.triangles.size() + size - 1) / size);
    }
  }
}

TEST(MeshSurface, TrianglesThatRepeatAVertexAreNotIn) {
  TriangleMesh mesh = meshes::grid(4);
  const Triangles whole = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.begin() + 5, {3, 3, 4});
  mesh.triangles.insert(mesh.triangles.begin() + 6, {24, 0, 24});
  mesh.triangles.push_back({1, 1, 1});
  for (const std::uint64_t size : {1U, 3U, 100U}) {
    const Taken taken = take_all(mesh, {.triangles = size, .exactly = true}, 2);
    EXPECT_EQ(taken.triangles, whole);
    EXPECT_EQ(taken.dropped, 3u);
  }
}

TEST(MeshSurface, PiecesGrowUntilFewVerticesAreIncomplete) {
  TriangleMesh mesh = meshes::grid(40);
  const std::size_t in_order = take_all(mesh, {.triangles = 400}, 1).sizes.size();
  EXPECT_EQ(in_order, mesh.triangles.size() / 400);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(1));
  const Taken shuffled = take_all(mesh, {.triangles = 400}, 1);
  EXPECT_EQ(shuffled.sizes.size(), 1u);
  EXPECT_EQ(shuffled.triangles, mesh.triangles);
}

TEST(MeshSurface, MoreCanBeWanted) {
  const TriangleMesh mesh = meshes::grid(20);
  const Executor executor(1);
  MeshSurface surface(mesh, executor, {.triangles = 50});
  SurfacePiece piece;
  MeshReport report;
  surface.read({.triangles = 600}, report);
  surface.make(piece, report);
  EXPECT_EQ(piece.triangles.size(), 300u);
  surface.read({.triangles = 10}, report);
  surface.make(piece, report);
  EXPECT_GE(piece.triangles.size(), 50u);
  surface.read({.triangles = 10000}, report);
  surface.make(piece, report);
  EXPECT_TRUE(surface.complete());
}

TEST(MeshSurface, AVertexThatTheMeshDoesNotHaveIsRefused) {
  TriangleMesh mesh = meshes::grid(2);
  mesh.triangles.push_back({0, 1, 9});
  const Executor executor(1);
  EXPECT_THROW(MeshSurface(mesh, executor, {.triangles = 1}), std::invalid_argument);
}

}  // namespace
}  // namespace isoweave::testing::mesh_surface_test
