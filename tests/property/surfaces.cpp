// What users are promised about a surface, on volumes with known answers and on volumes made to break things.
// Threads: Sweep.*
#include "surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace isoweave::testing::surfaces_test {
namespace {

struct Result {
  MeshReport report;
  TriangleMesh mesh;
};

Result run(SliceSource& source, const MeshOptions& options, const RunControl& control = {}) {
  MemorySink sink;
  Result result;
  result.report = mesh_volume(source, sink, options, control);
  EXPECT_TRUE(sink.finished);
  result.mesh = std::move(sink.mesh);
  return result;
}

Result run(const GenerateOptions& volume, MeshOptions options, const RunControl& control = {}) {
  options.iso = suggested_iso(volume.kind, volume.type);
  return run(*generate_volume(volume), options, control);
}

void expect_closed_manifold(const Result& result, std::int64_t euler) {
  const MeshCheck check = check_mesh(result.mesh);
  EXPECT_EQ(check.open_edges, 0u);
  EXPECT_EQ(check.nonmanifold_edges, 0u);
  EXPECT_EQ(check.nonmanifold_vertices, 0u);
  EXPECT_EQ(check.misoriented_edges, 0u);
  EXPECT_EQ(check.euler, euler);
  EXPECT_EQ(check.digest, result.report.digest);
}

TEST(Surface, SphereHasItsEulerNumberAndVolume) {
  GenerateOptions volume;
  volume.kind = "sphere";
  volume.dims = {64, 64, 64};
  const Result result = run(volume, {});
  expect_closed_manifold(result, 2);
  const double radius = 0.4 * 64;
  EXPECT_NEAR(check_mesh(result.mesh).volume / (4.0 / 3 * std::numbers::pi * radius * radius * radius), 1, 0.01);
  EXPECT_LT(result.report.triangles, result.report.triangles_extracted / 4);
}

TEST(Surface, TorusHasItsEulerNumber) {
  GenerateOptions volume;
  volume.kind = "torus";
  volume.dims = {64, 60, 40};
  const Result result = run(volume, {});
  expect_closed_manifold(result, 0);
  EXPECT_EQ(result.report.components, 1u);
  EXPECT_GT(check_mesh(result.mesh).volume, 0);
}

TEST(Surface, ABoxOfFlatsEndsBelowAHundredTriangles) {
  GenerateOptions volume;
  volume.kind = "box";
  const std::int64_t n = kSanitized ? 48 : 160;
  volume.dims = {n, n, n};
  const Result result = run(volume, {});
  expect_closed_manifold(result, 2);
  EXPECT_LT(result.report.triangles, 100u);
  EXPECT_GT(result.report.triangles_extracted, static_cast<std::uint64_t>(n * n));
}

// The largest distance from the result to the full surface is not bounded by the error (a root mean square over
// the faces merged), but it cannot be far from it either.
TEST(Surface, DistanceFollowsTheErrorAskedFor) {
  GenerateOptions volume;
  volume.kind = "smooth";
  volume.dims = {40, 40, 40};
  MeshOptions options;
  options.error = Length::voxels(0);
  const Result full = run(volume, options);
  ASSERT_EQ(full.report.triangles, full.report.triangles_extracted);
  double last = 0;
  for (const double error : {0.05, 0.2, 0.8}) {
    options.error = Length::voxels(error);
    const Result reduced = run(volume, options);
    const MeshDistance distance = compare_meshes(reduced.mesh, full.mesh, {20000, 1, 2});
    EXPECT_LT(distance.rms, error);
    EXPECT_GT(distance.rms, last);
    last = distance.rms;
  }
}

// The short way of an unsimplified surface, counted piece by piece, against a look at the whole.
TEST(Surface, WithoutErrorIsWhatCheckSees) {
  for (const char* kind : {"noise", "gyroid", "specks"}) {
    for (const bool closed : {true, false}) {
      for (const std::array<std::int64_t, 3> dims : {std::array<std::int64_t, 3>{70, 19, 23}, {9, 1, 12}, {2, 66, 2}}) {
        for (const std::int64_t slab : {1, 7, 0}) {
          GenerateOptions volume;
          volume.kind = kind;
          volume.dims = dims;
          MeshOptions options;
          options.error = Length::voxels(0);
          options.closed = closed;
          const Result result = run(volume, options, {.slab = slab});
          const MeshCheck check = check_mesh(result.mesh);
          SCOPED_TRACE(std::string(kind) + (closed ? " closed" : " open") + ", slab " + std::to_string(slab) + ", " +
                       std::to_string(dims[1]) + " rows");
          EXPECT_EQ(result.report.triangles, check.triangles);
          EXPECT_EQ(result.report.triangles, result.report.triangles_extracted);
          EXPECT_EQ(result.report.vertices, check.vertices);
          EXPECT_EQ(check.unused_vertices, 0u);
          EXPECT_EQ(result.report.open_edges, check.open_edges);
          EXPECT_EQ(result.report.components, check.components);
          EXPECT_EQ(result.report.euler, check.euler);
          EXPECT_EQ(result.report.digest, check.digest);
          EXPECT_EQ(check.nonmanifold_edges + check.nonmanifold_vertices, 0u);
        }
      }
    }
  }
}

TEST(Surface, FineIsNearerThanFastAtEqualCount) {
  GenerateOptions volume;
  volume.kind = "noise";
  const std::int64_t n = kSanitized ? 20 : 40;
  volume.dims = {n, n, n};
  MeshOptions options;
  options.error = Length::voxels(0);
  const Result full = run(volume, options);
  options.error = Length::voxels(0.8);
  options.quality = Quality::kFast;
  const Result fast = run(volume, options);
  options.quality = Quality::kFine;
  Result fine;
  for (double error = 0.4; fine.mesh.triangles.empty() || fine.mesh.triangles.size() > fast.mesh.triangles.size();
       error *= 1.03) {
    options.error = Length::voxels(error);
    fine = run(volume, options);
  }
  const DistanceOptions sampling{50000, 1, 2};
  EXPECT_LT(compare_meshes(fine.mesh, full.mesh, sampling).rms,
            0.95 * compare_meshes(fast.mesh, full.mesh, sampling).rms);
}

TEST(Surface, OpenModeEndsAtTheBorderAndKeepsIt) {
  GenerateOptions volume;
  volume.kind = "gyroid";
  volume.dims = {33, 30, 28};
  MeshOptions options;
  options.closed = false;
  const Result result = run(volume, options);
  const MeshCheck check = check_mesh(result.mesh);
  EXPECT_GT(check.open_edges, 0u);
  EXPECT_EQ(check.nonmanifold_edges, 0u);
  EXPECT_EQ(check.nonmanifold_vertices, 0u);
  float low = 1e9F, high = -1e9F;
  for (const Point& p : result.mesh.vertices) {
    low = std::min(low, p[2]);
    high = std::max(high, p[2]);
  }
  EXPECT_NEAR(low, 0, 0.3);
  EXPECT_NEAR(high, 27, 0.3);
}

TEST(Surface, InsideBelowIsTheSameSurfaceTurnedOver) {
  GenerateOptions volume;
  volume.kind = "sphere";
  volume.dims = {30, 30, 30};
  MeshOptions options;
  options.closed = false;
  const Result above = run(volume, options);
  options.inside_above = false;
  const Result below = run(volume, options);
  EXPECT_GT(check_mesh(above.mesh).volume, 0);
  EXPECT_NEAR(check_mesh(below.mesh).volume / check_mesh(above.mesh).volume, -1, 0.01);
}

// Slope and intercept only say what the stored samples mean; a negative slope must not turn the surface over.
TEST(Surface, ScaledValuesGiveTheSurfaceOfTheStoredOnes) {
  std::vector<float> samples;
  for (int k = 0; k < 12; ++k) {
    for (int j = 0; j < 12; ++j) {
      for (int i = 0; i < 12; ++i)
        samples.push_back(static_cast<float>((i - 5) * (i - 5) + (j - 6) * (j - 6) + (k - 5) * (k - 5)));
    }
  }
  MemoryVolume stored({12, 12, 12}, samples);
  MeshOptions options;
  options.iso = 14;
  options.inside_above = false;
  const Result expected = run(stored, options);
  MemoryVolume scaled({12, 12, 12}, samples);
  scaled.info().slope = -2;
  scaled.info().intercept = 100;
  options.iso = 100 - 2 * 14;
  options.inside_above = true;
  const Result result = run(scaled, options);
  EXPECT_EQ(digest_text(result.report.digest), digest_text(expected.report.digest));
  EXPECT_GT(result.report.triangles, 0u);
  EXPECT_EQ(result.report.max, 100 - 2 * expected.report.min);
}

TEST(Surface, GeometryIsAppliedAndAMirrorKeepsTheOutside) {
  GenerateOptions generated;
  generated.kind = "sphere";
  generated.dims = {24, 24, 24};
  const Result plain = run(generated, {});
  const double volume = check_mesh(plain.mesh).volume;

  const auto source = generate_volume(generated);
  std::vector<float> samples(24 * 24 * 24);
  source->read(0, 24, std::as_writable_bytes(std::span(samples)));
  MemoryVolume placed({24, 24, 24}, samples);
  placed.info().geometry.spacing = {2, 1, 0.5};
  placed.info().geometry.origin = {100, -50, 7};
  placed.info().geometry.direction = {0, -1, 0, -1, 0, 0, 0, 0, -1};
  placed.info().geometry.space = Space::kLps;
  MeshOptions options;
  options.iso = suggested_iso("sphere", SampleType::kFloat32);
  const Result mirrored = run(placed, options);
  EXPECT_NEAR(check_mesh(mirrored.mesh).volume / volume, 1, 0.02);
  expect_closed_manifold(mirrored, 2);
  double x = 0, y = 0, z = 0;
  for (const Point& p : mirrored.mesh.vertices) {
    x += p[0];
    y += p[1];
    z += p[2];
  }
  const auto n = static_cast<double>(mirrored.mesh.vertices.size());
  EXPECT_NEAR(x / n, 100 - 11.5, 0.5);
  EXPECT_NEAR(y / n, -50 - 2 * 11.5, 0.7);
  EXPECT_NEAR(z / n, 7 - 0.5 * 11.5, 0.5);

  options.space = OutputSpace::kRas;
  const Result turned = run(placed, options);
  ASSERT_EQ(turned.mesh.vertices.size(), mirrored.mesh.vertices.size());
  EXPECT_EQ(turned.mesh.vertices[0][0], -mirrored.mesh.vertices[0][0]);
  EXPECT_EQ(turned.mesh.vertices[0][2], mirrored.mesh.vertices[0][2]);
  EXPECT_GT(check_mesh(turned.mesh).volume, 0);
}

TEST(Surface, NormalsPointOutwards) {
  GenerateOptions volume;
  volume.kind = "sphere";
  volume.dims = {40, 40, 40};
  MeshOptions options;
  options.normals = Normals::kGradient;
  const Result result = run(volume, options, {.slab = 3});
  ASSERT_EQ(result.mesh.normals.size(), result.mesh.vertices.size());
  for (std::size_t v = 0; v < result.mesh.vertices.size(); ++v) {
    const Point p = result.mesh.vertices[v], n = result.mesh.normals[v];
    const Vec3 radius{p[0] - 19.5, p[1] - 19.5, p[2] - 19.5};
    const Vec3 normal{n[0], n[1], n[2]};
    EXPECT_NEAR(dot(normal, normal), 1, 1e-5);
    EXPECT_GT(dot(radius, normal) / std::sqrt(dot(radius, radius)), 0.97);
  }
}

// Normals ride along: asking for them changes no position.
TEST(Surface, NormalsDoNotChangeTheMesh) {
  GenerateOptions volume;
  volume.kind = "noise";
  volume.dims = {20, 22, 24};
  MeshOptions options;
  const Result without = run(volume, options);
  options.normals = Normals::kGradient;
  EXPECT_EQ(run(volume, options).report.digest, without.report.digest);
}

std::vector<float> constant_with(std::int64_t count, float value,
                                 std::initializer_list<std::pair<int, float>> changes) {
  std::vector<float> samples(static_cast<std::size_t>(count), value);
  for (const auto& [at, changed] : changes) samples[static_cast<std::size_t>(at)] = changed;
  return samples;
}

TEST(Adversarial, OneVoxelSpeckIsAnOctahedronOrLess) {
  MemoryVolume volume({3, 3, 3}, constant_with(27, 0, {{13, 1.0F}}));
  MeshOptions options;
  options.iso = 0.5;
  const Result result = run(volume, options);
  expect_closed_manifold(result, 2);
  EXPECT_EQ(result.report.triangles_extracted, 8u);
  EXPECT_GE(result.report.triangles, 4u);
}

TEST(Adversarial, SamplesEqualToTheIsoValueAreInsideAndMakeNoDegenerateTriangles) {
  std::vector<float> samples;
  for (int n = 0; n < 9 * 9 * 9; ++n) samples.push_back(static_cast<float>((n * 7 + n / 9) % 3));
  MemoryVolume volume({9, 9, 9}, samples);
  MeshOptions options;
  options.iso = 1;
  options.error = Length::voxels(0);
  const Result result = run(volume, options);
  const MeshCheck check = check_mesh(result.mesh);
  EXPECT_EQ(check.open_edges + check.nonmanifold_edges + check.nonmanifold_vertices + check.misoriented_edges, 0u);
  for (const auto& t : result.mesh.triangles) {
    EXPECT_NE(result.mesh.vertices[t[0]], result.mesh.vertices[t[1]]);
    EXPECT_NE(result.mesh.vertices[t[1]], result.mesh.vertices[t[2]]);
    EXPECT_NE(result.mesh.vertices[t[2]], result.mesh.vertices[t[0]]);
  }
}

TEST(Adversarial, AWholeVolumeInsideIsItsBox) {
  MemoryVolume volume({5, 6, 7}, constant_with(5 * 6 * 7, 1, {}));
  MeshOptions options;
  options.iso = 0.5;
  const Result result = run(volume, options);
  expect_closed_manifold(result, 2);
  EXPECT_NEAR(check_mesh(result.mesh).volume, 4 * 5 * 6, 3);
}

TEST(Adversarial, ThinVolumesWork) {
  for (const std::array<std::int64_t, 3> dims :
       {std::array<std::int64_t, 3>{1, 1, 1}, {1, 9, 8}, {9, 1, 8}, {9, 8, 1}, {1, 1, 9}, {64, 1, 1}, {63, 2, 2}}) {
    for (const bool closed : {true, false}) {
      GenerateOptions volume;
      volume.kind = "white";
      volume.dims = dims;
      MeshOptions options;
      options.closed = closed;
      const Result result = run(volume, options, {.slab = 2});
      const MeshCheck check = check_mesh(result.mesh);
      EXPECT_EQ(check.nonmanifold_edges + check.nonmanifold_vertices + check.misoriented_edges, 0u);
      if (closed) {
        EXPECT_EQ(check.open_edges, 0u);
      }
      const bool flat = dims[0] == 1 || dims[1] == 1 || dims[2] == 1;
      if (!closed && flat) {
        EXPECT_EQ(result.report.triangles, 0u);
      }
    }
  }
}

TEST(Adversarial, NanIsOutsideCountedAndReported) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  MemoryVolume volume({4, 4, 4}, constant_with(64, 1, {{21, nan}, {42, nan}, {63, nan}}));
  MeshOptions options;
  options.iso = 0.5;
  const Result result = run(volume, options);
  EXPECT_EQ(result.report.nan, 3u);
  EXPECT_FALSE(result.report.warnings.empty());
  const MeshCheck check = check_mesh(result.mesh);
  EXPECT_EQ(check.open_edges + check.nonmanifold_edges + check.nonmanifold_vertices, 0u);
  for (const Point& p : result.mesh.vertices)
    EXPECT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
}

