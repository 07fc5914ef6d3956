// The meshes of several iso-values out of one sweep are those of a run for each value.
// Threads: *GiveTheMeshesOfTheirOwnRuns/DualOpen*:*GiveTheMeshesOfTheirOwnRuns/SmoothClosed*
#include <gtest/gtest.h>

#include <limits>

#include "label_maps.hpp"
#include "surfaces.hpp"
#include "volume/row_source.hpp"

namespace isoweave::testing::iso_values_test {
namespace {

constexpr std::array<std::int64_t, 3> kDims{19, 16, 21};
constexpr std::array<double, 4> kValues{127, 70.5, 180, 300};  // in no order; the last one is met nowhere

// Noise from 0 to 255 that is read forward, each slice once.
std::unique_ptr<LabelMap> noise(const std::array<std::int64_t, 3>& dims = kDims) {
  GenerateOptions options;
  options.kind = "noise";
  options.dims = dims;
  options.type = SampleType::kUint16;
  Labels samples(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  generate_volume(options)->read(0, dims[2], std::as_writable_bytes(std::span(samples)));
  auto volume = std::make_unique<LabelMap>(dims, std::move(samples));
  volume->info().geometry.spacing = {0.7, 0.9, 1.6};
  volume->info().geometry.origin = {-3, 40, 1000};
  volume->info().geometry.direction = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  return volume;
}

struct IsoRun {
  std::vector<TriangleMesh> meshes;
  std::vector<MeshReport> reports;
  MeshReport total;
};

IsoRun run_together(const MeshOptions& options, const RunControl& control,
                    const std::array<std::int64_t, 3>& dims = kDims) {
  std::vector<MemorySink> sinks(kValues.size());
  std::vector<IsoSink> surfaces;
  for (std::size_t n = 0; n < kValues.size(); ++n) surfaces.push_back({kValues[n], &sinks[n]});
  const auto volume = noise(dims);
  IsoValuesReport report = mesh_iso_values(*volume, surfaces, options, control);
  EXPECT_EQ(volume->slices_read, dims[2]);
  IsoRun run{{}, std::move(report.meshes), std::move(report.total)};
  for (MemorySink& sink : sinks) {
    EXPECT_TRUE(sink.finished);
    run.meshes.push_back(std::move(sink.mesh));
  }
  return run;
}

IsoRun run_each(MeshOptions options, const std::array<std::int64_t, 3>& dims = kDims) {
  IsoRun run;
  for (const double value : kValues) {
    options.iso = value;
    MemorySink sink;
    run.reports.push_back(mesh_volume(*noise(dims), sink, options));
    run.meshes.push_back(std::move(sink.mesh));
  }
  return run;
}

void expect_same(const IsoRun& found, const IsoRun& expected) {
  std::uint64_t triangles = 0;
  for (std::size_t n = 0; n < kValues.size(); ++n) {
    SCOPED_TRACE(::testing::Message() << "iso " << kValues[n]);
    const MeshReport& a = found.reports[n];
    const MeshReport& b = expected.reports[n];
    triangles += b.triangles;
    expect_same_surface(a, b);
    EXPECT_EQ(a.min, b.min);
    EXPECT_EQ(a.max, b.max);
    EXPECT_EQ(a.triangles_extracted, b.triangles_extracted);
    EXPECT_EQ(a.vertices_extracted, b.vertices_extracted);
    EXPECT_EQ(a.cells_crossed, b.cells_crossed);
    EXPECT_EQ(a.collapses, b.collapses);
    EXPECT_EQ(a.target, b.target);
    EXPECT_EQ(a.warnings, b.warnings);
    EXPECT_EQ(check_mesh(found.meshes[n]).digest, b.digest);
    EXPECT_EQ(riders_digest(found.meshes[n]), riders_digest(expected.meshes[n]));
  }
  EXPECT_EQ(found.total.triangles, triangles);
  EXPECT_EQ(found.total.sweep.back().final_triangles, triangles);
}

struct IsoCase {
  const char* name;
  ExtractorKind extractor;
  bool closed;
  int smooth = 0;
  double error = 0.2;
};

class IsoSweeps : public ::testing::TestWithParam<IsoCase> {};

TEST_P(IsoSweeps, GiveTheMeshesOfTheirOwnRuns) {
  MeshOptions options;
  options.extractor = GetParam().extractor;
  options.closed = GetParam().closed;
  options.smooth = GetParam().smooth;
  options.error = Length::voxels(GetParam().error);
  options.inside_above = options.closed;
  options.normals = options.closed ? Normals::kAbsent : Normals::kGradient;
  options.quality = options.closed ? Quality::kNormal : Quality::kFine;
  options.drop_specks = !options.closed;
  const IsoRun expected = run_each(options);
  ASSERT_GT(expected.reports[0].triangles, 100U);
  ASSERT_FALSE(expected.reports[3].warnings.empty() && options.closed);
  for (const std::int64_t slab : {1, 3, 0, 1000}) {
    if (kSanitized && slab != 3) continue;
    const auto same = [&](Schedule schedule, int threads) {
      SCOPED_TRACE(::testing::Message() << "slab " << slab << ", schedule " << static_cast<int>(schedule)
                                        << ", threads " << threads);
      RunControl control;
      control.slab = slab;
      control.schedule = schedule;
      control.threads = threads;
      expect_same(run_together(options, control), expected);
    };
    same(Schedule::kLocal, 4);
    slab == 3 ? same(Schedule::kQueue, 1) : same(Schedule::kRounds, 2);
  }
}

constexpr auto kCubes = ExtractorKind::kCubes;
INSTANTIATE_TEST_SUITE_P(Options, IsoSweeps,
                         ::testing::Values(IsoCase{"Closed", kCubes, true}, IsoCase{"Open", kCubes, false},
                                           IsoCase{"Full", kCubes, false, 0, 0},
                                           IsoCase{"SmoothClosed", kCubes, true, 2},
                                           IsoCase{"SmoothOpen", kCubes, false, 3},
                                           IsoCase{"SmoothFull", kCubes, true, 1, 0},
                                           IsoCase{"TrilinearClosed", ExtractorKind::kTrilinear, true},
                                           IsoCase{"TrilinearOpen", ExtractorKind::kTrilinear, false},
                                           IsoCase{"TetrahedraClosed", ExtractorKind::kTetrahedra, true},
                                           IsoCase{"TetrahedraOpen", ExtractorKind::kTetrahedra, false},
                                           IsoCase{"DualClosed", ExtractorKind::kDual, true},
                                           IsoCase{"DualOpen", ExtractorKind::kDual, false},
                                           IsoCase{"DualFull", ExtractorKind::kDual, true, 0, 0}),
                         [](const auto& instance) { return instance.param.name; });

// A slab that holds too many vertices is extracted in several pieces, while the others wait.
TEST(IsoSweepOptions, FullSlabsAreTakenInPieces) {
  constexpr std::array<std::int64_t, 3> kWide{kSanitized ? 60 : 180, kSanitized ? 60 : 180, 14};
  MeshOptions options;
  options.error = Length::voxels(0);
  const IsoRun expected = run_each(options, kWide);
  ASSERT_GT(expected.reports[0].vertices_extracted, kSanitized ? 10'000U : 200'000U);
  expect_same(run_together(options, {}, kWide), expected);
}

TEST(IsoSweepOptions, ADistanceNumbersOfTrianglesAndNormalsByQuadricsAreThoseOfTheirOwnRuns) {
  MeshOptions options;
  options.error = Length::voxels(0.5);
  options.max_distance = Length::voxels(0.3);
  options.space = OutputSpace::kIndex;
  expect_same(run_together(options, {.slab = 4}), run_each(options));
  options = {};
  options.normals = Normals::kQuadric;
  expect_same(run_together(options, {.slab = 2}), run_each(options));
  options = {};
  options.error = Length::voxels(3);
  options.triangles = 1500;
  expect_same(run_together(options, {.slab = 2}), run_each(options));
  options = {};
  options.error = Length::units(std::numeric_limits<double>::infinity());
  options.share = 0.3;
  const IsoRun share = run_each(options);
  ASSERT_NEAR(static_cast<double>(share.reports[0].triangles),
              0.3 * static_cast<double>(share.reports[0].triangles_extracted), 2);  // a collapse takes two
  expect_same(run_together(options, {.slab = 2}), share);
}

// The values are those of scaled samples, and the range is the volume's.
TEST(IsoSweepOptions, SlopeAndNaNCountAsInTheirOwnRuns) {
  std::vector<float> samples(9 * 8 * 7);
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = static_cast<float>(n * 37 % 101);
  samples[200] = std::numeric_limits<float>::quiet_NaN();
  MemoryVolume volume({9, 8, 7}, samples);
  volume.info().slope = -2;
  volume.info().intercept = 10;
  std::array<MemorySink, 2> sinks;
  const IsoSink surfaces[] = {{-100, &sinks[0]}, {-20.5, &sinks[1]}};
  const IsoValuesReport report = mesh_iso_values(volume, surfaces, {});
  EXPECT_EQ(report.total.min, -190);
  EXPECT_EQ(report.total.max, 10);
  EXPECT_EQ(report.total.nan, 1U);
  EXPECT_EQ(report.total.warnings.size(), 1U);
  for (std::size_t n = 0; n < 2; ++n) {
    MemoryVolume again({9, 8, 7}, samples);
    again.info() = volume.info();
    MemorySink sink;
    MeshOptions options;
    options.iso = surfaces[n].iso;
    EXPECT_EQ(mesh_volume(again, sink, options).digest, report.meshes[n].digest);
    EXPECT_GT(report.meshes[n].triangles, 0U);
  }
}

// One slice has caps on both sides, or no cells at all; two have one layer of cells.
TEST(IsoSweepOptions, ThinVolumesAreThoseOfTheirOwnRuns) {
  for (const std::int64_t slices : {1, 2, 3}) {
    for (const bool closed : {true, false}) {
      for (const ExtractorKind kind : {ExtractorKind::kCubes, ExtractorKind::kDual}) {
        MeshOptions options;
        options.closed = closed;
        options.extractor = kind;
        SCOPED_TRACE(::testing::Message() << slices << " slices, closed " << closed);
        expect_same(run_together(options, {}, {12, 11, slices}), run_each(options, {12, 11, slices}));
      }
    }
  }
}

// A volume of one value that declares more samples than anyone can read.
class Blank final : public RowSource {
 public:
  Blank() {
    info_.path = "blank";
    info_.dims = {1 << 17, 1 << 17, 1 << 17};
    info_.type = SampleType::kUint8;
  }
  const VolumeInfo& info() const override { return info_; }
  void read(std::int64_t, std::int64_t, std::span<std::byte>) override { throw std::logic_error("it is read"); }
  void read_rows(std::int64_t, std::int64_t, std::int64_t, std::span<std::byte>) override {
    throw std::logic_error("rows of it are read");
  }
  std::optional<SampleBytes> constant() const override { return SampleBytes{std::byte{7}}; }

 private:
  VolumeInfo info_;
};

TEST(IsoSweepOptions, AVolumeOfOneValueOutsideIsNotRead) {
  Blank blank;
  std::array<MemorySink, 2> sinks;
  const IsoSink surfaces[] = {{8, &sinks[0]}, {9.5, &sinks[1]}};
  const IsoValuesReport report = mesh_iso_values(blank, surfaces, {});
  EXPECT_EQ(report.total.min, 7);
  EXPECT_EQ(report.total.max, 7);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_TRUE(sinks[n].finished);
    EXPECT_EQ(report.meshes[n].triangles, 0U);
    EXPECT_EQ(report.meshes[n].warnings.size(), 1U);
  }
}

TEST(IsoSweepOptions, WhatTakesOneSurfaceIsRefused) {
  MemorySink sinks[2];
  const IsoSink surfaces[] = {{120, &sinks[0]}, {140, &sinks[1]}};
  const auto refused = [&](const MeshOptions& options, const RunControl& control) {
    EXPECT_THROW(mesh_iso_values(*noise(), surfaces, options, control), std::invalid_argument);
    EXPECT_FALSE(sinks[0].finished);
  };
  MeshOptions options;
  options.levels = {{0.1, true}};
  refused(options, {});
  options = {};
  options.error = Length::voxels(-1);
  refused(options, {});
  options = {};
  options.values = noise();
  refused(options, {});
  RunControl control;
  control.memory = 1'000'000'000;
  refused({}, control);
  control = {};
  control.device = Device::kCuda;
  refused({}, control);
  control = {};
  control.checkpoint.folder = "/tmp";
  refused({}, control);
  const auto wrong = [](std::vector<IsoSink> list) {
    EXPECT_THROW(mesh_iso_values(*noise(), list, {}), std::invalid_argument);
  };
  wrong({});
  wrong({{3, &sinks[0]}, {3, &sinks[1]}});
  wrong({{3, &sinks[0]}, {4, &sinks[0]}});
  wrong({{3, &sinks[0]}, {4, nullptr}});
  wrong({{3, &sinks[0]}, {std::numeric_limits<double>::quiet_NaN(), &sinks[1]}});
}

class FailingSink final : public MeshSink {
 public:
  void append(const MeshPiece& piece) override {
    if (!piece.triangles.empty()) throw CannotWrite("full");
  }
  void finish() override {}
};

TEST(IsoSweepOptions, AnErrorInOneMeshEndsAll) {
  for (const int threads : {1, 4}) {
    MemorySink first;
    MemorySink last;
    FailingSink failing;
    const IsoSink surfaces[] = {{120, &first}, {140, &failing}, {160, &last}};
    RunControl control;
    control.threads = threads;
    EXPECT_THROW(mesh_iso_values(*noise(), surfaces, {}, control), CannotWrite);
    EXPECT_FALSE(first.finished);
    EXPECT_FALSE(last.finished);
  }
}

TEST(IsoSweepOptions, StopsWhenAsked) {
  MemorySink sink;
  const IsoSink surfaces[] = {{120, &sink}};
  std::atomic<bool> stop = false;
  RunControl control;
  control.stop = borrow(stop);
  control.slab = 2;
  std::int64_t last = 0;
  control.progress = [&](const Progress& progress) {
    EXPECT_EQ(progress.layers, kDims[2]);
    EXPECT_GT(progress.layer, last);
    last = progress.layer;
    stop = progress.layer >= 6;
  };
  EXPECT_THROW(mesh_iso_values(*noise(), surfaces, {}, control), Interrupted);
  EXPECT_EQ(last, 6);
  EXPECT_FALSE(sink.finished);
}

}  // namespace
}  // namespace isoweave::testing::iso_values_test
