// Caps: how many of the crossed cells belong to them.
// Threads: none, the count is the caller's
#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace isoweave::testing::caps_test {
namespace {

constexpr std::array<std::int64_t, 3> kDims{13, 11, 9};

std::vector<float> noisy_samples() {
  std::vector<float> samples;
  for (int n = 0; n < 13 * 11 * 9; ++n) samples.push_back(static_cast<float>(n * 7919 % 101));
  samples[5] = std::nanf("");
  return samples;
}

MeshOptions at(double iso) {
  MeshOptions options;
  options.iso = iso;
  return options;
}

MeshReport report_of(const MeshOptions& options, const RunControl& control = {}) {
  MemoryVolume volume(kDims, noisy_samples());
  MemorySink sink;
  return mesh_volume(volume, sink, options, control);
}

// Looks at every sample, and at every face that it may lie in.
std::uint64_t count_in_faces(double iso, bool above) {
  const std::vector<float> samples = noisy_samples();
  std::uint64_t count = 0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const auto at = static_cast<std::int64_t>(n);
    const std::array<std::int64_t, 3> place{at % 13, at / 13 % 11, at / (13 * 11)};
    const double value = samples[n];
    if (above ? !(value >= iso) : !(value <= iso)) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (place[axis] == 0) ++count;
      if (place[axis] == kDims[axis] - 1) ++count;
    }
  }
  return count;
}

TEST(Caps, AreCountedAlikeForAnySlabAndExtractor) {
  for (const ExtractorKind extractor :
       {ExtractorKind::kCubes, ExtractorKind::kTrilinear, ExtractorKind::kTetrahedra, ExtractorKind::kDual}) {
    for (const std::int64_t slab : {1, 2, 5, 100}) {
      for (const bool above : {true, false}) {
        MeshOptions options = at(50);
        options.extractor = extractor;
        options.inside_above = above;
        RunControl control;
        control.slab = slab;
        EXPECT_EQ(report_of(options, control).cap_cells, count_in_faces(50, above)) << slab;
      }
    }
  }
}

TEST(Caps, AreAllThereIsWhereAllSamplesAreInside) {
  MemoryVolume volume({6, 5, 4}, std::vector<float>(120, 1));
  MemorySink sink;
  EXPECT_EQ(mesh_volume(volume, sink, at(0.5)).cap_cells, 2U * (6 * 5 + 5 * 4 + 4 * 6));
  MemoryVolume flat({3, 2, 1}, std::vector<float>(6, 1));
  MemorySink flat_sink;
  EXPECT_EQ(mesh_volume(flat, flat_sink, at(0.5)).cap_cells, 2U * (3 * 2 + 2 + 3));
}

TEST(Caps, AreNotCountedWhereThereAreNoneOrNothingIsMeasured) {
  MeshOptions options = at(50);
  options.closed = false;
  EXPECT_FALSE(report_of(options).cap_cells);
  RunControl control;
  control.measure = false;
  EXPECT_FALSE(report_of(at(50), control).cap_cells);
  EXPECT_EQ(report_of(at(500)).cap_cells, 0U);
}

}  // namespace
}  // namespace isoweave::testing::caps_test
