// Parts of volumes, and volumes made smaller: samples, places, errors.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "files.hpp"
#include "isoweave/volume.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::volume_part_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Sample n is n, on axes that are turned: index axis 0 is the world's y.
std::unique_ptr<MemoryVolume> numbered(std::array<std::int64_t, 3> dims) {
  std::vector<float> samples(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]));
  std::iota(samples.begin(), samples.end(), 0.0F);
  auto volume = std::make_unique<MemoryVolume>(dims, std::move(samples));
  volume->info().geometry.spacing = {0.5, 2, 3};
  volume->info().geometry.origin = {10, 20, 30};
  volume->info().geometry.direction = {0, 1, 0, 1, 0, 0, 0, 0, 1};
  return volume;
}

template <class T = float>
std::vector<T> samples_of(SliceSource& volume, std::int64_t at_a_time) {
  const VolumeInfo& info = volume.info();
  std::vector<T> samples(static_cast<std::size_t>(info.slice_samples() * info.dims[2]));
  const auto bytes = std::as_writable_bytes(std::span(samples));
  for (std::int64_t k = 0; k < info.dims[2]; k += at_a_time) {
    const std::int64_t count = std::min(at_a_time, info.dims[2] - k);
    volume.read(k, count, bytes.subspan(static_cast<std::size_t>(k) * info.slice_bytes()));
  }
  return samples;
}

TEST(CroppedVolume, IsWhereItWas) {
  const auto part = crop_volume(numbered({4, 3, 5}), {{1, 0, 2}, {3, 2, 5}});
  EXPECT_EQ(part->info().dims, (std::array<std::int64_t, 3>{2, 2, 3}));
  EXPECT_EQ(part->info().geometry.origin, (std::array<double, 3>{10, 20.5, 36}));
  EXPECT_EQ(part->info().geometry.spacing, (std::array<double, 3>{0.5, 2, 3}));
  EXPECT_EQ(samples_of(*part, 2), (std::vector<float>{25, 26, 29, 30, 37, 38, 41, 42, 49, 50, 53, 54}));
}

TEST(CroppedVolume, SlicesThatAreSkippedAreSkippedInTheWhole) {
  const auto part = crop_volume(numbered({4, 3, 5}), {{0, 0, 1}, {4, 1, 5}});
  std::vector<float> row(4);
  part->read(2, 1, std::as_writable_bytes(std::span(row)));
  EXPECT_EQ(row, (std::vector<float>{36, 37, 38, 39}));
}

