// Runs to a number of triangles decide from the beginning up to an error that a forecast gives. Whatever the error is,
// the mesh is that of a run without it.
// Threads: HeadStartRuns.Need*
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "isoweave/error.hpp"
#include "isoweave/forecast.hpp"
#include "sanitized.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::head_starts_test {
namespace {

constexpr std::int64_t kSide = 40;

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

MeshOptions options_of(std::uint64_t triangles, double error = kNoLimit) {
  MeshOptions options;
  options.iso = 127.5;
  options.closed = true;
  options.error = Length::units(error);
  options.triangles = triangles;
  return options;
}

// Samples of one kind below a height, and of another above it.
std::vector<float> two_halves(const char* below, const char* above, std::int64_t slices) {
  std::vector<float> samples;
  for (const char* kind : {below, above}) {
    GenerateOptions half{kind, {kSide, kSide, slices / 2}, SampleType::kUint8, {1, 1, 1.3}, 4};
    const auto volume = generate_volume(half);
    std::vector<std::byte> bytes(static_cast<std::size_t>(kSide * kSide * slices / 2));
    volume->read(0, slices / 2, bytes);
    for (const std::byte sample : bytes) samples.push_back(static_cast<float>(sample));
  }
  return samples;
}

struct Found {
  MeshReport report;
  int opened = 0;  // after the first time
};

Found run(const std::vector<float>& samples, std::int64_t slices, std::uint64_t triangles, RunControl control,
          double error = kNoLimit) {
  const std::array<std::int64_t, 3> dims{kSide, kSide, slices};
  Found found;
  if (control.head_start > 0 || control.count_first) {
    control.reopen = [&] {
      ++found.opened;
      return std::make_unique<MemoryVolume>(dims, samples);
    };
  }
  MemorySink sink;
  MemoryVolume volume(dims, samples);
  found.report = mesh_volume(volume, sink, options_of(triangles, error), control);
  EXPECT_EQ(sink.mesh.triangles.size(), found.report.triangles);
  EXPECT_TRUE(sink.finished);
  return found;
}

void expect_same_run(const MeshReport& found, const MeshReport& expected) {
  expect_same_surface(found, expected);
  EXPECT_EQ(found.triangles_extracted, expected.triangles_extracted);
  EXPECT_EQ(found.collapses, expected.collapses);
  EXPECT_EQ(found.postponed, expected.postponed);
  EXPECT_EQ(found.rekeyed, expected.rekeyed);
}

TEST(HeadStartRuns, ReadTheVolumeAgainWhereTheyWereTooHigh) {
  const std::int64_t slices = 24;
  const std::vector<float> samples = two_halves("smooth", "noise", slices);
  const std::uint64_t triangles = 4000;
  const Found plain = run(samples, slices, triangles, {.threads = 1, .schedule = Schedule::kQueue});
  ASSERT_GT(plain.report.triangles_extracted, 5 * triangles);
  for (const Schedule schedule : {Schedule::kLocal, Schedule::kRounds, Schedule::kQueue}) {
    for (const std::int64_t slab : {1, 7}) {
      RunControl control{.threads = slab == 1 ? 3 : 1, .schedule = schedule, .slab = slab};
      control.head_start = plain.report.error / 2;
      const Found low = run(samples, slices, triangles, control);
      EXPECT_EQ(low.opened, 0);
      expect_same_run(low.report, plain.report);
      control.head_start = plain.report.error * 3;
      const Found high = run(samples, slices, triangles, control);
      EXPECT_EQ(high.opened, 1);
      expect_same_run(high.report, plain.report);
    }
  }
}

// Two sweeps at least: what the first one lets go is not handed out.
TEST(HeadStartRuns, AreCountedFirst) {
  const std::int64_t slices = 24;
  const std::vector<float> samples = two_halves("smooth", "noise", slices);
  for (const double error : {kNoLimit, 0.5}) {
    for (const std::uint64_t triangles : {std::uint64_t{4000}, std::uint64_t{12'000}, std::uint64_t{10'000'000}}) {
      const Found plain = run(samples, slices, triangles, {.threads = 1, .schedule = Schedule::kQueue}, error);
      for (const double factor : {0.0, 0.2, 2.0}) {
        RunControl control{.threads = 2, .slab = 4, .head_start = factor * plain.report.error, .count_first = true};
        const Found counted = run(samples, slices, triangles, control, error);
        expect_same_run(counted.report, plain.report);
        EXPECT_GE(counted.opened, 1);
      }
    }
  }
}

// A cap that is too small for one sweep does for two.
TEST(HeadStartRuns, AreCountedFirstWhereMemoryIsShort) {
  if (kSanitized) GTEST_SKIP() << "a sanitizer takes memory of its own";
  const GenerateOptions volume{"smooth", {200, 200, 240}, SampleType::kUint8};
  const std::uint64_t triangles = 1'500'000;
  RunControl control{.threads = 2};
  control.reopen = [&] { return generate_volume(volume); };
  const Forecast forecast = forecast_mesh(*generate_volume(volume), options_of(triangles), control);
  ASSERT_LT(2 * forecast.least_bytes, forecast.least_bytes_at_once);
  MemorySink at_once, counted;
  const MeshReport plain = mesh_volume(*generate_volume(volume), at_once, options_of(triangles), control);
  control.memory = forecast.least_bytes_at_once / 2;
  std::uint64_t most = 0;
  int sweeps = 0;
  control.progress = [&](const Progress& p) {
    most = std::max(most, p.bytes);
    sweeps += p.layer == p.layers ? 1 : 0;
  };
  const MeshReport report = mesh_volume(*generate_volume(volume), counted, options_of(triangles), control);
  expect_same_run(report, plain);
  EXPECT_EQ(report.triangles, triangles);
  EXPECT_GE(sweeps, 2);
  EXPECT_LT(2 * most, triangles * 140) << "what one sweep holds in the end";
}

// The second sweep must find what the first one counted.
TEST(HeadStartRuns, AreRefusedWhereTheVolumeChanges) {
  const std::int64_t slices = 24;
  std::vector<float> samples = two_halves("noise", "noise", slices);
  const std::array<std::int64_t, 3> dims{kSide, kSide, slices};
  int opened = 0;
  RunControl control{.threads = 1, .head_start = 0.3, .count_first = true};
  control.reopen = [&] {
    const std::size_t changed = samples.size() / 2 + 10 * static_cast<std::size_t>(++opened);
    samples[changed] = 255 - samples[changed];
    return std::make_unique<MemoryVolume>(dims, samples);
  };
  MemorySink sink;
  MemoryVolume volume(dims, samples);
  EXPECT_THROW(mesh_volume(volume, sink, options_of(30'000), control), BadInput);
  EXPECT_FALSE(sink.finished);
}

// With an error as high as the head start triangles are final before the end. They go out only once there are so many
// of them that the sweep does not begin again.
TEST(HeadStartRuns, HandOutNothingTwice) {
  const std::int64_t slices = 24;
  const std::vector<float> samples = two_halves("noise", "noise", slices);
  const double error = 0.4;
  const std::uint64_t left = run(samples, slices, 0, {}, error).report.triangles;
  for (const std::uint64_t triangles : {left + 200, left / 10}) {
    const Found plain = run(samples, slices, triangles, {.threads = 1, .schedule = Schedule::kQueue}, error);
    std::uint64_t early = 0;  // triangles that are final before the last layer of the first sweep
    bool is_first = true;
    RunControl control{.threads = 1, .slab = 1, .head_start = error};
    control.progress = [&](const Progress& p) {
      is_first = is_first && p.layer < p.layers;
      early = is_first ? p.final_triangles : early;
    };
    const Found found = run(samples, slices, triangles, control, error);
    expect_same_run(found.report, plain.report);
    EXPECT_EQ(found.opened, triangles > left ? 1 : 0);
    EXPECT_EQ(early > 0, triangles < left);
  }
}

// Tiles see one half of these volumes, or both.
TEST(HeadStartRuns, ComeFromForecastsThatMislead) {
  const std::int64_t slices = kSanitized ? 48 : 96;
  int opened = 0;
  for (const auto& [below, above] : {std::pair{"smooth", "noise"}, {"noise", "smooth"}}) {
    const std::vector<float> samples = two_halves(below, above, slices);
    MemoryVolume volume({kSide, kSide, slices}, samples);
    for (const std::uint64_t triangles : {2000U, 20000U}) {
      const double head_start = forecast_mesh(volume, options_of(triangles)).head_start;
      EXPECT_GT(head_start, 0);
      const Found plain = run(samples, slices, triangles, {.threads = 1, .schedule = Schedule::kQueue});
      for (const double factor : {1.0, 4.0}) {
        const Found found = run(samples, slices, triangles, {.threads = 2, .head_start = factor * head_start});
        expect_same_run(found.report, plain.report);
        opened += found.opened;
      }
    }
  }
  EXPECT_GT(opened, 0);
}

// A forecast that knows no head start is not made a second time by the run.
TEST(HeadStartRuns, MakeAForecastOnlyWhereNoneIsGiven) {
  GenerateOptions large{"sphere", {170, 170, 170}, SampleType::kUint8};
  for (const std::optional<double> head_start : {std::optional<double>{}, std::optional<double>{0}}) {
    int opened = 0;
    RunControl control{.threads = 1, .head_start = head_start};
    control.reopen = [&] {
      ++opened;
      return generate_volume(large);
    };
    MemorySink sink;
    mesh_volume(*generate_volume(large), sink, options_of(20'000), control);
    EXPECT_EQ(opened, head_start ? 0 : 1);
  }
}

// A pipe can be read once only; what is in memory needs no opening.
TEST(HeadStartRuns, NeedAVolumeThatCanBeReadAgain) {
  const std::int64_t slices = 24;
  const std::vector<float> samples = two_halves("noise", "noise", slices);
  MemoryVolume pipe({kSide, kSide, slices}, samples);
  MemorySink plain, held;
  const RunControl high{.threads = 2, .head_start = 100};
  const MeshReport expected = mesh_volume(pipe, plain, options_of(3000), high);
  const auto in_memory = volume_in_memory(pipe.info(), std::as_bytes(std::span(samples)));
  expect_same_run(mesh_volume(*in_memory, held, options_of(3000), high), expected);
  EXPECT_EQ(held.mesh.triangles.size(), expected.triangles);
  EXPECT_EQ(digest_text(check_mesh(held.mesh).digest), digest_text(expected.digest));
}

TEST(HeadStartRuns, AreLengths) {
  const auto volume = generate_volume({"noise", {8, 8, 8}});
  for (const double length : {-1.0, std::nan(""), kNoLimit}) {
    RunControl control{.head_start = length};
    control.reopen = [] { return generate_volume({"noise", {8, 8, 8}}); };
    MemorySink sink;
    EXPECT_THROW(mesh_volume(*volume, sink, options_of(10), control), std::invalid_argument);
  }
}

}  // namespace
}  // namespace isoweave::testing::head_starts_test
