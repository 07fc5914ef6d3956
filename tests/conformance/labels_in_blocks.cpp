// The meshes of labels in blocks are those of one sweep, for any size of the blocks.
// Threads: *LabelsInBlocks.*
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "isoweave/blocks.hpp"
#include "isoweave/error.hpp"
#include "label_maps.hpp"
#include "pipeline/parts/label_boxes.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::labels_in_blocks_test {
namespace {

constexpr std::array<std::int64_t, 3> kDims{37, 33, 41};

// Small labels all over the map, label 1 that runs through it as a lattice of bars, and background between.
std::unique_ptr<LabelMap> make_map() {
  std::vector<std::uint16_t> samples;
  for (std::int64_t k = 0; k < kDims[2]; ++k) {
    for (std::int64_t j = 0; j < kDims[1]; ++j) {
      for (std::int64_t i = 0; i < kDims[0]; ++i) {
        const bool bar = (i % 16 < 2) + (j % 16 < 2) + (k % 16 < 2) >= 2;
        const std::int64_t cell = i / 6 + 10 * (j / 7) + 100 * (k / 5);
        const bool inside = (i % 6) * (j % 7) % 5 != 1 && (cell * 37 + i + k) % 11 != 0;
        samples.push_back(static_cast<std::uint16_t>(bar ? 1 : inside ? 2 + cell * cell % 509 : 0));
      }
    }
  }
  auto map = std::make_unique<LabelMap>(kDims, samples);
  map->info().geometry.spacing = {0.7, 0.9, 1.6};
  map->info().geometry.origin = {-3, 40, 1000};
  return map;
}

const VolumeOpener kOpen = [] { return make_map(); };

struct Made {
  std::vector<MemorySink> sinks;
  LabelsReport report;
};

template <class Mesh>
Made run(std::span<const LabelExtent> labels, const Mesh& mesh) {
  Made made;
  made.sinks.resize(labels.size());
  std::vector<LabelSink> sinks;
  for (std::size_t n = 0; n < labels.size(); ++n) sinks.push_back({labels[n].label, &made.sinks[n], labels[n].box});
  made.report = mesh(std::span<const LabelSink>(sinks));
  return made;
}

void expect_same(const Made& found, const Made& expected) {
  ASSERT_EQ(found.report.labels.size(), expected.report.labels.size());
  for (std::size_t n = 0; n < found.sinks.size(); ++n) {
    SCOPED_TRACE(n);
    EXPECT_TRUE(found.sinks[n].finished);
    expect_same_surface(found.report.labels[n], expected.report.labels[n]);
    EXPECT_EQ(found.report.labels[n].target, expected.report.labels[n].target);
    EXPECT_EQ(found.report.labels[n].warnings, expected.report.labels[n].warnings);
    EXPECT_EQ(check_mesh(found.sinks[n].mesh).digest, expected.report.labels[n].digest);
  }
  EXPECT_EQ(found.report.total.triangles, expected.report.total.triangles);
  EXPECT_EQ(found.report.total.digest, expected.report.total.digest);
  EXPECT_EQ(found.report.total.collapses, expected.report.total.collapses);
  EXPECT_EQ(found.report.total.warnings, expected.report.total.warnings);
}

struct Way {
  const char* name;
  MeshOptions options{};
};

void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

std::vector<Way> ways() {
  std::vector<Way> all(7);
  for (Way& way : all) way.options.error = Length::voxels(0.3);
  all[0].name = "Closed";
  all[1].name = "Open";
  all[1].options.closed = false;
  all[1].options.normals = Normals::kGradient;
  all[2].name = "Smooth";
  all[2].options.smooth = 2;
  all[3].name = "Trilinear";
  all[3].options.extractor = ExtractorKind::kTrilinear;
  all[4].name = "Full";
  all[4].options.error = Length::units(0);
  all[5].name = "Number";
  all[5].options.triangles = 40;
  all[6].name = "Share";
  all[6].options.share = 0.6;
  all[6].options.error = Length::voxels(2);
  return all;
}

class LabelsInBlocks : public ::testing::TestWithParam<Way> {};

TEST_P(LabelsInBlocks, AreThoseOfTheSweep) {
  const std::vector<LabelExtent> labels = find_labels(*make_map());
  ASSERT_GT(labels.size(), 100U);
  const Made expected = run(labels, [&](auto sinks) { return mesh_labels(*make_map(), sinks, GetParam().options); });
  for (const std::int64_t size : {12, 20, 25, 64}) {
    if (kSanitized && size != 20) continue;
    SCOPED_TRACE(size);
    RunControl control;
    control.threads = size == 20 ? 2 : 1;
    control.measure = true;
    expect_same(
        run(labels,
            [&](auto sinks) { return mesh_labels_in_blocks(kOpen, sinks, GetParam().options, {size}, control); }),
        expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Options, LabelsInBlocks, ::testing::ValuesIn(ways()),
                         [](const auto& one) { return one.param.name; });

// Keeps digests, and how many labels were open at the same time.
class CountedOutput final : public LabelOutput {
 public:
  explicit CountedOutput(std::size_t labels) : sinks_(labels), digests_(labels, kNone) {}

  std::array<double, 3> offset() const override { return {0, 0, 0}; }

  MeshSink& begin(std::size_t n) override {
    EXPECT_EQ(sinks_[n], nullptr) << "begun once";
    EXPECT_EQ(digests_[n], kNone) << "begun before it ends";
    most_open = std::max(most_open, ++open_);
    sinks_[n] = std::make_unique<MemorySink>();
    return *sinks_[n];
  }

  void end(std::size_t n, MeshReport report) override {
    EXPECT_EQ(digests_[n], kNone) << "ends once";
    digests_[n] = report.digest;
    if (sinks_[n] == nullptr) return;
    EXPECT_EQ(check_mesh(sinks_[n]->mesh).digest, report.digest) << "complete when it ends";
    --open_;
  }

  const std::vector<std::uint64_t>& digests() const { return digests_; }
  std::size_t most_open = 0;

 private:
  static constexpr std::uint64_t kNone = 1;
  std::vector<std::unique_ptr<MemorySink>> sinks_;
  std::vector<std::uint64_t> digests_;
  std::size_t open_ = 0;
};

TEST(LabelsOfBoxes, AreBegunAndEndedBoxByBox) {
  std::vector<LabelExtent> labels = find_labels(*make_map());
  if (kSanitized) labels.resize(60);
  labels.push_back({60'000, 0, {}});  // occurs nowhere
  MeshOptions options;
  options.error = Length::voxels(0.3);
  const Made expected = run(labels, [&](auto sinks) { return mesh_labels(*make_map(), sinks, options); });
  CountedOutput output(labels.size());
  const MeshReport total = mesh_labels_in_blocks(kOpen, labels, output, options, {12});
  for (std::size_t n = 0; n < labels.size(); ++n) {
    EXPECT_EQ(output.digests()[n], expected.report.labels[n].digest) << labels[n].label.text();
  }
  EXPECT_EQ(total.digest, expected.report.total.digest);
  EXPECT_EQ(total.triangles, expected.report.total.triangles);
  EXPECT_LT(output.most_open, labels.size() / 4);
}

TEST(LabelExtents, InBlocksAreThoseOfTheMap) {
  const std::vector<LabelExtent> expected = find_labels(*make_map());
  const std::vector<Label> some{300, 1, 40'000, 7};
  for (const std::int64_t size : {9, 16, 100}) {
    const std::vector<LabelExtent> found = find_labels_in_blocks(kOpen, size);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t n = 0; n < found.size(); ++n) {
      EXPECT_EQ(found[n].label, expected[n].label);
      EXPECT_EQ(found[n].samples, expected[n].samples);
      EXPECT_EQ(found[n].box.first, expected[n].box.first);
      EXPECT_EQ(found[n].box.end, expected[n].box.end);
    }
    const std::vector<LabelExtent> named = find_labels_in_blocks(kOpen, size, some);
    ASSERT_EQ(named.size(), some.size());
    for (std::size_t n = 0; n < some.size(); ++n) EXPECT_EQ(named[n].label, some[n]);
    EXPECT_EQ(named[2].samples, 0U);
  }
}

TEST(LabelBoxes, EveryLabelIsInOneBoxThatHoldsIt) {
  std::vector<Region> boxes{{}};
  for (std::int64_t n = 0; n < 500; ++n) {
    Region box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.first[axis] = (n * 7919 + static_cast<std::int64_t>(axis) * 131 * n) % 1000;
      box.end[axis] = box.first[axis] + 1 + n * n % (n % 50 == 0 ? 300 : 60);
    }
    boxes.push_back(box);
  }
  constexpr std::int64_t kSize = 100;
  const GroupedLabels grouped = group_labels(boxes, kSize);
  std::map<std::size_t, int> times;
  for (const LabelGroup& group : grouped.groups) {
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_LE(group.box.end[axis] - group.box.first[axis], kSize);
    for (const std::size_t n : group.labels) {
      ++times[n];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GE(boxes[n].first[axis], group.box.first[axis]);
        EXPECT_LE(boxes[n].end[axis], group.box.end[axis]);
      }
    }
  }
  for (const std::size_t n : grouped.large) {
    ++times[n];
    const auto extent = [&](std::size_t axis) { return boxes[n].end[axis] - boxes[n].first[axis]; };
    EXPECT_GT(std::max({extent(0), extent(1), extent(2)}), kSize / 2) << "it fits in a box";
  }
  EXPECT_FALSE(grouped.large.empty());
  ASSERT_EQ(times.size(), boxes.size() - 1) << "all but the empty one";
  for (const auto& [n, count] : times) EXPECT_EQ(count, 1) << n;
}

TEST(LabelsInBlocksRefuse, WhatTheyDoNotHave) {
  const std::vector<LabelExtent> labels = find_labels(*make_map());
  const auto with = [&](const MeshOptions& options, const RunControl& control, std::int64_t size) {
    run(labels, [&](auto sinks) { return mesh_labels_in_blocks(kOpen, sinks, options, {size}, control); });
  };
  EXPECT_THROW(with({}, {}, 7), std::invalid_argument);
  MeshOptions levels;
  levels.levels = {Length::voxels(0.1)};
  EXPECT_THROW(with(levels, {}, 16), std::invalid_argument);
  MeshOptions dual;
  dual.extractor = ExtractorKind::kDual;
  EXPECT_THROW(with(dual, {}, 16), std::invalid_argument) << "label 1 is larger than a box";
  EXPECT_NO_THROW(with(dual, {}, 64));
  std::atomic<bool> stop{true};
  RunControl stopped;
  stopped.stop = std::shared_ptr<std::atomic<bool>>(&stop, [](auto*) {});
  EXPECT_THROW(with({}, stopped, 16), Interrupted);
}

}  // namespace
}  // namespace isoweave::testing::labels_in_blocks_test
