// Masks made smooth: sides, reads, and what becomes of the surface.
// Threads: SmoothedMask.*
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "isoweave/error.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::volume_smoothed_mask_test {
namespace {

std::unique_ptr<SliceSource> generated(const std::string& kind, std::array<std::int64_t, 3> dims) {
  GenerateOptions options;
  options.kind = kind;
  options.dims = dims;
  return generate_volume(options);
}

SmoothOptions smoothing(const std::string& kind, int passes) {
  return {suggested_iso(kind, SampleType::kFloat32), true, passes};
}

std::vector<float> read_all(SliceSource& volume, std::int64_t at_a_time) {
  const VolumeInfo& info = volume.info();
  std::vector<float> samples(static_cast<std::size_t>(info.slice_samples() * info.dims[2]));
  const auto bytes = std::as_writable_bytes(std::span(samples));
  for (std::int64_t k = 0; k < info.dims[2]; k += at_a_time) {
    const std::int64_t count = std::min(at_a_time, info.dims[2] - k);
    volume.read(k, count, bytes.subspan(static_cast<std::size_t>(k) * info.slice_bytes()));
  }
  return samples;
}

// The definition, on the whole field at once.
std::vector<float> blurred(const std::vector<float>& field, const std::array<std::int64_t, 3>& dims) {
  const auto at = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const auto clamp = [&](std::int64_t n, std::size_t axis) { return std::clamp<std::int64_t>(n, 0, dims[axis] - 1); };
    return field[static_cast<std::size_t>((clamp(k, 2) * dims[1] + clamp(j, 1)) * dims[0] + clamp(i, 0))];
  };
  std::vector<float> means;
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) {
        const auto z = [&](std::int64_t x, std::int64_t y) {
          return (at(x, y, k - 1) + at(x, y, k + 1)) + 2 * at(x, y, k);
        };
        const auto y = [&](std::int64_t x) { return (z(x, j - 1) + z(x, j + 1)) + 2 * z(x, j); };
        means.push_back(((y(i - 1) + y(i + 1)) + 2 * y(i)) / 64);
      }
    }
  }
  return means;
}

std::vector<float> smoothed_at_once(SliceSource& volume, const SmoothOptions& options) {
  std::vector<float> field;
  for (const float value : read_all(volume, volume.info().dims[2]))
    field.push_back(value >= options.iso ? 1.0F : -1.0F);
  for (int pass = 0; pass < options.passes; ++pass) {
    const std::vector<float> once = blurred(field, volume.info().dims);
    const std::vector<float> twice = blurred(once, volume.info().dims);
    for (std::size_t n = 0; n < field.size(); ++n) {
      const float value = 2 * once[n] - twice[n];
      field[n] = field[n] > 0 ? std::max(value, 1.0F / 256) : std::min(value, -1.0F / 256);
    }
  }
  return field;
}

TEST(SmoothedMask, IsWhatTheDefinitionSaysHoweverItIsRead) {
  for (const char* kind : {"noise", "specks", "white", "sphere"}) {
    for (const std::array<std::int64_t, 3> dims :
         {std::array<std::int64_t, 3>{13, 9, 17}, {1, 8, 5}, {7, 1, 1}, {2, 2, 2}}) {
      for (const int passes : {1, 3}) {
        const SmoothOptions options = smoothing(kind, passes);
        const std::vector<float> expected = smoothed_at_once(*generated(kind, dims), options);
        for (const std::int64_t at_a_time : {1, 4, 100}) {
          for (const int threads : {1, 3}) {
            SCOPED_TRACE(::testing::Message() << kind << ", " << dims[2] << " slices, " << passes << " passes, "
                                              << at_a_time << " at a time, " << threads << " threads");
            const auto smoothed = smooth_mask(generated(kind, dims), options, threads);
            EXPECT_EQ(smoothed->info().type, SampleType::kFloat32);
            EXPECT_EQ(read_all(*smoothed, at_a_time), expected);
          }
        }
      }
    }
  }
}

TEST(SmoothedMask, SlicesThatAreSkippedChangeNothing) {
  constexpr std::array<std::int64_t, 3> kDims{9, 8, 40};
  const SmoothOptions options = smoothing("noise", 2);
  const std::vector<float> all = read_all(*smooth_mask(generated("noise", kDims), options), 1);
  std::mt19937 random(5);
  for (int run = 0; run < 20; ++run) {
    const auto smoothed = smooth_mask(generated("noise", kDims), options);
    for (std::int64_t k = static_cast<std::int64_t>(random() % 20); k < kDims[2];
         k += 1 + static_cast<std::int64_t>(random() % 18)) {
      std::vector<float> slice(9 * 8);
      smoothed->read(k, 1, std::as_writable_bytes(std::span(slice)));
      EXPECT_TRUE(std::equal(slice.begin(), slice.end(), all.begin() + k * 72)) << "slice " << k;
    }
  }
}

