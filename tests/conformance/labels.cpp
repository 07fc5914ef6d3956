// The meshes of the labels of a map out of one sweep are those of a run on each label's mask.
// Threads: *GiveTheMeshesOfRunsOnTheMasks/Open*:*GiveTheMeshesOfRunsOnTheMasks/SmoothOpen*
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "label_maps.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::labels_test {
namespace {

constexpr std::array<std::int64_t, 3> kDims{18, 15, 18};
constexpr std::array<Label, 6> kLabels{1, 2, 7, 300, 9, 44};  // the last one does not occur

std::unique_ptr<LabelMap> make_map() {
  auto map = std::make_unique<LabelMap>(kDims, touching_blobs(kDims));
  map->info().geometry.spacing = {0.7, 0.9, 1.6};
  map->info().geometry.origin = {-3, 40, 1000};
  map->info().geometry.direction = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  return map;
}

struct LabelRun {
  std::vector<TriangleMesh> meshes;
  std::vector<MeshReport> reports;
  MeshReport total;
};

LabelRun run_labels(const MeshOptions& options, const RunControl& control, bool boxes) {
  std::vector<MemorySink> sinks(kLabels.size());
  std::vector<LabelSink> labels;
  const std::vector<LabelExtent> extents = find_labels(*make_map(), kLabels);
  for (std::size_t n = 0; n < kLabels.size(); ++n) {
    labels.push_back({kLabels[n], &sinks[n], boxes ? std::optional(extents[n].box) : std::nullopt});
  }
  const auto map = make_map();
  LabelsReport report = mesh_labels(*map, labels, options, control);
  EXPECT_EQ(map->slices_read, kDims[2]);
  LabelRun run{{}, std::move(report.labels), std::move(report.total)};
  for (MemorySink& sink : sinks) {
    EXPECT_TRUE(sink.finished);
    run.meshes.push_back(std::move(sink.mesh));
  }
  return run;
}

LabelRun run_each(MeshOptions options) {
  options.iso = 0.5;
  LabelRun run;
  for (const Label label : kLabels) {
    MemorySink sink;
    run.reports.push_back(mesh_volume(*label_volume(make_map(), label), sink, options));
    run.meshes.push_back(std::move(sink.mesh));
  }
  return run;
}

// Places and normals, in an order of their own.
std::vector<std::array<float, 6>> sorted_vertices(const TriangleMesh& mesh) {
  std::vector<std::array<float, 6>> list;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const Point& p = mesh.vertices[v];
    const Point n = mesh.normals.empty() ? Point{} : mesh.normals[v];
    list.push_back({p[0], p[1], p[2], n[0], n[1], n[2]});
  }
  std::ranges::sort(list);
  return list;
}

void expect_same(const LabelRun& found, const LabelRun& expected) {
  std::uint64_t triangles = 0;
  for (std::size_t n = 0; n < kLabels.size(); ++n) {
    SCOPED_TRACE(::testing::Message() << "label " << kLabels[n].text());
    const MeshReport& a = found.reports[n];
    const MeshReport& b = expected.reports[n];
    triangles += b.triangles;
    expect_same_surface(a, b);
    EXPECT_EQ(a.triangles_extracted, b.triangles_extracted);
    EXPECT_EQ(a.vertices_extracted, b.vertices_extracted);
    EXPECT_EQ(a.cells_crossed, b.cells_crossed);
    EXPECT_EQ(a.collapses, b.collapses);
    EXPECT_EQ(a.target, b.target);
    EXPECT_EQ(a.warnings.empty(), kLabels[n] != 44);
    EXPECT_EQ(check_mesh(found.meshes[n]).digest, b.digest);
    EXPECT_EQ(sorted_vertices(found.meshes[n]), sorted_vertices(expected.meshes[n]));
  }
  EXPECT_EQ(found.total.triangles, triangles);
  EXPECT_EQ(found.total.sweep.back().final_triangles, triangles);
}

struct LabelCase {
  const char* name;
  bool closed;
  int smooth;
  double error;
  ExtractorKind extractor = ExtractorKind::kCubes;
};

class LabelSweeps : public ::testing::TestWithParam<LabelCase> {};

