// What runs to a number of triangles report, and where they stop when the number is out of reach.
// Threads: none, counts.cpp has the same runs
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "isoweave/forecast.hpp"
#include "isoweave/pipeline.hpp"
#include "meshes.hpp"
#include "sanitized.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::numbers_of_triangles_test {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// Closed components that cannot lose a triangle.
TriangleMesh tetrahedra(std::uint32_t count) {
  TriangleMesh mesh;
  for (std::uint32_t n = 0; n < count; ++n) {
    for (const Point& p : meshes::tetrahedron().vertices) {
      mesh.vertices.push_back({p[0] + 2 * static_cast<float>(n), p[1], p[2]});
    }
    for (auto t : meshes::tetrahedron().triangles) {
      for (std::uint32_t& v : t) v += 4 * n;
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

MeshReport simplify_to(const TriangleMesh& mesh, std::uint64_t triangles, double error = kNoLimit) {
  MemorySink sink;
  SimplifyOptions options;
  options.error = Length::units(error);
  options.triangles = triangles;
  return simplify_mesh(mesh, sink, options);
}

TEST(NumbersOfTriangles, WhereNothingCollapsesTheErrorIsZero) {
  const MeshReport report = simplify_to(tetrahedra(50), 20);
  EXPECT_EQ(report.collapses, 0U);
  EXPECT_EQ(report.error, 0);
  EXPECT_EQ(report.triangles, 200U);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_EQ(report.warnings[0],
            "200 triangles are left, 20 were asked for: each of 50 components keeps 4 at least, 200 in all");
}

TEST(NumbersOfTriangles, FlatsCollapseAtNoError) {
  const MeshReport report = simplify_to(meshes::grid(20), 40);
  EXPECT_LE(report.triangles, 40U);
  EXPECT_GT(report.collapses, 0U);
  EXPECT_LT(report.error, 1e-6);
}

SurfaceCase noise() {
  SurfaceCase surface;
  surface.volume.kind = "noise";
  surface.volume.dims = {24, 24, 24};
  surface.volume.spacing = {1, 1, 1.5};
  return surface;
}

MeshReport mesh_to(const SurfaceCase& surface, std::uint64_t triangles, double error, Schedule schedule,
                   std::int64_t slab, TriangleMesh* mesh = nullptr) {
  MeshOptions options;
  options.iso = suggested_iso(surface.volume.kind, surface.volume.type);
  options.error = Length::units(error);
  options.triangles = triangles;
  RunControl control;
  control.slab = slab;
  control.schedule = schedule;
  control.threads = 2;
  MemorySink sink;
  const MeshReport report = mesh_volume(*generate_volume(surface.volume), sink, options, control);
  if (mesh != nullptr) *mesh = std::move(sink.mesh);
  return report;
}

TEST(NumbersOfTriangles, TheErrorDoesNotDependOnTheSchedule) {
  const MeshReport first = mesh_to(noise(), 3000, kNoLimit, Schedule::kQueue, 100);
  EXPECT_LE(first.triangles, 3000U);
  EXPECT_GT(first.error, 0.05);
  EXPECT_LT(first.error, 12);
  for (const Schedule schedule : {Schedule::kLocal, Schedule::kRounds}) {
    for (const std::int64_t slab : {3, 100}) {
      EXPECT_EQ(mesh_to(noise(), 3000, kNoLimit, schedule, slab).error, first.error);
    }
  }
}

// A number out of reach, at the usual bound: what is left keeps its place and its volume, as far as the bound goes.
TEST(NumbersOfTriangles, ABoundOnTheErrorKeepsTheShape) {
  const SurfaceCase surface = noise();
  const double bound = most_shape_error(generate_volume(surface.volume)->info());
  EXPECT_NEAR(bound, 0.05 * std::sqrt(24.0 * 24 + 24 * 24 + 36 * 36), 1e-12);
  TriangleMesh full, mesh;
  mesh_to(surface, 0, 0, Schedule::kLocal, 0, &full);
  const MeshReport report = mesh_to(surface, 1, bound, Schedule::kLocal, 0, &mesh);
  EXPECT_GT(report.triangles, 1U);
  EXPECT_GT(report.error, 0);
  EXPECT_LE(report.error, bound);
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_NE(report.warnings.back().find("were asked for: "), std::string::npos) << report.warnings.back();
  const double volume = check_mesh(full).volume;
  EXPECT_NEAR(check_mesh(mesh).volume, volume, 0.05 * volume);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto coordinate = [&](const Point& p) { return p[axis]; };
    EXPECT_LE(std::ranges::max(mesh.vertices, {}, coordinate)[axis],
              std::ranges::max(full.vertices, {}, coordinate)[axis] + static_cast<float>(4 * bound));
  }
}

TEST(NumbersOfTriangles, TheBoundOfAMeshIsThatOfItsBox) {
  EXPECT_NEAR(most_shape_error(meshes::cube()), 0.05 * std::sqrt(3.0), 1e-12);
  EXPECT_EQ(most_shape_error(TriangleMesh{}), 0);
}

TEST(NumbersOfTriangles, ForecastsKnowWhatIsLeftAtLeast) {
  GenerateOptions volume = noise().volume;
  volume.dims = {96, 96, 96};
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  options.error = Length::units(most_shape_error(generate_volume(volume)->info()));
  options.triangles = 10;
  const Forecast forecast = forecast_mesh(*generate_volume(volume), options);
  MemorySink sink;
  const MeshReport report = mesh_volume(*generate_volume(volume), sink, options);
  EXPECT_GT(report.triangles, 1000U);
  EXPECT_GT(forecast.triangles, report.triangles / 3);
  EXPECT_LT(forecast.triangles, report.triangles * 3);
  options.triangles = 3 * forecast.triangles;
  EXPECT_EQ(forecast_mesh(*generate_volume(volume), options).triangles, options.triangles);
}

// Keeps the mesh, and the size of the largest piece.
class LargestPiece final : public MeshSink {
 public:
  void append(const MeshPiece& piece) override {
    most = std::max(most, piece.triangles.size());
    mesh.append(piece);
  }
  void finish() override { mesh.finish(); }

  MemorySink mesh;
  std::size_t most = 0;
};

// All triangles become final at once when the number is met. Handed over together, their copies would add to the peak
// of memory.
TEST(NumbersOfTriangles, ManyFinalTrianglesComeInSeveralPieces) {
  const std::uint64_t triangles = 700'000;
  const GenerateOptions volume{"smooth", {152, 152, 152}, SampleType::kUint8};
  MeshOptions options;
  options.iso = 127.5;
  options.error = Length::units(kNoLimit);
  options.triangles = triangles;
  LargestPiece sink;
  const MeshReport report = mesh_volume(*generate_volume(volume), sink, options, {.threads = 2});
  EXPECT_EQ(report.triangles, triangles);
  EXPECT_LE(sink.most, std::size_t{1} << 18);
  ASSERT_EQ(sink.mesh.mesh.triangles.size(), triangles);
  const MeshCheck check = check_mesh(sink.mesh.mesh);
  EXPECT_EQ(check.digest, report.digest);
  EXPECT_EQ(check.open_edges, 0U);
  EXPECT_EQ(check.nonmanifold_edges + check.nonmanifold_vertices, 0U);
  EXPECT_EQ(check.components, report.components);
  EXPECT_EQ(check.euler, report.euler);
}

}  // namespace
}  // namespace isoweave::testing::numbers_of_triangles_test