TEST(SmoothedMask, ReadsForwardAndWithinTheVolumeOnly) {
  const auto smoothed = smooth_mask(generated("sphere", {8, 8, 8}));
  std::vector<std::byte> bytes(9 * smoothed->info().slice_bytes());
  EXPECT_THROW(smoothed->read(0, 9, bytes), std::invalid_argument);
  smoothed->read(3, 2, bytes);
  EXPECT_THROW(smoothed->read(4, 1, bytes), std::invalid_argument);
  smoothed->read(5, 3, bytes);
}

TEST(SmoothedMask, OptionsAreChecked) {
  for (const int passes : {-1, 0, kMostSmoothing + 1}) {
    EXPECT_THROW(smooth_mask(generated("sphere", {8, 8, 8}), {0.5, true, passes}), std::invalid_argument);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(smooth_mask(generated("sphere", {8, 8, 8}), {nan, true, 1}), std::invalid_argument);
}

TEST(SmoothedMask, SidesFollowTheRuleTheScalingAndNaN) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> samples{0, 1, 2, nan, 3, 1, nan, 2};
  const auto sides = [&](double slope, double intercept, double iso, bool above) {
    auto volume = std::make_unique<MemoryVolume>(std::array<std::int64_t, 3>{2, 2, 2}, samples);
    volume->info().slope = slope;
    volume->info().intercept = intercept;
    std::string text;
    for (const float value : read_all(*smooth_mask(std::move(volume), {iso, above, 2}), 1))
      text += value > 0 ? '+' : '-';
    return text;
  };
  EXPECT_EQ(sides(1, 0, 2, true), "--+-+--+");
  EXPECT_EQ(sides(1, 0, 1, false), "++---+--");
  EXPECT_EQ(sides(-2, 10, 6, true), "+++--+-+");
  EXPECT_EQ(sides(-2, 10, 6, false), "--+-+--+");
}

struct Mesh {
  TriangleMesh mesh;
  MeshReport report;
};

Mesh full_mesh(SliceSource& volume, double iso, int smooth, bool closed) {
  MeshOptions options;
  options.iso = iso;
  options.error = Length::voxels(0);
  options.smooth = smooth;
  options.closed = closed;
  MemorySink sink;
  Mesh mesh;
  mesh.report = mesh_volume(volume, sink, options);
  mesh.mesh = std::move(sink.mesh);
  return mesh;
}

// A mask of 0 and 1, by samples of another volume.
std::unique_ptr<MemoryVolume> mask_of(const std::string& kind, const std::array<std::int64_t, 3>& dims) {
  std::vector<float> samples = read_all(*generated(kind, dims), dims[2]);
  const double iso = suggested_iso(kind, SampleType::kFloat32);
  for (float& sample : samples) sample = sample >= iso ? 1.0F : 0.0F;
  return std::make_unique<MemoryVolume>(dims, std::move(samples));
}

// Vertices of a full surface come in lattice order: the n-th of one surface lies on the edge of the n-th of the other.
TEST(SmoothSurface, KeepsTopologyAndEveryVertexOnItsEdge) {
  constexpr std::array<std::int64_t, 3> kDims{20, 18, 22};
  for (const char* kind : {"noise", "white", "shells", "specks", "gyroid"}) {
    for (const bool closed : {true, false}) {
      for (const int passes : {1, 4, 20}) {
        SCOPED_TRACE(::testing::Message() << kind << ", closed " << closed << ", passes " << passes);
        const Mesh stairs = full_mesh(*mask_of(kind, kDims), 0.5, 0, closed);
        const Mesh smooth = full_mesh(*mask_of(kind, kDims), 0.5, passes, closed);
        EXPECT_EQ(smooth.report.euler, stairs.report.euler);
        EXPECT_EQ(smooth.report.components, stairs.report.components);
        EXPECT_EQ(smooth.report.open_edges, stairs.report.open_edges);
        ASSERT_EQ(smooth.mesh.triangles.size(), stairs.mesh.triangles.size());  // diagonals go by places
        ASSERT_EQ(smooth.mesh.vertices.size(), stairs.mesh.vertices.size());
        bool moved = false;
        for (std::size_t v = 0; v < smooth.mesh.vertices.size(); ++v) {
          const Point& a = smooth.mesh.vertices[v];
          const Point& b = stairs.mesh.vertices[v];
          int axes = 0;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            if (a[axis] == b[axis]) continue;
            ++axes;
            EXPECT_EQ(b[axis], std::floor(b[axis]) + 0.5F);  // the middle of an edge, and not a cap of the border
            EXPECT_LE(std::abs(a[axis] - b[axis]), 0.5F - 1.0F / 256);
          }
          EXPECT_LE(axes, 1);
          moved = moved || axes > 0;
        }
        EXPECT_TRUE(moved);
      }
    }
  }
}

