// Label maps: where labels lie, and their masks.
#include <gtest/gtest.h>

#include <numeric>

#include "isoweave/error.hpp"
#include "label_maps.hpp"
#include "surfaces.hpp"

namespace isoweave::testing {
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
  const std::vector<std::int64_t> wanted{9, 0, -4, 5};
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
  const std::vector<std::int64_t> wanted{8000};
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

TEST(LabelVolume, WantsPlainIntegers) {
  EXPECT_THROW(
      label_volume(std::make_unique<MemoryVolume>(std::array<std::int64_t, 3>{2, 2, 2}, std::vector<float>(8)), 1),
      BadInput);
  MemoryVolume floats({2, 2, 2}, std::vector<float>(8));
  EXPECT_THROW(find_labels(floats), BadInput);
  auto scaled = small_map();
  scaled->info().intercept = -1024;
  EXPECT_THROW(label_volume(std::move(scaled), 5), BadInput);
}

}  // namespace
}  // namespace isoweave::testing