TEST_P(LabelSweeps, GiveTheMeshesOfRunsOnTheMasks) {
  MeshOptions options;
  options.closed = GetParam().closed;
  options.smooth = GetParam().smooth;
  options.error = Length::voxels(GetParam().error);
  options.extractor = GetParam().extractor;
  options.normals = options.closed ? Normals::kGradient : Normals::kQuadric;
  options.quality = options.closed ? Quality::kNormal : Quality::kFine;
  options.drop_specks = !options.closed;
  const LabelRun expected = run_each(options);
  ASSERT_GT(expected.reports[0].triangles, 100U);
  for (const std::int64_t slab : {1, 3, 0, 1000}) {
    if (kSanitized && slab != 3) continue;
    for (const bool boxes : {true, false}) {
      const auto same = [&](Schedule schedule, int threads) {
        SCOPED_TRACE(::testing::Message() << "slab " << slab << ", boxes " << boxes << ", schedule "
                                          << static_cast<int>(schedule) << ", threads " << threads);
        RunControl control;
        control.slab = slab;
        control.schedule = schedule;
        control.threads = threads;
        expect_same(run_labels(options, control, boxes), expected);
      };
      same(Schedule::kLocal, 4);
      boxes ? same(Schedule::kQueue, 1) : same(Schedule::kRounds, 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Options, LabelSweeps,
                         ::testing::Values(LabelCase{"Closed", true, 0, 0.2}, LabelCase{"Open", false, 0, 0.2},
                                           LabelCase{"Full", true, 0, 0}, LabelCase{"SmoothClosed", true, 3, 0.2},
                                           LabelCase{"SmoothOpen", false, 2, 0.2}, LabelCase{"SmoothFull", true, 1, 0},
                                           LabelCase{"Trilinear", true, 0, 0.2, ExtractorKind::kTrilinear},
                                           LabelCase{"Tetrahedra", false, 0, 0.2, ExtractorKind::kTetrahedra},
                                           LabelCase{"Dual", true, 0, 0.2, ExtractorKind::kDual},
                                           LabelCase{"DualSmoothOpen", false, 2, 0.2, ExtractorKind::kDual}),
                         [](const auto& instance) { return instance.param.name; });

template <class T>
Label label_of(T sample, double slope) {
  if constexpr (std::is_integral_v<T>) return sample;
  return static_cast<std::int64_t>(slope * static_cast<double>(sample));
}

// The labels of make_map() as samples of another type, where as(label) is what a label is there before it is scaled.
template <class T>
std::vector<std::uint64_t> digests_as(SampleType type, const std::function<T(std::uint16_t)>& as, double slope,
                                      const MeshOptions& options, int threads) {
  std::vector<T> samples;
  for (const std::uint16_t label : touching_blobs(kDims)) samples.push_back(as(label));
  VolumeInfo info = make_map()->info();
  info.type = type;
  info.slope = slope;
  const auto map = volume_in_memory(info, std::as_bytes(std::span(samples)));
  std::vector<MemorySink> sinks(kLabels.size());
  std::vector<LabelSink> labels;
  for (std::size_t n = 0; n < kLabels.size(); ++n) {
    const T sample = as(static_cast<std::uint16_t>(kLabels[n].bits()));
    labels.push_back({label_of(sample, slope), &sinks[n], {}});
  }
  RunControl control;
  control.threads = threads;
  std::vector<std::uint64_t> digests;
  for (const MeshReport& report : mesh_labels(*map, labels, options, control).labels) digests.push_back(report.digest);
  return digests;
}

TEST(LabelTypes, GiveTheMeshesOfTheSameMapInAnotherType) {
  MeshOptions options;
  options.smooth = 1;
  std::vector<std::uint64_t> expected;
  for (const MeshReport& report : run_each(options).reports) expected.push_back(report.digest);
  for (const std::int64_t slab : {1, 5}) {
    const int threads = slab == 1 ? 1 : 3;
    const auto high = [](std::uint16_t label) { return label == 0 ? 0 : ~std::uint64_t{0} - label; };
    EXPECT_EQ((digests_as<std::uint64_t>(SampleType::kUint64, high, 1, options, threads)), expected);
    const auto low = [](std::uint16_t label) { return label == 0 ? 0 : -7112614941 - label; };
    EXPECT_EQ((digests_as<std::int64_t>(SampleType::kInt64, low, 1, options, threads)), expected);
    const auto same = [](std::uint16_t label) { return static_cast<float>(label); };
    EXPECT_EQ((digests_as<float>(SampleType::kFloat32, same, 1, options, threads)), expected);
    EXPECT_EQ((digests_as<float>(SampleType::kFloat32, same, -3, options, threads)), expected);
    const auto wide = [](std::uint16_t label) { return 1e12 * label; };
    EXPECT_EQ((digests_as<double>(SampleType::kFloat64, wide, 1, options, threads)), expected);
  }
}

TEST(LabelTypes, AFractionEndsTheSweep) {
  MemorySink sink;
  const LabelSink labels[] = {{1, &sink, {}}};
  std::vector<float> samples(static_cast<std::size_t>(kDims[0] * kDims[1] * kDims[2]), 1);
  samples[static_cast<std::size_t>((4 * kDims[1] + 3) * kDims[0] + 2)] = 0.5F;
  VolumeInfo info = make_map()->info();
  info.type = SampleType::kFloat32;
  try {
    mesh_labels(*volume_in_memory(info, std::as_bytes(std::span(samples))), labels, {});
    FAIL() << "expected BadInput";
  } catch (const BadInput& error) {
    EXPECT_STREQ(error.what(), "labels: expected whole numbers as labels, found 0.5 in sample 2,3,4");
  }
  EXPECT_FALSE(sink.finished);
}

TEST(LabelSweepOptions, WithADistanceTheyAreTheSameToo) {
  MeshOptions options;
  options.smooth = 2;
  options.error = Length::voxels(0.5);
  options.max_distance = Length::voxels(0.3);
  options.space = OutputSpace::kIndex;
  const LabelRun expected = run_each(options);
  expect_same(run_labels(options, {.slab = 4}, true), expected);
}

TEST(LabelSweepOptions, ANumberAndAShareOfTrianglesAreThoseOfEachLabel) {
  MeshOptions options;
  options.error = Length::voxels(3);
  options.triangles = 2000;
  const LabelRun number = run_each(options);
  ASSERT_EQ(number.reports[0].triangles, 2000U);
  for (const bool boxes : {true, false}) expect_same(run_labels(options, {.slab = 2}, boxes), number);
  options = {};
  options.error = Length::units(std::numeric_limits<double>::infinity());
  options.share = 0.25;
  options.smooth = 2;
  const LabelRun share = run_each(options);
  const auto quarter = static_cast<double>(share.reports[0].triangles_extracted) / 4;
  ASSERT_NEAR(static_cast<double>(share.reports[0].triangles), quarter, 2);  // a collapse takes two
  for (const bool boxes : {true, false}) expect_same(run_labels(options, {.threads = 2, .slab = 3}, boxes), share);
}

TEST(LabelSweepOptions, WhatTakesOneSurfaceIsRefused) {
  MemorySink sink;
  const LabelSink labels[] = {{1, &sink, {}}};
  const auto refused = [&](const MeshOptions& options, const RunControl& control) {
    EXPECT_THROW(mesh_labels(*make_map(), labels, options, control), std::invalid_argument);
    EXPECT_FALSE(sink.finished);
  };
  MeshOptions options;
  options.levels = {{0.1, true}};
  refused(options, {});
  options = {};
  options.error = Length::voxels(-1);
  refused(options, {});
  options = {};
  options.smooth = -1;
  refused(options, {});
  options.smooth = kMostSmoothing + 1;
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
  const LabelSink outside[] = {{1, &sink, Region{{0, 0, 0}, {19, 15, 18}}}};
  EXPECT_THROW(mesh_labels(*make_map(), outside, {}), std::invalid_argument);
  const auto scaled = make_map();
  scaled->info().slope = 0.5;
  EXPECT_THROW(mesh_labels(*scaled, labels, {}), BadInput);
}

// What goes wrong in one label ends the run, and no label is finished.
class FailingSink final : public MeshSink {
 public:
  void append(const MeshPiece& piece) override {
    if (!piece.triangles.empty()) throw CannotWrite("full");
  }
  void finish() override {}
};

TEST(LabelSweepOptions, AnErrorInOneLabelEndsAll) {
  for (const int threads : {1, 4}) {
    for (const bool large : {true, false}) {
      MemorySink sinks[6];
      FailingSink failing;
      std::vector<LabelSink> labels{{1, &sinks[0], {}}, {2, &failing, {}}, {300, &sinks[1], {}}, {7, &sinks[2], {}}};
      if (!large) labels.insert(labels.end(), {{7, &sinks[3], {}}, {7, &sinks[4], {}}, {7, &sinks[5], {}}});
      RunControl control;
      control.threads = threads;
      MeshOptions options;
      options.error = Length::voxels(0);
      control.slab = 2;
      EXPECT_THROW(mesh_labels(*make_map(), labels, options, control), CannotWrite);
      for (const MemorySink& sink : sinks) EXPECT_FALSE(sink.finished);
    }
  }
}

TEST(LabelSweepOptions, StopsWhenAsked) {
  MemorySink sink;
  const LabelSink labels[] = {{1, &sink, {}}};
  std::atomic<bool> stop = false;
  RunControl control;
  control.stop = borrow(stop);
  MeshOptions options;
  control.slab = 2;
  std::int64_t last = 0;
  control.progress = [&](const Progress& progress) {
    EXPECT_EQ(progress.layers, kDims[2]);
    EXPECT_GT(progress.layer, last);
    last = progress.layer;
    stop = progress.layer >= 6;
  };
  EXPECT_THROW(mesh_labels(*make_map(), labels, options, control), Interrupted);
  EXPECT_EQ(last, 6);
  EXPECT_FALSE(sink.finished);
}

}  // namespace
}  // namespace isoweave::testing::labels_test
