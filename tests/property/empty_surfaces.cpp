// Surfaces that mislead: those without triangles, and those that are the border of the volume and nothing else.
// Threads: none, the loop is that of other tests
#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace isoweave::testing::empty_surfaces_test {
namespace {

// Samples from 0 to 7 along x.
MemoryVolume ramp() {
  std::vector<float> samples;
  for (int n = 0; n < 8 * 8 * 8; ++n) samples.push_back(static_cast<float>(n % 8));
  return {{8, 8, 8}, samples};
}

MeshOptions at(double iso, bool closed = true, bool above = true) {
  MeshOptions options;
  options.iso = iso;
  options.closed = closed;
  options.inside_above = above;
  return options;
}

std::string refusal(const MeshOptions& options) {
  MemoryVolume volume = ramp();
  MemorySink sink;
  RunControl control;
  control.allow_empty = false;
  try {
    mesh_volume(volume, sink, options, control);
  } catch (const EmptySurface& empty) {
    EXPECT_FALSE(sink.finished) << "a sink that is finished has replaced its file";
    return empty.what();
  }
  EXPECT_TRUE(sink.finished);
  return "";
}

TEST(EmptySurface, IsRefusedWithTheRangeOfTheSamples) {
  EXPECT_EQ(refusal(at(300)), "memory: the surface is empty: the samples go from 0 to 7, iso is 300");
  EXPECT_EQ(refusal(at(-0.5, true, false)), "memory: the surface is empty: the samples go from 0 to 7, iso is -0.5");
  EXPECT_EQ(refusal(at(-1, false)), "memory: the surface is empty: the samples go from 0 to 7, iso is -1");
  EXPECT_EQ(refusal(at(3.5)), "");
}

TEST(EmptySurface, IsAResultWhereItIsAllowed) {
  MemoryVolume volume = ramp();
  MemorySink sink;
  const MeshReport report = mesh_volume(volume, sink, at(300));
  EXPECT_TRUE(sink.finished);
  EXPECT_EQ(report.warnings,
            std::vector<std::string>{"memory: the surface is empty: the samples go from 0 to 7, iso is 300"});
}

TEST(EmptySurface, OfNoNumbersSaysSoWhateverTheSlope) {
  for (const double slope : {1.0, -2.0}) {
    MemoryVolume volume({2, 2, 2}, std::vector<float>(8, std::nanf("")));
    volume.info().slope = slope;
    MemorySink sink;
    const MeshReport report = mesh_volume(volume, sink, at(1));
    ASSERT_EQ(report.warnings.size(), 2U);
    EXPECT_EQ(report.warnings[1], "memory: the surface is empty: no samples are numbers, iso is 1");
  }
}

TEST(EmptySurface, OfASimplifiedMeshIsRefusedToo) {
  RunControl control;
  control.allow_empty = false;
  MemorySink sink;
  SimplifyOptions options;
  options.error = Length::units(1);
  EXPECT_THROW(simplify_mesh(TriangleMesh{}, sink, options, control), EmptySurface);
  EXPECT_FALSE(sink.finished);
}

TEST(BorderSurface, IsWarnedOf) {
  const auto warnings = [](const MeshOptions& options) {
    MemoryVolume volume = ramp();
    MemorySink sink;
    return mesh_volume(volume, sink, options).warnings;
  };
  const std::string below =
      "memory: the surface is nothing but the border of the volume: the samples go from 0 to 7 and are all inside, iso "
      "is -40";
  EXPECT_EQ(warnings(at(-40)), std::vector<std::string>{below});
  EXPECT_EQ(warnings(at(0)).size(), 1U) << "inside is what is at the iso-value, too";
  EXPECT_EQ(warnings(at(7, true, false)).size(), 1U) << "inside is what is at the iso-value, too";
  EXPECT_EQ(warnings(at(0.5)).size(), 0U);
  EXPECT_EQ(warnings(at(6.5, true, false)).size(), 0U);
}

}  // namespace
}  // namespace isoweave::testing::empty_surfaces_test
