// Forecasts and caps.
// Threads: none, a forecast is a run that surfaces.cpp has
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "extract/marching_cubes.hpp"
#include "isoweave/error.hpp"
#include "isoweave/forecast.hpp"
#include "pipeline/memory_model.hpp"
#include "pipeline/slab_plan.hpp"
#include "sanitized.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::memory_test {
namespace {

using testing::MemorySink;

MeshOptions options_for(const GenerateOptions& volume, double error) {
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  options.error = Length::voxels(error);
  return options;
}

double ratio(std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); }

TEST(Forecast, CountsAreNearWhatTheRunMakes) {
  for (const char* kind : {"gyroid", "smooth", "noise"}) {
    for (const double error : testing::kSanitized ? std::vector{0.2} : std::vector{0.0, 0.2}) {
      const GenerateOptions volume{kind, {64, 64, 120}, SampleType::kUint8};
      const MeshOptions options = options_for(volume, error);
      const Forecast forecast = forecast_mesh(*generate_volume(volume), options);
      MemorySink sink;
      const MeshReport report = mesh_volume(*generate_volume(volume), sink, options);
      EXPECT_NEAR(ratio(forecast.triangles_extracted, report.triangles_extracted), 1, 0.15) << kind << error;
      EXPECT_NEAR(ratio(forecast.triangles, report.triangles), 1, 0.3) << kind << error;
      EXPECT_LE(forecast.triangles, forecast.triangles_extracted);
      EXPECT_GT(forecast.peak_bytes, 5u << 20);
    }
  }
}

// Around the middle the shells are small spheres, which keep more of their triangles than the large ones outside.
TEST(Forecast, LooksWhereTheTrianglesAre) {
  const GenerateOptions volume{"shells", {96, 96, 96}, SampleType::kUint8};
  MeshOptions options = options_for(volume, 0.04);
  MemorySink sink;
  const std::uint64_t all = count_triangles(*generate_volume(volume), options);
  const MeshReport report = mesh_volume(*generate_volume(volume), sink, options);
  EXPECT_LT(7 * report.triangles, all);
  EXPECT_NEAR(ratio(forecast_mesh(*generate_volume(volume), options).triangles, report.triangles), 1, 0.2);
  options.error = Length::units(std::numeric_limits<double>::infinity());
  for (const std::uint64_t part :
       testing::kSanitized ? std::vector<std::uint64_t>{10} : std::vector<std::uint64_t>{2, 5, 10}) {
    options.triangles = all / part;
    const double head_start = forecast_mesh(*generate_volume(volume), options).head_start;
    MemorySink headed;
    const MeshReport to_there = mesh_volume(*generate_volume(volume), headed, options_for(volume, head_start));
    EXPECT_GT(ratio(to_there.triangles, all / part), 1) << part;
    EXPECT_LT(ratio(to_there.triangles, all / part), 1.5) << part;
  }
}

TEST(Forecast, MemoryBesideARunCounts) {
  constexpr std::uint64_t kGiga = 1'000'000'000;
  Forecast forecast;
  forecast.peak_bytes = 3 * kGiga;
  forecast.least_bytes = 5 * kGiga;
  add_memory_during(forecast, kGiga);
  EXPECT_EQ(forecast.peak_bytes, 4 * kGiga);
  EXPECT_EQ(forecast.least_bytes, 6 * kGiga);
  add_memory_after(forecast, kGiga);
  EXPECT_EQ(forecast.peak_bytes, 4 * kGiga);
  EXPECT_EQ(forecast.least_bytes, 6 * kGiga);
  add_memory_after(forecast, 10 * kGiga);
  EXPECT_EQ(forecast.peak_bytes, 4 * kGiga);
  EXPECT_GT(forecast.least_bytes, 10 * kGiga);
}

// A job after the run is known exactly: a cap that holds it is let through, and one byte less is not.
TEST(Forecast, ACapThatIsTooSmallIsRefusedWithOneThatDoes) {
  Forecast forecast;
  add_memory_after(forecast, 350'000'000);
  EXPECT_NO_THROW(require_memory(forecast, 0, "a.nrrd")) << "no cap";
  EXPECT_NO_THROW(require_memory(forecast, 350'000'000, "a.nrrd"));
  EXPECT_NO_THROW(require_memory(forecast, forecast.least_bytes, "a.nrrd"));
  const auto message = [&](const std::string& purpose) -> std::string {
    try {
      require_memory(forecast, 349'000'000, "a.nrrd", purpose);
    } catch (const OverMemory& error) {
      return error.what();
    }
    return "let through";
  };
  EXPECT_EQ(message(""), "a.nrrd: expected --memory 495M or more, found 349M");
  EXPECT_EQ(message("a page"), "a.nrrd: expected --memory 495M or more, found 349M (for a page)");
}

