// A mesh gives the same result whatever the pieces in which it is taken in, and the report says what the result is,
// also where the mesh is not a manifold.
// Threads: *MeshPieces.*Levels/box*:*MeshPieces.*LockTheSame*/box*
// Threads: *MeshPieces.*Levels/noiseOpen:*MeshPieces.*LockTheSame*/noiseOpen
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "meshes.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::mesh_pieces_test {
namespace {

constexpr std::uint64_t kWhole = 1 << 30;

struct Result {
  std::vector<TriangleMesh> meshes;     // per level
  std::vector<SurfaceReport> surfaces;  // the same
  MeshReport report;
};

Result simplify(const TriangleMesh& mesh, const SimplifyOptions& options, std::uint64_t piece, int threads) {
  RunControl control;
  control.piece = piece;
  control.threads = threads;
  std::vector<MemorySink> sinks(options.levels.size() + 1);
  std::vector<MeshSink*> pointers;
  for (MemorySink& sink : sinks) pointers.push_back(&sink);
  Result result;
  result.report = simplify_mesh(mesh, pointers, options, control);
  result.surfaces = result.report.levels;
  result.surfaces.push_back(result.report);
  for (MemorySink& sink : sinks) result.meshes.push_back(std::move(sink.mesh));
  return result;
}

void expect_told(const SurfaceReport& report, const TriangleMesh& mesh) {
  const MeshCheck check = check_mesh(mesh);
  EXPECT_EQ(report.triangles, check.triangles);
  EXPECT_EQ(report.vertices, check.vertices);
  EXPECT_EQ(report.open_edges, check.open_edges);
  EXPECT_EQ(report.nonmanifold_edges, check.nonmanifold_edges);
  EXPECT_EQ(report.nonmanifold_vertices, check.nonmanifold_vertices);
  EXPECT_EQ(report.components, check.components);
  EXPECT_EQ(report.euler, check.euler);
  EXPECT_EQ(report.digest, check.digest);
}

void expect_same(const Result& found, const Result& expected) {
  ASSERT_EQ(found.surfaces.size(), expected.surfaces.size());
  for (std::size_t level = 0; level < found.surfaces.size(); ++level) {
    SCOPED_TRACE("level " + std::to_string(level));
    EXPECT_EQ(found.surfaces[level].digest, expected.surfaces[level].digest);
    EXPECT_EQ(found.surfaces[level].error, expected.surfaces[level].error);
    expect_told(found.surfaces[level], found.meshes[level]);
  }
  EXPECT_EQ(found.report.collapses, expected.report.collapses);
  EXPECT_EQ(found.report.postponed, expected.report.postponed);
  EXPECT_EQ(found.report.rekeyed, expected.report.rekeyed);
  EXPECT_EQ(found.report.specks, expected.report.specks);
  EXPECT_EQ(found.report.locked_vertices, expected.report.locked_vertices);
}

void expect_same_in_pieces(const TriangleMesh& mesh, const SimplifyOptions& options,
                           std::initializer_list<std::uint64_t> pieces) {
  const Result whole = simplify(mesh, options, kWhole, 1);
  expect_same(whole, whole);
  expect_same(simplify(mesh, options, kWhole, 3), whole);
  for (const std::uint64_t piece : pieces) {
    for (const int threads : {1, 3}) {
      SCOPED_TRACE("pieces of " + std::to_string(piece) + ", " + std::to_string(threads) + " threads");
      expect_same(simplify(mesh, options, piece, threads), whole);
    }
  }
}

TriangleMesh extracted(const std::string& kind, bool closed) {
  GenerateOptions volume;
  volume.kind = kind;
  volume.dims = {15, 14, 20};
  volume.spacing = {0.7, 0.9, 1.6};
  volume.seed = 3;
  MeshOptions full;
  full.iso = suggested_iso(volume.kind, volume.type);
  full.closed = closed;
  full.error = Length::voxels(0);
  MemorySink sink;
  mesh_volume(*generate_volume(volume), sink, full);
  return std::move(sink.mesh);
}

// Flips, repeats and takes away triangles, and glues vertices together.
TriangleMesh damaged(TriangleMesh mesh, unsigned seed) {
  std::mt19937 random(seed);
  const auto any = [&](std::size_t count) { return static_cast<std::uint32_t>(random() % count); };
  for (int n = 0; n < 12; ++n) {
    std::swap(mesh.triangles[any(mesh.triangles.size())][0], mesh.triangles[any(mesh.triangles.size())][1]);
    auto& flipped = mesh.triangles[any(mesh.triangles.size())];
    std::swap(flipped[1], flipped[2]);
    mesh.triangles.insert(mesh.triangles.begin() + any(mesh.triangles.size()),
                          mesh.triangles[any(mesh.triangles.size())]);
    mesh.triangles.erase(mesh.triangles.begin() + any(mesh.triangles.size()));
    const std::uint32_t gone = any(mesh.vertices.size());
    const std::uint32_t stays = any(mesh.vertices.size());
    for (auto& t : mesh.triangles) std::replace(t.begin(), t.end(), gone, stays);
  }
  return mesh;
}

// Triangles between vertices that are near each other in the list, any number along an edge.
TriangleMesh soup(unsigned seed) {
  std::mt19937 random(seed);
  constexpr std::uint32_t kVertices = 60;
  TriangleMesh mesh;
  for (std::uint32_t v = 0; v < kVertices; ++v) {
    mesh.vertices.push_back(
        {static_cast<float>(v), static_cast<float>(random() % 8), static_cast<float>(random() % 8)});
  }
  for (std::uint32_t t = 0; t < 180; ++t) {
    const auto near = [&] { return std::min(t / 3 + static_cast<std::uint32_t>(random() % 6), kVertices - 1); };
    mesh.triangles.push_back({near(), near(), near()});
  }
  return mesh;
}

SimplifyOptions at(double error) {
  SimplifyOptions options;
  options.error = Length::voxels(error);
  return options;
}

class MeshPieces : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  TriangleMesh mesh() const { return extracted(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(MeshPieces, OfAnySizeGiveTheSameMesh) {
  for (const Quality quality : {Quality::kFast, Quality::kNormal, Quality::kFine}) {
    SimplifyOptions options = at(0.5);
    options.quality = quality;
    options.drop_specks = true;
    expect_same_in_pieces(mesh(), options, {150, 2000});
  }
}

TEST_P(MeshPieces, OfAnySizeGiveTheSameLevels) {
  SimplifyOptions options = at(0.5);
  options.levels = {{0, true}, {0.1, true}, {0.25, true}};
  expect_same_in_pieces(mesh(), options, {150, 2000});
}

TEST_P(MeshPieces, OfAnySizeGiveTheSameNumberOfTriangles) {
  SimplifyOptions options = at(std::numeric_limits<double>::infinity());
  const TriangleMesh full = mesh();
  for (const std::uint64_t part : {3U, 20U}) {
    options.triangles = full.triangles.size() / part;
    expect_same_in_pieces(full, options, {150, 2000});
  }
}

TEST_P(MeshPieces, OfAnySizeLockTheSameVertices) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    SCOPED_TRACE(seed);
    const TriangleMesh mesh = damaged(this->mesh(), seed);
    ASSERT_GT(simplify(mesh, at(0.5), kWhole, 1).report.locked_vertices, 0u);
    SimplifyOptions options = at(0.5);
    options.levels = {{0.1, true}};
    expect_same_in_pieces(mesh, options, {30, 500});
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, MeshPieces,
                         ::testing::Combine(::testing::Values("gyroid", "noise", "box", "specks"), ::testing::Bool()),
                         [](const auto& tested) {
                           return std::get<0>(tested.param) + (std::get<1>(tested.param) ? "Closed" : "Open");
                         });

TEST(MeshPiecesOfSoups, OfAnySizeLockTheSameVertices) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    expect_same_in_pieces(soup(seed), at(2), {1, 2, 7, 40});
  }
}

TEST(MeshPiecesOfSmallMeshes, OfAnySizeLockTheSameVertices) {
  for (const TriangleMesh& mesh :
       {meshes::two_tetrahedra_sharing_a_vertex(), meshes::two_tetrahedra_sharing_an_edge(), meshes::moebius_strip(),
        meshes::cube_with_a_flipped_triangle(), meshes::cube(), meshes::grid(7), TriangleMesh{}}) {
    expect_same_in_pieces(mesh, at(0.5), {1, 2, 3, 5, 8});
  }
}

}  // namespace
}  // namespace isoweave::testing::mesh_pieces_test