// Distances of vertices, and angles of triangles, weighted by area, to a sphere.
struct Roughness {
  double distance = 0;
  double degrees = 0;
};

Roughness roughness(const TriangleMesh& mesh, const Vec3& centre, double radius) {
  Roughness found;
  double area = 0;
  const auto place = [&](std::uint32_t v) {
    const Point& p = mesh.vertices[v];
    return Vec3{p[0] - centre.x, p[1] - centre.y, p[2] - centre.z};
  };
  for (const auto& t : mesh.triangles) {
    const Vec3 a = place(t[0]);
    const Vec3 normal = cross(place(t[1]) - a, place(t[2]) - a);
    const double length = std::sqrt(dot(normal, normal));
    const double out = std::sqrt(dot(a, a));
    if (!(length > 0)) continue;
    const double angle = std::acos(std::clamp(dot(normal, a) / (length * out), -1.0, 1.0)) * 180 / std::numbers::pi;
    found.degrees += length * angle * angle;
    found.distance += length * (out - radius) * (out - radius);
    area += length;
  }
  return {std::sqrt(found.distance / area), std::sqrt(found.degrees / area)};
}

TEST(SmoothSurface, OfASphereIsNearerAndRounder) {
  constexpr std::array<std::int64_t, 3> kDims{41, 41, 41};
  const Vec3 centre{20, 20, 20};
  const double radius = 0.4 * 41;
  const Roughness stairs = roughness(full_mesh(*mask_of("sphere", kDims), 0.5, 0, true).mesh, centre, radius);
  const Roughness smooth =
      roughness(full_mesh(*mask_of("sphere", kDims), 0.5, kUsualSmoothing, true).mesh, centre, radius);
  EXPECT_LT(smooth.distance, stairs.distance / 2);
  EXPECT_LT(smooth.degrees, stairs.degrees / 4);
}

// The report is of the volume, not of what was made of it.
TEST(SmoothSurface, ReportsTheSamples) {
  auto volume = mask_of("sphere", {16, 16, 16});
  volume->info().slope = 10;
  volume->info().intercept = -3;
  Mesh mesh = full_mesh(*volume, 2, 3, true);
  EXPECT_EQ(mesh.report.min, -3);
  EXPECT_EQ(mesh.report.max, 7);
  EXPECT_GT(mesh.report.triangles, 0U);
  std::vector<float> samples(64, 2);
  samples[21] = std::numeric_limits<float>::quiet_NaN();
  MemoryVolume holed({4, 4, 4}, samples);
  mesh = full_mesh(holed, 1, 2, true);
  EXPECT_EQ(mesh.report.nan, 1U);
  EXPECT_EQ(mesh.report.components, 2U);
  MemoryVolume flat({4, 4, 4}, std::vector<float>(64, 2));
  mesh = full_mesh(flat, 5, 2, true);
  ASSERT_EQ(mesh.report.warnings.size(), 1U);
  EXPECT_NE(mesh.report.warnings[0].find("the samples go from 2 to 2, iso is 5"), std::string::npos);
}

TEST(SmoothSurface, IsTheSameForAnySlabThreadsAndSchedule) {
  GenerateOptions volume;
  volume.kind = "noise";
  volume.dims = {14, 12, 16};
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  options.smooth = 3;
  options.normals = Normals::kGradient;
  std::string expected;
  for (const std::int64_t slab : {1000, 1, 4, 0}) {
    for (const Schedule schedule : {Schedule::kQueue, Schedule::kLocal, Schedule::kRounds}) {
      for (const int threads : {1, 4}) {
        RunControl control;
        control.slab = slab;
        control.schedule = schedule;
        control.threads = threads;
        MemorySink sink;
        const MeshReport report = mesh_volume(*generate_volume(volume), sink, options, control);
        if (expected.empty()) expected = digest_text(report.digest);
        EXPECT_EQ(digest_text(report.digest), expected) << "slab " << slab << ", threads " << threads;
      }
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::volume_smoothed_mask_test
