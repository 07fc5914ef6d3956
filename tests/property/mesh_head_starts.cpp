// Runs that simplify a mesh to a number of triangles decide from the beginning up to an error that samples of the mesh
// tell. Whatever the error is, the mesh is that of a run without it.
// Threads: MeshHeadStarts.ChangeNoMesh*
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "isoweave/error.hpp"
#include "isoweave/pipeline.hpp"
#include "meshes.hpp"
#include "pipeline/forecast/mesh_head_start.hpp"
#include "pipeline/forecast/mesh_samples.hpp"
#include "pipeline/mesh_surface.hpp"
#include "sanitized.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::mesh_head_starts_test {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

TriangleMesh full_surface_of(const char* kind, std::int64_t side) {
  const GenerateOptions volume{kind, {side, side, side}};
  MeshOptions options;
  options.iso = suggested_iso(kind, volume.type);
  options.error = Length::units(0);
  MemorySink sink;
  mesh_volume(*generate_volume(volume), sink, options);
  return std::move(sink.mesh);
}

SimplifyOptions to_number(std::uint64_t triangles, double error = kNoLimit) {
  SimplifyOptions options;
  options.error = Length::units(error);
  options.triangles = triangles;
  return options;
}

MeshReport run(const TriangleMesh& mesh, const SimplifyOptions& options, const RunControl& control) {
  MemorySink sink;
  const MeshReport report = simplify_mesh(mesh, sink, options, control);
  EXPECT_TRUE(sink.finished);
  EXPECT_EQ(sink.mesh.triangles.size(), report.triangles);
  return report;
}

SurfaceMeasure measure_of(const TriangleMesh& mesh) {
  const double a0 = 2 * mean_triangle_area(mesh, Executor(1));
  const double side = a0 > 0 ? std::sqrt(a0) : 1;
  return {side * side, side, VertexNumbering::of_file(), {side, side, side}, {}, ""};
}

double head_start_of(const TriangleMesh& mesh, const SimplifyOptions& options) {
  return mesh_head_start(mesh, options, measure_of(mesh), Executor(2), {});
}

TriangleMesh shuffled(TriangleMesh mesh) {
  std::mt19937 random(7);
  for (std::size_t n = mesh.triangles.size(); n > 1; --n)
    std::swap(mesh.triangles[n - 1], mesh.triangles[random() % n]);
  return mesh;
}

TEST(MeshHeadStarts, ChangeNoMesh) {
  const TriangleMesh mesh = full_surface_of("noise", kSanitized ? 16 : 28);
  const std::uint64_t triangles = mesh.triangles.size() / 5;
  const MeshReport plain =
      run(mesh, to_number(triangles), {.threads = 1, .schedule = Schedule::kQueue, .head_start = 0});
  ASSERT_LE(plain.triangles, triangles);
  ASSERT_GT(plain.triangles + 4, triangles);
  for (const Schedule schedule : {Schedule::kLocal, Schedule::kRounds, Schedule::kQueue}) {
    for (const std::uint64_t piece : {std::uint64_t{0}, std::uint64_t{1000}}) {
      for (const double factor : {0.5, 1.5, 4.0}) {
        RunControl control{.threads = piece == 0 ? 1 : 3, .schedule = schedule};
        control.piece = piece;
        control.head_start = factor * plain.error;
        const MeshReport found = run(mesh, to_number(triangles), control);
        expect_same_surface(found, plain);
        EXPECT_EQ(found.collapses, plain.collapses);
        EXPECT_EQ(found.triangles_extracted, plain.triangles_extracted);
      }
    }
  }
}

// Clearly more triangles than the number are left, and not far more: else there is little gain.
TEST(MeshHeadStarts, AreFoundInSamples) {
  for (const char* kind : {"gyroid", "smooth", "sphere"}) {
    if (kSanitized && kind != std::string("gyroid")) continue;
    const std::int64_t side = kSanitized ? 56 : 80;
    const TriangleMesh mesh = full_surface_of(kind, kind == std::string("sphere") ? 2 * side : side);
    for (const std::uint64_t part : {2U, 5U, 10U}) {
      if (kSanitized && part != 5) continue;
      const std::uint64_t wanted = mesh.triangles.size() / part;
      const double error = head_start_of(mesh, to_number(wanted));
      ASSERT_GT(error, 0) << kind << part;
      EXPECT_NEAR(head_start_of(shuffled(mesh), to_number(wanted)), error, 0.02 * error) << kind << part;
      SimplifyOptions to_error;
      to_error.error = Length::units(error);
      const std::uint64_t left = run(mesh, to_error, {}).triangles;
      EXPECT_GT(left, wanted) << kind << part;
      EXPECT_LT(left, 2 * wanted) << kind << part;
    }
  }
}

// Where many sheets run through a ball, each has few triangles, and its border is near: few left of it tell nothing.
TEST(MeshHeadStarts, SheetsNearEachOtherDoNotMislead) {
  const TriangleMesh mesh = full_surface_of("shells", kSanitized ? 40 : 80);
  for (const std::uint64_t part : {10U, 20U, 50U}) {
    if (kSanitized && part != 20) continue;
    const std::uint64_t wanted = mesh.triangles.size() / part;
    SimplifyOptions to_error;
    to_error.error = Length::units(head_start_of(mesh, to_number(wanted)));
    EXPECT_GT(to_error.error.value, 0) << part;
    EXPECT_GT(run(mesh, to_error, {}).triangles, wanted) << part;
  }
}

