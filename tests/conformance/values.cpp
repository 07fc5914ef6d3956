// Values of another volume: what the vertices get, and that it does not depend on how the run is carried out.
// Threads: none, schedules.cpp has the same loops
#include <gtest/gtest.h>

#include "isoweave/error.hpp"
#include "oracle.hpp"

namespace isoweave::testing::values_test {
namespace {

constexpr std::array<std::int64_t, 3> kDims{14, 16, 19};

// A volume of as many samples as the surface's, filled by value(i, j, k).
template <class Value>
MemoryVolume make_values(const Value& value) {
  std::vector<float> samples;
  for (std::int64_t k = 0; k < kDims[2]; ++k) {
    for (std::int64_t j = 0; j < kDims[1]; ++j) {
      for (std::int64_t i = 0; i < kDims[0]; ++i) samples.push_back(static_cast<float>(value(i, j, k)));
    }
  }
  return {kDims, samples};
}

double ramp(std::int64_t i, std::int64_t j, std::int64_t k) {
  return static_cast<double>(i) + 100 * static_cast<double>(j) - 10 * static_cast<double>(k);
}

SurfaceCase make_case(const std::string& kind) {
  SurfaceCase surface;
  surface.volume.kind = kind;
  surface.volume.dims = kDims;
  surface.volume.spacing = {0.5, 2, 1.25};
  surface.volume.seed = 4;
  return surface;
}

MeshOptions mesh_options(const SurfaceCase& surface, SliceSource& values) {
  MeshOptions options;
  options.iso = surface.rule().iso;
  options.closed = false;
  options.error = Length::voxels(0.7);
  options.space = OutputSpace::kIndex;
  options.values = borrow(values);
  return options;
}

TriangleMesh mesh_of(const SurfaceCase& surface, const MeshOptions& options, const RunControl& control = {}) {
  MemorySink sink;
  mesh_volume(*generate_volume(surface.volume), sink, options, control);
  EXPECT_EQ(sink.mesh.values.size(), sink.mesh.vertices.size());
  return std::move(sink.mesh);
}

double ramp_at(const Point& p) { return p[0] / 0.5 + 100 * p[1] / 2 - 10 * p[2] / 1.25; }

TEST(Values, AreThoseBetweenTheSamplesOfTheEdge) {
  for (const double error : {0.0, 0.0001}) {
    MemoryVolume values = make_values(ramp);
    MeshOptions options = mesh_options(make_case("noise"), values);
    options.error = Length::voxels(error);
    const TriangleMesh mesh = mesh_of(make_case("noise"), options);
    ASSERT_GT(mesh.vertices.size(), 1000U);
    if (error > 0) continue;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      EXPECT_NEAR(mesh.values[v], ramp_at(mesh.vertices[v]), 1e-3);
    }
  }
}

// A collapse keeps to the values of its two ends, and is near what the place says where the field is linear.
TEST(Values, StayNearTheFieldWhenEdgesCollapse) {
  MemoryVolume values = make_values(ramp);
  MeshOptions options = mesh_options(make_case("sphere"), values);
  const TriangleMesh mesh = mesh_of(make_case("sphere"), options);
  double low = 1e9, high = -1e9, off = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    low = std::min(low, double{mesh.values[v]});
    high = std::max(high, double{mesh.values[v]});
    off += std::abs(mesh.values[v] - ramp_at(mesh.vertices[v]));
  }
  EXPECT_GT(high - low, 500);
  EXPECT_LT(off / static_cast<double>(mesh.vertices.size()), 0.03 * (high - low));
}

TEST(Values, AreTheSameForAllSlabsThreadsAndSchedules) {
  for (const char* kind : {"noise", "gyroid", "box", "white"}) {
    for (const bool closed : {true, false}) {
      if (kSanitized && closed == (kind[0] == 'b')) continue;
      MemoryVolume values = make_values(
          [](auto i, auto j, auto k) { return mix_bits(static_cast<std::uint64_t>(i + 31 * j + 997 * k)) % 1000; });
      MeshOptions options = mesh_options(make_case(kind), values);
      options.closed = closed;
      RunControl control;
      control.slab = 1000;
      control.schedule = Schedule::kQueue;
      control.threads = 1;
      const std::uint64_t expected = riders_digest(mesh_of(make_case(kind), options, control));
      options.values = nullptr;
      MemorySink without;
      mesh_volume(*generate_volume(make_case(kind).volume), without, options, control);
      EXPECT_TRUE(without.mesh.values.empty());
      for (const Schedule schedule : {Schedule::kLocal, Schedule::kRounds, Schedule::kQueue}) {
        for (const std::int64_t slab : {1, 3, 7}) {
          MemoryVolume again = values;
          options.values = borrow(again);
          control.slab = slab;
          control.schedule = schedule;
          control.threads = static_cast<int>(slab);
          const TriangleMesh mesh = mesh_of(make_case(kind), options, control);
          EXPECT_EQ(riders_digest(mesh), expected) << kind << ", slab " << slab;
          EXPECT_EQ(check_mesh(mesh).digest, check_mesh(without.mesh).digest) << "they change no place";
        }
      }
    }
  }
}

// Where one sample of an edge is none, or lies past the border, the other one counts.
TEST(Values, SamplesThatAreNoNumbersHaveNoSay) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto unknown = [&](auto is_nan, double error) {
    MemoryVolume values = make_values([&](auto i, auto, auto) { return is_nan(i) ? nan : 7.0F; });
    MeshOptions options = mesh_options(make_case("box"), values);
    options.closed = true;
    options.error = Length::voxels(error);
    const TriangleMesh mesh = mesh_of(make_case("box"), options);
    std::size_t count = 0;
    for (const float value : mesh.values) {
      EXPECT_TRUE(std::isnan(value) || value == 7) << value;
      count += std::isnan(value) ? 1U : 0U;
    }
    return static_cast<double>(count) / static_cast<double>(mesh.values.size());
  };
  EXPECT_EQ(unknown([](auto) { return false; }, 0.5), 0);
  EXPECT_EQ(unknown([](auto) { return true; }, 0.5), 1);
  const double some = unknown([](auto i) { return i % 2 == 0; }, 0);
  EXPECT_GT(some, 0);
  EXPECT_LT(some, 0.6);
}

TEST(Values, RefuseAVolumeOfAnotherSizeAndWarnOfAnotherPlace) {
  MemoryVolume values({3, 3, 3}, std::vector<float>(27));
  MeshOptions options = mesh_options(make_case("box"), values);
  MemorySink sink;
  try {
    mesh_volume(*generate_volume(make_case("box").volume), sink, options);
    FAIL() << "expected to be refused";
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("expected 14 x 16 x 19 samples"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("found 3 x 3 x 3"), std::string::npos) << error.what();
  }
  MemoryVolume elsewhere = make_values(ramp);
  options.values = borrow(elsewhere);
  MemorySink other;
  const MeshReport report = mesh_volume(*generate_volume(make_case("box").volume), other, options);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("lies elsewhere"), std::string::npos) << report.warnings[0];
}

TEST(Values, AreTheNumbersThatSlopeAndInterceptMake) {
  MemoryVolume values = make_values([](auto, auto, auto) { return 3; });
  values.info().slope = -2;
  values.info().intercept = 5;
  const TriangleMesh mesh = mesh_of(make_case("sphere"), mesh_options(make_case("sphere"), values));
  for (const float value : mesh.values) EXPECT_EQ(value, -1);
}

}  // namespace
}  // namespace isoweave::testing::values_test