TEST(Adversarial, InfinitiesGiveFinitePositions) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  MemoryVolume volume({3, 3, 3}, constant_with(27, -kInfinity, {{13, kInfinity}, {14, 2.0F}}));
  MeshOptions options;
  options.iso = 0.5;
  const Result result = run(volume, options);
  expect_closed_manifold(result, 2);
  for (const Point& p : result.mesh.vertices)
    EXPECT_TRUE(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]));
}

TEST(Adversarial, AnIsoValueOutsideTheRangeGivesAnEmptyMeshAndAWarning) {
  GenerateOptions generated;
  const auto volume = generate_volume(generated);
  MeshOptions options;
  options.iso = 1e6;
  const Result result = run(*volume, options);
  EXPECT_EQ(result.report.triangles, 0u);
  EXPECT_EQ(result.report.warnings.size(), 1u);
}

// Memory is slab and undecided zone: four times the layers need the same. Open: on a closed cap, a flat, decisions
// depend on each other over many layers, and a short volume is not long enough to see the zone level off.
TEST(Sweep, MemoryDoesNotGrowWithTheNumberOfLayers) {
  const auto peak = [](std::int64_t layers) {
    GenerateOptions volume;
    volume.kind = "smooth";
    volume.dims = {32, 32, layers};
    MeshOptions options;
    options.closed = false;
    const Result result = run(volume, options, {.slab = 16});
    std::uint64_t bytes = 0;
    for (const SlabRecord& record : result.report.sweep) bytes = std::max(bytes, record.bytes);
    return static_cast<double>(bytes);
  };
  EXPECT_NEAR(peak(kSanitized ? 768 : 1600) / peak(kSanitized ? 256 : 400), 1, 0.1);
}

