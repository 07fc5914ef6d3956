// Runs to a share of all triangles: the mesh is that of the run to the number which the share turns out to be.
// Threads: Shares.TakeOnePass
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "isoweave/components.hpp"
#include "isoweave/forecast.hpp"
#include "sanitized.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::shares_test {
namespace {

const GenerateOptions kVolume{"noise", {30, 26, 44}, SampleType::kUint8, {1, 1, 1.3}, 4};

MeshOptions options_of(double share) {
  MeshOptions options;
  options.iso = 127.5;
  options.error = Length::units(std::numeric_limits<double>::infinity());
  options.share = share;
  return options;
}

MeshReport run(const GenerateOptions& volume, const MeshOptions& options, const RunControl& control = {}) {
  MemorySink sink;
  const MeshReport report = mesh_volume(*generate_volume(volume), sink, options, control);
  EXPECT_EQ(sink.mesh.triangles.size(), report.triangles);
  EXPECT_TRUE(sink.finished);
  return report;
}

// The run to the number: the nearest one to the share of all triangles, and at least 1.
MeshReport run_to_number(const GenerateOptions& volume, MeshOptions options, std::uint64_t all) {
  options.triangles = std::max<std::uint64_t>(
      static_cast<std::uint64_t>(std::floor(options.share * static_cast<double>(all) + 0.5)), 1);
  options.share = 0;
  return run(volume, options);
}

void expect_same_run(const MeshReport& found, const MeshReport& expected) {
  expect_same_surface(found, expected);
  EXPECT_EQ(found.error, expected.error);
  EXPECT_EQ(found.target, expected.target);
  EXPECT_GT(found.target, 0U);
  EXPECT_EQ(found.triangles_extracted, expected.triangles_extracted);
  EXPECT_EQ(found.collapses, expected.collapses);
  EXPECT_EQ(found.warnings, expected.warnings);
}

std::uint64_t all_triangles(const GenerateOptions& volume) {
  return count_triangles(*generate_volume(volume), options_of(0.5));
}

// How a run can go about it: the volume is read once only, opened again, counted first.
TEST(Shares, AreTheNumbersThatTheyTurnOutToBe) {
  const std::uint64_t all = all_triangles(kVolume);
  for (const double share : kSanitized ? std::vector{0.03, 0.9} : std::vector{1e-9, 0.03, 0.3, 0.9, 1.0}) {
    const MeshReport expected = run_to_number(kVolume, options_of(share), all);
    for (const double head_start : {-1.0, 0.0, 0.1, 3.0}) {
      for (const bool count_first : {false, true}) {
        RunControl control{.threads = count_first ? 1 : 2, .slab = head_start > 0 ? 3 : 0};
        if (head_start >= 0) control.reopen = [] { return generate_volume(kVolume); };
        if (head_start >= 0) control.head_start = head_start;
        control.count_first = count_first;
        SCOPED_TRACE(::testing::Message() << share << " with " << head_start << (count_first ? ", counted" : ""));
        expect_same_run(run(kVolume, options_of(share), control), expected);
      }
    }
  }
}

// A forecast knows the number only as nearly as it knows the triangles.
TEST(Shares, AreForeseen) {
  const GenerateOptions volume{"noise", {64, 64, 64}, SampleType::kUint8};
  const std::uint64_t all = all_triangles(volume);
  RunControl control;
  control.reopen = [&] { return generate_volume(volume); };
  const Forecast forecast = forecast_mesh(*generate_volume(volume), options_of(0.4), control);
  EXPECT_NEAR(static_cast<double>(forecast.triangles), 0.4 * static_cast<double>(all), 0.1 * static_cast<double>(all));
  EXPECT_GT(forecast.head_start, 0);
  expect_same_run(run(volume, options_of(0.4), control), run_to_number(volume, options_of(0.4), all));
}

// One pass over the volume does where a head start is known and not too high.
TEST(Shares, TakeOnePass) {
  const GenerateOptions volume{"noise", {64, 64, 64}, SampleType::kUint8};
  int opened = 0;
  RunControl control{.head_start = 0.1};
  control.reopen = [&] {
    ++opened;
    return generate_volume(volume);
  };
  run(volume, options_of(0.4), control);
  EXPECT_EQ(opened, 0);
}

// With the least share the error stops the run before, with the largest one it never does.
TEST(Shares, StopAtTheErrorWhereThatComesFirst) {
  const std::uint64_t all = all_triangles(kVolume);
  for (const double share : {0.01, 0.5, 0.95}) {
    MeshOptions options = options_of(share);
    options.error = Length::voxels(0.3);
    const MeshReport expected = run_to_number(kVolume, options, all);
    EXPECT_EQ(expected.triangles > expected.target, share == 0.01);
    for (const double head_start : {0.0, 0.1, 3.0}) {
      RunControl control{.head_start = head_start};
      control.reopen = [] { return generate_volume(kVolume); };
      expect_same_run(run(kVolume, options, control), expected);
    }
  }
}

TEST(Shares, AreOfTheComponentsThatAreChosen) {
  MeshOptions options = options_of(0.3);
  options.components =
      std::make_shared<ComponentChoice>(choose_components(*generate_volume(kVolume), options, {.largest = true}));
  ASSERT_GT(options.components->triangles_dropped, 0U);
  const MeshReport expected = run_to_number(kVolume, options, options.components->triangles);
  for (const double head_start : {0.0, 0.1}) {
    RunControl control{.head_start = head_start};
    control.reopen = [] { return generate_volume(kVolume); };
    expect_same_run(run(kVolume, options, control), expected);
  }
}

TEST(Shares, OfAMesh) {
  MemorySink full;
  mesh_volume(*generate_volume(kVolume), full, [] {
    MeshOptions options = options_of(0);
    options.error = Length::units(0);
    return options;
  }());
  SimplifyOptions by_share, by_number;
  by_share.error = by_number.error = Length::units(std::numeric_limits<double>::infinity());
  by_share.share = 0.25;
  by_number.triangles = (full.mesh.triangles.size() + 2) / 4;
  MemorySink a, b;
  expect_same_run(simplify_mesh(full.mesh, a, by_share), simplify_mesh(full.mesh, b, by_number));
}

TEST(Shares, ThatAreNoneAreRefused) {
  for (const double share : {-0.1, 1.5, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(run(kVolume, options_of(share)), std::invalid_argument) << share;
  }
  MeshOptions both = options_of(0.5);
  both.triangles = 10;
  EXPECT_THROW(run(kVolume, both), std::invalid_argument);
  MeshOptions levels = options_of(0.5);
  levels.levels = {Length::voxels(0.1)};
  EXPECT_THROW(run(kVolume, levels), std::invalid_argument);
}

}  // namespace
}  // namespace isoweave::testing::shares_test