TEST(Forecast, IsTheSameForAnyNumberOfThreads) {
  const GenerateOptions volume{"noise", {48, 48, 100}, SampleType::kUint8};
  const MeshOptions options = options_for(volume, 0.3);
  RunControl one;
  one.threads = 1;
  RunControl four;
  four.threads = 4;
  const Forecast a = forecast_mesh(*generate_volume(volume), options, one);
  const Forecast b = forecast_mesh(*generate_volume(volume), options, four);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.triangles_extracted, b.triangles_extracted);
  // The memory of the process counts as well, and sanitizers hold more and more of their own.
  if (!testing::kSanitized) {
    EXPECT_LE(a.peak_bytes, b.peak_bytes);
  }
}

TEST(Forecast, TakesVolumesOfAnyShape) {
  for (const std::array<std::int64_t, 3>& dims : std::vector<std::array<std::int64_t, 3>>{
           {1, 1, 1}, {1, 30, 30}, {30, 1, 30}, {30, 30, 1}, {30, 30, 2}, {5, 5, 500}}) {
    for (const bool closed : {true, false}) {
      const GenerateOptions volume{"white", dims, SampleType::kUint8};
      MeshOptions options = options_for(volume, 0.2);
      options.closed = closed;
      MemorySink sink;
      const Forecast forecast = forecast_mesh(*generate_volume(volume), options);
      mesh_volume(*generate_volume(volume), sink, options);
      EXPECT_LT(ratio(forecast.triangles_extracted + 1000, sink.mesh.triangles.size() + 1000), 20);
    }
  }
}

// A stream that has to be read through tells so, and is not read to its end.
class StreamedVolume final : public SliceSource {
 public:
  explicit StreamedVolume(std::int64_t slices) {
    info_.dims = {1024, 1024, slices};
    info_.type = SampleType::kFloat64;
  }
  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return false; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    std::memset(out.data(), 0, static_cast<std::size_t>(count) * info_.slice_bytes());
    end = first + count;
  }
  std::int64_t end = 0;

 private:
  VolumeInfo info_;
};

// Where a block of slices takes more than a band, and there are too few slices for a thin part.
TEST(Forecast, TakesFewLargeSlices) {
  GenerateOptions volume;
  volume.kind = "sphere";
  volume.dims = {3000, 3000, 1};
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  EXPECT_GT(forecast_mesh(*generate_volume(volume), options).peak_bytes, 0U);
}

// Most of a closed volume of few slices is the flats of its two ends.
TEST(Forecast, KnowsTheFlatsOfBothEnds) {
  for (const std::int64_t slices : {1, 2, 5, 40}) {
    const GenerateOptions volume{"gyroid", {300, 200, slices}, SampleType::kUint8};
    const MeshOptions options = options_for(volume, 0);
    const Forecast forecast = forecast_mesh(*generate_volume(volume), options);
    MemorySink sink;
    const MeshReport run = mesh_volume(*generate_volume(volume), sink, options);
    EXPECT_NEAR(ratio(forecast.triangles_extracted, run.triangles_extracted), 1, 0.15) << slices;
  }
}

TEST(Forecast, LooksAtTheFirstHalfGigabyteOfAStream) {
  StreamedVolume volume(100000);
  MeshOptions options;
  options.iso = 1;
  const Forecast forecast = forecast_mesh(volume, options);
  EXPECT_EQ(forecast.triangles, 0U);
  EXPECT_LE(volume.end, 64);
}

TEST(MemoryCap, TheMeshIsTheSameAndSlabsAreThinner) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const GenerateOptions volume{"gyroid", {96, 96, 120}, SampleType::kUint8};
  const MeshOptions options = options_for(volume, 0.3);
  MemorySink free_sink;
  const MeshReport free_run = mesh_volume(*generate_volume(volume), free_sink, options);
  RunControl control;
  control.memory = forecast_mesh(*generate_volume(volume), options).least_bytes / 4 * 3;  // a cap that is tried
  MemorySink sink;
  const MeshReport run = mesh_volume(*generate_volume(volume), sink, options, control);
  EXPECT_EQ(run.digest, free_run.digest);
  EXPECT_GT(run.sweep.size(), free_run.sweep.size());
  std::uint64_t most = 0;
  std::uint64_t most_free = 0;
  for (const SlabRecord& record : run.sweep) most = std::max(most, record.live_triangles);
  for (const SlabRecord& record : free_run.sweep) most_free = std::max(most_free, record.live_triangles);
  EXPECT_LT(most, most_free);
}

TEST(MemoryCap, TooLittleIsSaidBeforeAnythingGrows) {
  const GenerateOptions volume{"noise", {96, 96, 200}, SampleType::kUint8};
  RunControl control;
  control.memory = 30'000'000;
  MemorySink sink;
  EXPECT_THROW(mesh_volume(*generate_volume(volume), sink, options_for(volume, 0.5), control), OverMemory);
  EXPECT_FALSE(sink.finished);
}