TEST(Sweep, StopsWhenAsked) {
  GenerateOptions generated;
  generated.kind = "noise";
  generated.dims = {48, 48, 48};
  const auto volume = generate_volume(generated);
  std::atomic<bool> stop{false};
  RunControl control;
  control.stop = borrow(stop);
  control.progress = [&](const Progress&) { stop = true; };
  MeshOptions options;
  options.iso = suggested_iso("noise", SampleType::kFloat32);
  control.slab = 4;
  MemorySink sink;
  EXPECT_THROW(mesh_volume(*volume, sink, options, control), Interrupted);
  EXPECT_FALSE(sink.finished);
}

TEST(Sweep, RefusesOptionsOutOfRange) {
  const auto volume = generate_volume({});
  MemorySink sink;
  MeshOptions options;
  options.iso = std::nan("");
  EXPECT_THROW(mesh_volume(*volume, sink, options), std::invalid_argument);
  options.iso = 0;
  options.error = Length::units(-1);
  EXPECT_THROW(mesh_volume(*volume, sink, options), std::invalid_argument);
}

// A public run gives one digest for every slab, schedule and number of threads, with real part sizes.
TEST(Sweep, LargerVolumesGiveOneDigestToo) {
  GenerateOptions volume;
  volume.kind = "noise";
  const std::int64_t n = kSanitized ? 40 : 96;
  volume.dims = {n, n, n};
  MeshOptions options;
  RunControl control;
  control.schedule = Schedule::kQueue;
  control.slab = n + 2;
  const std::uint64_t expected = run(volume, options, control).report.digest;
  for (const std::int64_t slab : {std::int64_t{0}, std::int64_t{16}, n + 2}) {
    for (const int threads : kSanitized ? std::vector{4} : std::vector{2, 4}) {
      control.slab = slab;
      control.threads = threads;
      control.schedule = Schedule::kRounds;
      EXPECT_EQ(digest_text(run(volume, options, control).report.digest), digest_text(expected))
          << "slab " << slab << ", threads " << threads;
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::surfaces_test