TEST(MeshHeadStarts, SamplesCountTheEdgesWhereTheyAreCut) {
  const TriangleMesh mesh = full_surface_of("gyroid", 56);
  ASSERT_EQ(check_mesh(mesh).open_edges, 0U);
  const MeshSamples samples(mesh, Executor(2));
  ASSERT_GT(samples.count(), 1U);
  for (std::size_t n = 0; n < samples.count(); ++n) {
    const MeshSample sample = samples.cut(n);
    const auto open = static_cast<double>(check_mesh(sample.mesh).open_edges);
    EXPECT_GT(open, 0) << n;
    EXPECT_NEAR(static_cast<double>(sample.cut_edges), open, 0.1 * open) << n;
  }
}

// An error that is asked for bounds the head start.
TEST(MeshHeadStarts, AreNoHigherThanTheError) {
  const TriangleMesh mesh = full_surface_of("gyroid", 56);
  const double free = head_start_of(mesh, to_number(5000));
  EXPECT_NEAR(head_start_of(mesh, to_number(5000, free / 4)), free / 4, free / 100);
  EXPECT_EQ(head_start_of(mesh, to_number(5000, 0)), 0);
}

TEST(MeshHeadStarts, AreNotLookedForInVain) {
  const TriangleMesh mesh = full_surface_of("gyroid", 56);
  EXPECT_EQ(head_start_of(mesh, to_number(mesh.triangles.size())), 0);
  EXPECT_EQ(head_start_of(full_surface_of("gyroid", 20), to_number(100)), 0);
}

// Meshes of 51,200 triangles, some of whose vertices lie anywhere or nowhere.
std::vector<TriangleMesh> odd_meshes() {
  std::vector<TriangleMesh> meshes(5, meshes::grid(160));
  for (std::size_t v = 0; v < meshes[0].vertices.size(); v += 50) meshes[0].vertices[v][v % 3] = kNoNumber;
  for (std::size_t v = 0; v < meshes[1].vertices.size(); v += 50) {
    meshes[1].vertices[v][v % 3] = v % 100 == 0 ? std::numeric_limits<float>::infinity() : -3e38F;
  }
  for (Point& p : meshes[2].vertices) p = {1, 2, 3};
  for (Point& p : meshes[3].vertices) p = {p[0] * 1e30F, p[1] * 1e30F, 0};
  for (Point& p : meshes[4].vertices) p = {kNoNumber, kNoNumber, kNoNumber};
  meshes.push_back(meshes::grid(160));  // most vertices are in no triangle, and far away
  meshes.back().vertices.resize(1'000'000, {1e6F, 1e6F, 1e6F});
  return meshes;
}

TEST(MeshHeadStarts, OddMeshesAreSimplifiedAsWithoutThem) {
  for (const TriangleMesh& mesh : odd_meshes()) {
    const double error = head_start_of(mesh, to_number(20'000));
    EXPECT_TRUE(error >= 0 && std::isfinite(error)) << error;
    if (kSanitized) continue;
    const MeshReport plain = run(mesh, to_number(20'000), {.threads = 2, .head_start = 0});
    expect_same_surface(run(mesh, to_number(20'000), {.threads = 2}), plain);
  }
}

// All triangles share a vertex: no part of the mesh is a sample of it.
TEST(MeshHeadStarts, AFanHasTheSameMesh) {
  TriangleMesh fan;
  fan.vertices.push_back({0, 0, 5});
  constexpr std::uint32_t kRim = 60'000;
  for (std::uint32_t n = 0; n < kRim; ++n) {
    const double angle = 2 * 3.141592653589793 * n / kRim;
    fan.vertices.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
    fan.triangles.push_back({0, n + 1, (n + 1) % kRim + 1});
  }
  const MeshReport plain = run(fan, to_number(6000), {.threads = 2, .head_start = 0});
  expect_same_surface(run(fan, to_number(6000), {.threads = 2}), plain);
}

TEST(MeshHeadStarts, AreInterrupted) {
  RunControl control{.threads = 2};
  control.stop = std::make_shared<std::atomic<bool>>(true);
  const TriangleMesh mesh = full_surface_of("gyroid", 56);
  EXPECT_THROW(mesh_head_start(mesh, to_number(5000), measure_of(mesh), Executor(2), control), Interrupted);
  MemorySink sink;
  EXPECT_THROW(simplify_mesh(mesh, sink, to_number(5000), control), Interrupted);
  EXPECT_FALSE(sink.finished);
}

TEST(MeshHeadStarts, AreLengths) {
  for (const double length : {-1.0, std::nan(""), kNoLimit}) {
    MemorySink sink;
    EXPECT_THROW(simplify_mesh(meshes::grid(8), sink, to_number(10), {.head_start = length}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace isoweave::testing::mesh_head_starts_test