TEST(Slabs, AreCutWhereTheyTurnOutTooFull) {
  const GenerateOptions volume{"white", {64, 64, 64}, SampleType::kUint8};
  const auto source = generate_volume(volume);
  const Executor executor(2);
  MarchingCubes whole(source->info(), {{127.5, true, true}, false}, executor);
  MarchingCubes cut(source->info(), {{127.5, true, true}, false}, executor);
  SliceWindow window(*source);
  window.advance(0, 64);
  SurfacePiece piece;
  EXPECT_EQ(whole.extract(window, whole.layers_left(), ~std::uint64_t{0}, piece).layers, 65);
  const std::size_t vertices = piece.positions.size();
  const std::size_t triangles = piece.triangles.size();
  std::size_t cut_vertices = 0;
  std::size_t cut_triangles = 0;
  std::size_t pieces = 0;
  for (; cut.layers_left() > 0; ++pieces) {
    const std::int64_t layers = cut.extract(window, cut.layers_left(), vertices / 10, piece).layers;
    ASSERT_GE(layers, 1);
    EXPECT_TRUE(layers == 1 || piece.positions.size() <= vertices / 10);
    cut_vertices += piece.positions.size();
    cut_triangles += piece.triangles.size();
  }
  EXPECT_GE(pieces, 10U);
  EXPECT_EQ(cut_vertices, vertices);
  EXPECT_EQ(cut_triangles, triangles);
}

TEST(Slabs, GrowByDoublingAtMost) {
  VolumeInfo volume;
  volume.dims = {256, 256, 256};
  EXPECT_EQ(next_slab(volume, kSimplifiedSlab, 7, 0, 0), 7) << "as asked";
  EXPECT_EQ(next_slab(volume, kSimplifiedSlab, 0, 0, 0), 8);
  EXPECT_EQ(next_slab(volume, kSimplifiedSlab, 0, 8, 10), 16);
  EXPECT_EQ(next_slab(volume, kSimplifiedSlab, 0, 64, 10), 64) << "no more than is worth holding";
  EXPECT_EQ(next_slab(volume, kSimplifiedSlab, 0, 64, 16000), 10);
  EXPECT_EQ(next_slab(volume, kSimplifiedSlab, 0, 64, 1e9), 1);
  volume.dims = {2048, 1024, 256};
  EXPECT_EQ(next_slab(volume, kSimplifiedSlab, 0, 64, 10), 4) << "slices of 2 MB";
}

TEST(Slabs, BringHalfAsManyAsAreHeld) {
  const SlabGoal few = beside_zone(kSimplifiedSlab, 1.9 * kSimplifiedSlab.triangles);
  EXPECT_EQ(few.triangles, kSimplifiedSlab.triangles);
  EXPECT_EQ(few.most_vertices, kSimplifiedSlab.most_vertices);
  const SlabGoal many = beside_zone(kSimplifiedSlab, 4 * kSimplifiedSlab.triangles);
  EXPECT_EQ(many.triangles, 2 * kSimplifiedSlab.triangles);
  EXPECT_EQ(many.most_vertices, 2 * kSimplifiedSlab.most_vertices);
  EXPECT_EQ(many.bytes, kSimplifiedSlab.bytes);
}

// A volume of more than 2^32 samples, wider than 2^16: all outside but a few samples far from the corner.
class WideVolume final : public SliceSource {
 public:
  WideVolume() {
    info_.path = "wide";
    info_.dims = {70000, 16, 5000};
    info_.type = SampleType::kUint8;
  }
  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    const std::size_t bytes = info_.slice_bytes();
    std::memset(out.data(), 0, static_cast<std::size_t>(count) * bytes);
    for (const std::int64_t k : {std::int64_t{0}, std::int64_t{4998}}) {
      if (k < first || k >= first + count) continue;
      out[static_cast<std::size_t>(k - first) * bytes + 15 * 70000 + 69999] = std::byte{200};
      out[static_cast<std::size_t>(k - first) * bytes + 7 * 70000 + 65536] = std::byte{200};
    }
  }

 private:
  VolumeInfo info_;
};

TEST(Sizes, SpecksBeyondTheReachOf32BitsLieWhereTheyAre) {
  if (testing::kSanitized) GTEST_SKIP() << "reads six gigabytes";
  WideVolume volume;
  MeshOptions options;
  options.iso = 100;
  options.error = Length::voxels(0.1);
  MemorySink sink;
  RunControl control;
  control.measure = false;
  const MeshReport report = mesh_volume(volume, sink, options, control);
  EXPECT_EQ(report.triangles_extracted, 4U * 8U);
  ASSERT_EQ(sink.mesh.vertices.size(), report.vertices);
  std::vector<int> at(4, 0);
  for (const Point& p : sink.mesh.vertices) {
    const bool low = p[2] < 2;
    const bool left = p[0] < 65540;
    EXPECT_NEAR(p[0], left ? 65536 : 69999, 0.6);
    EXPECT_NEAR(p[1], left ? 7 : 15, 0.6);
    EXPECT_NEAR(p[2], low ? 0 : 4998, 0.6);
    ++at[(low ? 1U : 0U) + (left ? 2U : 0U)];
  }
  for (const int count : at) EXPECT_GE(count, 4);
}

}  // namespace
}  // namespace isoweave::testing::memory_test
