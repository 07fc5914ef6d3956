// Label maps: where labels lie, and their masks.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "isoweave/error.hpp"
#include "label_maps.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::volume_labels_test {
namespace {

std::unique_ptr<LabelMap> small_map() {
  return std::make_unique<LabelMap>(std::array<std::int64_t, 3>{4, 2, 2}, Labels{0, 5, 5, 0, 0, 0, 0, 9,  //
                                                                                 0, 0, 5, 0, 0, 0, 0, 9});
}

TEST(LabelExtents, AreTheSmallestBoxes) {
  const std::vector<LabelExtent> all = find_labels(*small_map());
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].label, 5);
  EXPECT_EQ(all[0].samples, 3U);
  EXPECT_EQ(all[0].box.first, (std::array<std::int64_t, 3>{1, 0, 0}));
  EXPECT_EQ(all[0].box.end, (std::array<std::int64_t, 3>{3, 1, 2}));
  EXPECT_EQ(all[1].label, 9);
  EXPECT_EQ(all[1].box.first, (std::array<std::int64_t, 3>{3, 1, 0}));
  EXPECT_EQ(all[1].box.end, (std::array<std::int64_t, 3>{4, 2, 2}));
}

TEST(LabelExtents, ComeInTheOrderAskedFor) {
  const std::vector<Label> wanted{9, 0, -4, 5};
  const std::vector<LabelExtent> found = find_labels(*small_map(), wanted);
  ASSERT_EQ(found.size(), 4U);
  EXPECT_EQ(found[0].label, 9);
  EXPECT_EQ(found[1].samples, 11U);
  EXPECT_EQ(found[2].label, -4);
  EXPECT_EQ(found[2].samples, 0U);
  EXPECT_EQ(found[3].samples, 3U);
}

TEST(LabelExtents, TooManyAreCounted) {
  Labels labels(8192);
  std::iota(labels.begin(), labels.end(), std::uint16_t{0});
  LabelMap map({64, 64, 2}, labels);
  try {
    find_labels(map);
    FAIL() << "expected BadInput";
  } catch (const BadInput& error) {
    EXPECT_STREQ(error.what(), "labels: expected a label map of at most 4096 labels, found 8191");
  }
  const std::vector<Label> wanted{8000};
  LabelMap again({64, 64, 2}, labels);
  EXPECT_EQ(find_labels(again, wanted)[0].samples, 1U);
}

TEST(LabelExtents, StopWhenAsked) {
  const std::atomic<bool> stop = true;
  EXPECT_THROW(find_labels(*small_map(), {}, &stop), Interrupted);
}

TEST(LabelVolume, IsTheMaskOfOneLabel) {
  const auto mask = label_volume(small_map(), 5);
  EXPECT_EQ(mask->info().type, SampleType::kUint8);
  std::vector<std::uint8_t> samples(16);
  mask->read(0, 2, std::as_writable_bytes(std::span(samples)));
  EXPECT_EQ(samples, (std::vector<std::uint8_t>{0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}));
}

// Not even as the number that it is cut to.
TEST(LabelVolume, HoldsNothingWhereTheTypeCannotHoldTheLabel) {
  for (const std::int64_t label : {std::int64_t{5 + 65536}, std::int64_t{5 - 65536}}) {
    const auto mask = label_volume(small_map(), label);
    std::vector<std::uint8_t> samples(16);
    mask->read(0, 2, std::as_writable_bytes(std::span(samples)));
    EXPECT_EQ(std::accumulate(samples.begin(), samples.end(), 0), 0);
  }
}

template <class T>
VolumeInfo row_of(const std::vector<T>& samples, SampleType type) {
  VolumeInfo info;
  info.path = "map";
  info.type = type;
  info.dims = {static_cast<std::int64_t>(samples.size()), 1, 1};
  return info;
}

template <class T>
std::vector<LabelExtent> labels_in(const std::vector<T>& samples, SampleType type, double slope = 1,
                                   double intercept = 0, std::span<const Label> wanted = {}) {
  VolumeInfo info = row_of(samples, type);
  info.slope = slope;
  info.intercept = intercept;
  return find_labels(*volume_in_memory(info, std::as_bytes(std::span(samples))), wanted);
}

std::string texts(const std::vector<LabelExtent>& labels) {
  std::string text;
  for (const LabelExtent& extent : labels) text += extent.label.text() + "*" + std::to_string(extent.samples) + " ";
  return text;
}

