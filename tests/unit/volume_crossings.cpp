// Crossings for all iso-values at once, beside runs at each of them.
// Threads: none, one pass in the calling thread
#include <gtest/gtest.h>

#include <random>

#include "isoweave/histogram.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave::testing::volume_crossings_test {
namespace {

template <class T>
struct RandomVolume {
  VolumeInfo info;
  std::vector<T> samples;

  RandomVolume(SampleType type, const std::array<std::int64_t, 3>& dims, const std::function<T(std::mt19937&)>& make) {
    info.path = "random";
    info.dims = dims;
    info.type = type;
    std::mt19937 random(5);
    samples.resize(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
    for (T& sample : samples) sample = make(random);
  }

  std::unique_ptr<SliceSource> open() const { return volume_in_memory(info, std::as_bytes(std::span(samples))); }

  std::uint64_t vertices_at(double iso, bool closed, bool above) const {
    MeshOptions options;
    options.iso = iso;
    options.closed = closed;
    options.inside_above = above;
    options.error = Length::units(0);
    RunControl control;
    control.threads = 1;
    MeshInMemory mesh;
    return mesh_volume(*open(), mesh, options, control).vertices_extracted;
  }

  void expect_all(std::size_t step = 1) const {
    for (const bool closed : {true, false}) {
      for (const bool above : {true, false}) {
        const CrossingCounts counts = count_crossings(*open(), closed, above);
        ASSERT_GT(counts.counts.size(), 3U);
        for (std::size_t n = 0; n < counts.counts.size(); n += step) {
          const double iso = counts.first + counts.step * static_cast<double>(n);
          EXPECT_EQ(counts.counts[n], vertices_at(iso, closed, above)) << iso << closed << above;
        }
        EXPECT_EQ(counts.histogram.bins, read_histogram(*open()).bins);
      }
    }
  }
};

TEST(Crossings, AreThoseOfRunsForIntegers) {
  RandomVolume<std::uint8_t>(SampleType::kUint8, {9, 7, 6}, [](auto& random) {
    return static_cast<std::uint8_t>(random() % 2 == 0 ? random() : 100 + random() % 9);
  }).expect_all(7);
  RandomVolume<std::int8_t>(SampleType::kInt8, {1, 7, 6}, [](auto& random) {
    return static_cast<std::int8_t>(random());
  }).expect_all(5);
  RandomVolume<std::uint16_t>(SampleType::kUint16, {5, 1, 6}, [](auto& random) {
    return static_cast<std::uint16_t>(random());
  }).expect_all(911);
  RandomVolume<std::int16_t>(SampleType::kInt16, {5, 6, 1}, [](auto& random) {
    return static_cast<std::int16_t>(random() % 70 - 30);
  }).expect_all();
  RandomVolume<std::int32_t>(SampleType::kInt32, {5, 6, 3}, [](auto& random) {
    return static_cast<std::int32_t>(random());
  }).expect_all(9);
}

TEST(Crossings, AreThoseOfRunsForFloats) {
  const auto make = [](auto& random) {
    const float special[] = {std::nanf(""), std::numeric_limits<float>::infinity(),
                             -std::numeric_limits<float>::infinity(), 0.5F};
    return random() % 6 == 0 ? special[random() % 4] : static_cast<float>(random() % 4096) / 1024 - 2;
  };
  RandomVolume<float>(SampleType::kFloat32, {7, 6, 5}, make).expect_all(11);
  RandomVolume<double>(SampleType::kFloat64, {7, 6, 5}, [&](auto& random) {
    return random() % 20 == 0 ? 1e308 : static_cast<double>(make(random));
  }).expect_all(13);
}

TEST(Crossings, AScalingTurnsThem) {
  RandomVolume<std::uint8_t> volume(SampleType::kUint8, {6, 5, 4},
                                    [](auto& random) { return static_cast<std::uint8_t>(random() % 40); });
  volume.info.slope = -0.5;
  volume.info.intercept = 3;
  volume.expect_all();
}

TEST(Crossings, ValuesWithoutABoundBetweenThemHaveNone) {
  RandomVolume<double> volume(SampleType::kFloat64, {3, 3, 3},
                              [](auto& random) { return random() % 2 == 0 ? 1.0 : std::nextafter(1.0, 2.0); });
  EXPECT_LE(count_crossings(*volume.open()).counts.size(), 1U);
}

TEST(Crossings, OneValueHasNone) {
  RandomVolume<std::uint8_t> volume(SampleType::kUint8, {3, 3, 3}, [](auto&) { return std::uint8_t{7}; });
  const CrossingCounts counts = count_crossings(*volume.open());
  EXPECT_TRUE(counts.counts.empty());
  EXPECT_EQ(counts.histogram.max, 7);
}

}  // namespace
}  // namespace isoweave::testing::volume_crossings_test