// Rows of 20,000 samples, of which parts are read: from a file in either byte order, from memory, and a part of a part.
TEST(CroppedVolume, PartsOfLongRowsAreThoseOfTheWhole) {
  constexpr std::int64_t kLong = 20'000;
  const files::Folder folder;
  std::vector<std::uint16_t> samples(static_cast<std::size_t>(kLong * 3 * 4));
  for (std::size_t n = 0; n < samples.size(); ++n) samples[n] = static_cast<std::uint16_t>(n * 7919);
  const std::string bytes(reinterpret_cast<const char*>(samples.data()), 2 * samples.size());
  std::string turned = bytes;
  for (std::size_t n = 0; n < turned.size(); n += 2) std::swap(turned[n], turned[n + 1]);
  files::write_bytes(folder / "little.raw", bytes);
  files::write_bytes(folder / "big.raw", turned);
  const auto open = [&](bool big) {
    OpenOptions options;
    options.raw = RawLayout{{kLong, 3, 4}, SampleType::kUint16, big};
    return open_volume(folder / (big ? "big.raw" : "little.raw"), options);
  };
  EXPECT_TRUE(open(false)->reads_parts_of_rows());
  const Region region{{12'345, 1, 1}, {12'745, 3, 4}};
  std::vector<std::uint16_t> expected;
  for (std::int64_t k = 1; k < 4; ++k) {
    for (std::int64_t j = 1; j < 3; ++j) {
      const auto row = samples.begin() + (k * 3 + j) * kLong;
      expected.insert(expected.end(), row + 12'345, row + 12'745);
    }
  }
  EXPECT_EQ(samples_of<std::uint16_t>(*crop_volume(open(false), region), 2), expected);
  EXPECT_EQ(samples_of<std::uint16_t>(*crop_volume(open(true), region), 3), expected);
  auto part = crop_volume(open(true), {{12'000, 0, 1}, {kLong, 3, 4}});
  EXPECT_EQ(samples_of<std::uint16_t>(*crop_volume(std::move(part), {{345, 1, 0}, {745, 3, 3}}), 1), expected);
  const auto info = open(false)->info();
  auto held = volume_in_memory(info, std::as_bytes(std::span(samples)));
  EXPECT_EQ(samples_of<std::uint16_t>(*crop_volume(std::move(held), region), 2), expected);
}

TEST(CroppedVolume, ARegionOutsideIsRefused) {
  const std::vector<Region> wrong{
      {{0, 0, 0}, {5, 3, 5}}, {{-1, 0, 0}, {4, 3, 5}}, {{0, 2, 0}, {4, 2, 5}}, {{0, 0, 4}, {4, 3, 3}}};
  for (const Region& region : wrong) EXPECT_THROW(crop_volume(numbered({4, 3, 5}), region), std::invalid_argument);
  const auto part = crop_volume(numbered({4, 3, 5}), {{0, 0, 0}, {4, 3, 2}});
  std::vector<std::byte> bytes(3 * part->info().slice_bytes());
  EXPECT_THROW(part->read(1, 2, bytes), std::invalid_argument);
}

TEST(SmallerVolume, SamplesAreMeansInTheMiddleOfTheirBlocks) {
  const auto smaller = downsample_volume(numbered({4, 3, 3}), 2);
  EXPECT_EQ(smaller->info().dims, (std::array<std::int64_t, 3>{2, 2, 2}));
  EXPECT_EQ(smaller->info().geometry.spacing, (std::array<double, 3>{1, 4, 6}));
  EXPECT_EQ(smaller->info().geometry.origin, (std::array<double, 3>{11, 20.25, 31.5}));
  // Blocks of 2 x 2 x 2, of 2 x 1 x 2 at the upper end of the second axis, and so on.
  EXPECT_EQ(samples_of(*smaller, 1), (std::vector<float>{8.5F, 10.5F, 14.5F, 16.5F, 26.5F, 28.5F, 32.5F, 34.5F}));
}

TEST(SmallerVolume, AStepOfOneChangesNothingButTheType) {
  const auto same = downsample_volume(numbered({3, 2, 2}), 1);
  EXPECT_EQ(same->info().geometry.origin, (std::array<double, 3>{10, 20, 30}));
  EXPECT_EQ(samples_of(*same, 2), samples_of(*numbered({3, 2, 2}), 2));
}

TEST(SmallerVolume, NaNDoesNotCount) {
  auto volume = std::make_unique<MemoryVolume>(std::array<std::int64_t, 3>{4, 2, 1},
                                               std::vector<float>{1, kNaN, kNaN, kNaN, 3, 5, kNaN, kNaN});
  const std::vector<float> means = samples_of(*downsample_volume(std::move(volume), 2), 1);
  EXPECT_EQ(means[0], 3);
  EXPECT_TRUE(std::isnan(means[1]));
}

TEST(SmallerVolume, MeansAreNotRounded) {
  for (const SampleType type : {SampleType::kUint8, SampleType::kInt16, SampleType::kUint32, SampleType::kFloat64}) {
    GenerateOptions options;
    options.kind = "smooth";
    options.dims = {8, 8, 8};
    options.type = type;
    const auto smaller = downsample_volume(generate_volume(options), 4);
    const bool wide = type == SampleType::kUint32 || type == SampleType::kFloat64;
    EXPECT_EQ(smaller->info().type, wide ? SampleType::kFloat64 : SampleType::kFloat32);
    bool between = false;
    const auto look = [&](double mean) { between = between || mean != std::floor(mean); };
    if (wide) {
      for (const double mean : samples_of<double>(*smaller, 1)) look(mean);
    } else {
      for (const float mean : samples_of<float>(*smaller, 1)) look(mean);
    }
    EXPECT_TRUE(between);
  }
  EXPECT_THROW(downsample_volume(numbered({3, 2, 2}), 0), std::invalid_argument);
}

std::vector<std::uint16_t> thinned(const std::array<std::int64_t, 3>& dims, std::vector<std::uint16_t> samples,
                                   std::int64_t step, std::int64_t slices) {
  VolumeInfo info;
  info.dims = dims;
  info.type = SampleType::kUint16;
  const auto smaller = thin_label_map(volume_in_memory(info, std::as_bytes(std::span(samples))), step);
  return samples_of<std::uint16_t>(*smaller, slices);
}

TEST(ThinnedLabels, AreTheMostFrequentOfEachBlock) {
  // Two blocks of 2 x 2 x 2: 7 four times and 300 three times; 9 three times and 2 twice.
  EXPECT_EQ(thinned({4, 2, 2}, {7, 300, 1, 9, 7, 7, 2, 9, 300, 7, 2, 3, 300, 5, 4, 9}, 2, 1),
            (std::vector<std::uint16_t>{7, 9}));
  // Of several the first, whichever is less.
  EXPECT_EQ(thinned({4, 1, 1}, {8, 3, 3, 8}, 2, 1), (std::vector<std::uint16_t>{8, 3}));
  EXPECT_EQ(thinned({2, 2, 2}, {0, 6, 0, 6, 0, 6, 0, 6}, 2, 1), (std::vector<std::uint16_t>{0}));
  // Blocks that the upper ends cut off.
  EXPECT_EQ(thinned({3, 3, 3}, std::vector<std::uint16_t>(27, 4), 2, 2), (std::vector<std::uint16_t>(8, 4)));
  EXPECT_EQ(thinned({3, 1, 3}, {1, 1, 2, 1, 1, 2, 5, 6, 6}, 2, 1), (std::vector<std::uint16_t>{1, 2, 5, 6}));
  EXPECT_EQ(thinned({2, 1, 1}, {1, 2}, 5, 1), (std::vector<std::uint16_t>{1}));
}

TEST(ThinnedLabels, LieInTheMiddleOfTheirBlocks) {
  const auto map = [] { return numbered({4, 3, 3}); };
  const auto labels = thin_label_map(map(), 2);
  const auto means = downsample_volume(map(), 2);
  EXPECT_EQ(labels->info().dims, means->info().dims);
  EXPECT_EQ(labels->info().geometry.origin, means->info().geometry.origin);
  EXPECT_EQ(labels->info().geometry.spacing, means->info().geometry.spacing);
  EXPECT_EQ(labels->info().type, map()->info().type);
  EXPECT_THROW(thin_label_map(map(), 0), std::invalid_argument);
  std::vector<std::byte> bytes(3 * labels->info().slice_bytes());
  EXPECT_THROW(labels->read(1, 2, bytes), std::invalid_argument);
}

// The surface of a part lies on that of the whole.
TEST(CroppedVolume, GivesThePartOfTheSurface) {
  GenerateOptions volume;
  volume.kind = "gyroid";
  volume.dims = {24, 24, 24};
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  options.closed = false;
  options.error = Length::units(0);
  MemorySink whole, part;
  mesh_volume(*generate_volume(volume), whole, options);
  mesh_volume(*crop_volume(generate_volume(volume), {{5, 6, 7}, {20, 21, 22}}), part, options);
  EXPECT_GT(part.mesh.triangles.size(), 500u);
  EXPECT_LT(compare_meshes(part.mesh, whole.mesh).a_to_b.max, 1e-5);
}

}  // namespace
}  // namespace isoweave::testing::volume_part_test