template <class T>
std::string refusal_of_labels(const std::vector<T>& samples, SampleType type, double slope = 1, double intercept = 0) {
  try {
    labels_in(samples, type, slope, intercept);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "read";
}

TEST(LabelTypes, NumbersOf64BitsAreWhatTheyAre) {
  const std::uint64_t most = ~std::uint64_t{0}, odd = (std::uint64_t{1} << 53) + 1;
  const std::vector<std::uint64_t> ids{0, 7112614941, odd, odd - 1, odd, most, most};
  EXPECT_EQ(texts(labels_in(ids, SampleType::kUint64)),
            "7112614941*1 9007199254740992*1 9007199254740993*2 18446744073709551615*2 ");
  const std::vector<std::int64_t> below{-7112614941, 0, 3, -7112614941};
  EXPECT_EQ(texts(labels_in(below, SampleType::kInt64)), "-7112614941*2 3*1 ");
  // The same bits, but another number.
  const std::vector<Label> wanted{-1, most, 7112614941};
  EXPECT_EQ(texts(labels_in(ids, SampleType::kUint64, 1, 0, wanted)), "-1*0 18446744073709551615*2 7112614941*1 ");
  EXPECT_EQ(texts(labels_in(std::vector<std::int64_t>{-1, 5}, SampleType::kInt64, 1, 0, wanted)),
            "-1*1 18446744073709551615*0 7112614941*0 ");
  EXPECT_EQ(texts(labels_in(std::vector<std::uint8_t>{255, 5}, SampleType::kUint8, 1, 0, wanted)),
            "-1*0 18446744073709551615*0 7112614941*0 ");
}

TEST(LabelTypes, WholeNumbersInFloatsAreLabels) {
  EXPECT_EQ(texts(labels_in(std::vector<float>{0, 1, 1, -0.0F, -4, 2035}, SampleType::kFloat32)), "-4*1 1*2 2035*1 ");
  EXPECT_EQ(texts(labels_in(std::vector<double>{7112614941, 0x1p53, 0}, SampleType::kFloat64)),
            "7112614941*1 9007199254740992*1 ");
  EXPECT_EQ(refusal_of_labels(std::vector<float>{0, 1, 1.5F, 0.25F}, SampleType::kFloat32),
            "map: expected whole numbers as labels, found 1.5 in sample 2,0,0");
  EXPECT_EQ(refusal_of_labels(std::vector<double>{0, std::nan("")}, SampleType::kFloat64),
            "map: expected whole numbers as labels, found nan in sample 1,0,0");
  EXPECT_EQ(refusal_of_labels(std::vector<double>{-HUGE_VAL}, SampleType::kFloat64),
            "map: expected whole numbers as labels, found -inf in sample 0,0,0");
  EXPECT_EQ(refusal_of_labels(std::vector<double>{0x1p53 + 2}, SampleType::kFloat64),
            "map: expected labels of at most 2^53 in a map of floats, found 9007199254740994 in sample 0,0,0");
}

std::string refusal_in(SliceSource& map) {
  try {
    find_labels(map);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "read";
}

using Samples = std::array<float, std::size_t{8} * 6 * 5>;

constexpr Samples one_half() {
  Samples samples{};
  samples[(4 * 6 + 3) * 8 + 5] = 0.5F;
  return samples;
}

constexpr Samples all_halves() {
  Samples samples{};
  samples.fill(0.5F);
  return samples;
}

// A map of 8 x 6 x 5 samples, of which sample 5,3,4 is a half, and the others are zeros or halves, too.
std::unique_ptr<SliceSource> map_with_a_half(bool others = false) {
  static constexpr Samples one = one_half(), all = all_halves();
  VolumeInfo info;
  info.path = "map";
  info.type = SampleType::kFloat32;
  info.dims = {8, 6, 5};
  return volume_in_memory(info, std::as_bytes(std::span(others ? all : one)));
}

TEST(LabelTypes, PlacesAreThoseInTheFile) {
  const std::string expected = "map: expected whole numbers as labels, found 0.5 in ";
  EXPECT_EQ(refusal_in(*map_with_a_half()), expected + "sample 5,3,4");
  const auto part = [] { return crop_volume(map_with_a_half(), {{2, 1, 3}, {8, 6, 5}}); };
  EXPECT_EQ(refusal_in(*part()), expected + "sample 5,3,4");
  EXPECT_EQ(refusal_in(*crop_volume(part(), {{1, 2, 0}, {5, 4, 2}})), expected + "sample 5,3,4");
  // The most frequent of a block, which is cut off at the ends of the part.
  const auto smaller = [](const Region& box) { return thin_label_map(crop_volume(map_with_a_half(true), box), 4); };
  EXPECT_EQ(refusal_in(*smaller({{1, 3, 4}, {6, 6, 5}})), expected + "samples 1:5,3:6,4:5");
  EXPECT_EQ(refusal_in(*smaller({{5, 3, 4}, {6, 4, 5}})), expected + "sample 5,3,4");
}

TEST(LabelTypes, PlacesInBlocksAreThoseInTheFile) {
  try {
    find_labels_in_blocks([] { return crop_volume(map_with_a_half(), {{2, 1, 3}, {8, 6, 5}}); }, 2);
    FAIL() << "expected BadInput";
  } catch (const BadInput& error) {
    EXPECT_STREQ(error.what(), "map: expected whole numbers as labels, found 0.5 in sample 5,3,4");
  }
}

TEST(LabelTypes, ScalingsByWholeNumbersAreApplied) {
  EXPECT_EQ(texts(labels_in(std::vector<std::uint8_t>{0, 1, 200}, SampleType::kUint8, 2, -1)), "-1*1 1*1 399*1 ");
  EXPECT_EQ(texts(labels_in(std::vector<float>{0, 1.5F}, SampleType::kFloat32, 2, 0)), "3*1 ");
  EXPECT_EQ(refusal_of_labels(std::vector<std::int16_t>{0, 1}, SampleType::kInt16, 0.25, -2),
            "map: expected labels without a scaling, or scaled by whole numbers, found slope 0.25 and intercept -2");
  EXPECT_EQ(refusal_of_labels(std::vector<std::uint64_t>{0, ~std::uint64_t{0}}, SampleType::kUint64, 1, 1),
            "map: expected scaled labels of less than 2^63, found 18446744073709551615 before scaling in sample 1,0,0");
}

TEST(LabelTypes, MasksAreOfTheSameNumbers) {
  const auto mask_of = [](const auto& samples, SampleType type, Label label) {
    const auto mask = label_volume(volume_in_memory(row_of(samples, type), std::as_bytes(std::span(samples))), label);
    EXPECT_EQ(mask->info().slope, 1);
    std::vector<std::uint8_t> found(samples.size());
    mask->read(0, 1, std::as_writable_bytes(std::span(found)));
    return found;
  };
  const std::vector<std::uint64_t> ids{std::uint64_t{1} << 32, 0, (std::uint64_t{1} << 32) + 7, ~std::uint64_t{0}};
  EXPECT_EQ(mask_of(ids, SampleType::kUint64, ids[2]), (std::vector<std::uint8_t>{0, 0, 1, 0}));
  EXPECT_EQ(mask_of(ids, SampleType::kUint64, -1), (std::vector<std::uint8_t>{0, 0, 0, 0}));
  EXPECT_EQ(mask_of(ids, SampleType::kUint64, ids[3]), (std::vector<std::uint8_t>{0, 0, 0, 1}));
  EXPECT_EQ(mask_of(std::vector<float>{2, 0, 3}, SampleType::kFloat32, 3), (std::vector<std::uint8_t>{0, 0, 1}));
  EXPECT_THROW(mask_of(std::vector<float>{2, 0.5F, 3}, SampleType::kFloat32, 3), BadInput);
}

// A grey image by the formula of a gyroid, and blocks of labels.
TEST(ScatteredLabels, AreThoseOfGreyImages) {
  GenerateOptions options;
  options.kind = "noise";
  options.dims = {48, 40, 32};
  options.type = SampleType::kUint8;
  const std::vector<LabelExtent> grey = find_labels(*generate_volume(options));
  EXPECT_GT(grey.size(), 200U);
  EXPECT_GT(10 * count_scattered(grey), 9 * grey.size());
  const std::array<std::int64_t, 3> dims{48, 40, 32};
  Labels blocks, single;
  for (std::int64_t n = 0; n < 48 * 40 * 32; ++n) {
    const std::int64_t i = n % 48, j = n / 48 % 40, k = n / (48 * 40);
    blocks.push_back(static_cast<std::uint16_t>(1 + i / 4 + 12 * (j / 4) + 120 * (k / 4)));
    single.push_back(static_cast<std::uint16_t>(n % 17 == 0 && n < 17 * 4000 ? 1 + n / 17 : 0));
  }
  const std::vector<LabelExtent> atlas = find_labels(*std::make_unique<LabelMap>(dims, blocks));
  EXPECT_EQ(atlas.size(), 960U);
  EXPECT_EQ(atlas[0].runs, 16U);
  EXPECT_EQ(count_scattered(atlas), 0U);
  EXPECT_EQ(count_scattered(find_labels(*std::make_unique<LabelMap>(dims, single))), 0U);
  EXPECT_TRUE(looks_like_label_map(std::make_unique<LabelMap>(dims, blocks)));
  EXPECT_FALSE(looks_like_label_map(generate_volume(options)));
}

TEST(LabelMaps, AreToldByTheirValues) {
  const auto looks = [](const std::vector<float>& samples) {
    return looks_like_label_map(
        volume_in_memory(row_of(samples, SampleType::kFloat32), std::as_bytes(std::span(samples))));
  };
  EXPECT_TRUE(looks({0, 1, 1, 0})) << "a mask in floats";
  EXPECT_FALSE(looks({0, 0.5F, 1, 0}));
  EXPECT_FALSE(looks({0, -1, 1, 0}));
  EXPECT_FALSE(looks({0, 0, 0})) << "background alone";
}

}  // namespace
}  // namespace isoweave::testing::volume_labels_test
