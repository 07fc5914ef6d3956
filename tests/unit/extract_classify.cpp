// Inside bits: the comparison in the samples' own type must equal the comparison of exact numbers. A long double holds
// every sample.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "extract/classify.hpp"
#include "volume/samples.hpp"

namespace isoweave::testing::extract_classify_test {
namespace {

template <class T>
void expect_bits(const std::vector<T>& row, const IsoRule& rule, const std::vector<std::uint64_t>& words) {
  for (std::size_t bit = 0; bit < 64 * words.size(); ++bit) {
    const bool sample = bit >= 1 && bit <= row.size();
    const long double value = sample ? static_cast<long double>(row[bit - 1]) : 0;
    const bool inside = sample && (rule.above ? value >= rule.iso : value <= rule.iso);
    ASSERT_EQ((words[bit / 64] >> (bit % 64) & 1) != 0, inside)
        << "bit " << bit << ", value " << value << ", iso " << rule.iso << ", above " << rule.above;
  }
}

// By every set, with one word more than is needed, too.
template <class T>
void expect_bits(const std::vector<T>& row, SampleType type, const IsoRule& rule) {
  for (const RowKernels* kernels : all_row_kernels()) {
    for (const std::size_t more : {0u, 1u}) {
      std::vector<std::uint64_t> words((row.size() + 2 + 63) / 64 + more, ~std::uint64_t{0});
      classify_row(reinterpret_cast<const std::byte*>(row.data()), type, static_cast<std::int64_t>(row.size()), rule,
                   words, *kernels);
      expect_bits(row, rule, words);
    }
  }
}

template <class T>
std::vector<T> edge_values(std::size_t size) {
  std::mt19937 random(1);
  std::vector<T> row(size);
  for (T& value : row) value = static_cast<T>(random() % 100);
  const std::vector<T> special{std::numeric_limits<T>::lowest(), std::numeric_limits<T>::max(), T{0}, T{1}, T{50}};
  for (std::size_t n = 0; n < std::min(row.size(), special.size()); ++n) row[n * 7 % row.size()] = special[n];
  return row;
}

template <class T>
void expect_all(SampleType type) {
  for (const std::size_t size : {1u, 2u, 61u, 62u, 63u, 64u, 65u, 126u, 127u, 128u, 190u, 200u}) {
    std::vector<T> row = edge_values<T>(size);
    if constexpr (std::numeric_limits<T>::has_infinity) {
      row[size / 2] = std::numeric_limits<T>::quiet_NaN();
      row[size / 3] = -std::numeric_limits<T>::infinity();
    }
    const double high = static_cast<double>(std::numeric_limits<T>::max());
    const double low = static_cast<double>(std::numeric_limits<T>::lowest());
    for (const double iso :
         {50.0, 49.5, 0.0, -0.25, 0.1, high, low, std::nextafter(high, 1e308), high / 2, 1e300, -1e300}) {
      for (const bool above : {true, false}) expect_bits(row, type, {iso, above, true});
    }
  }
}

TEST(Classify, EveryTypeComparesExactly) {
  expect_all<std::uint8_t>(SampleType::kUint8);
  expect_all<std::int8_t>(SampleType::kInt8);
  expect_all<std::uint16_t>(SampleType::kUint16);
  expect_all<std::int16_t>(SampleType::kInt16);
  expect_all<std::uint32_t>(SampleType::kUint32);
  expect_all<std::int32_t>(SampleType::kInt32);
  expect_all<std::uint64_t>(SampleType::kUint64);
  expect_all<std::int64_t>(SampleType::kInt64);
  expect_all<float>(SampleType::kFloat32);
  expect_all<double>(SampleType::kFloat64);
}

// Whole numbers beyond 2^53 are compared without rounding; the right answers are written out.
TEST(Classify, IntegersOf64BitsAreNotRounded) {
  const std::int64_t most = std::numeric_limits<std::int64_t>::max();
  const std::int64_t odd = (std::int64_t{1} << 53) + 1;  // as a double it is one less
  const std::vector<std::int64_t> row{odd - 1, odd, odd + 1, most, most - 1, -odd, -most - 1};
  const auto bits = [&](double iso, bool above) {
    std::vector<std::uint64_t> words(1);
    classify_row(reinterpret_cast<const std::byte*>(row.data()), SampleType::kInt64, 7, {iso, above, true}, words);
    return words[0] >> 1;
  };
  EXPECT_EQ(bits(0x1p53 + 2, true), 0b0011100U);
  EXPECT_EQ(bits(0x1p53, false), 0b1100001U);
  EXPECT_EQ(bits(0x1p63, true), 0U);
  EXPECT_EQ(bits(0x1p63, false), 0b1111111U);
  EXPECT_EQ(bits(-0x1p63, false), 0b1000000U);
  EXPECT_EQ(bits(-0x1p53 - 2, true), 0b0111111U);
  EXPECT_EQ(bits(-0x1p53, false), 0b1100000U);
  const std::vector<std::uint64_t> high{~std::uint64_t{0}, std::uint64_t{1} << 63, 0};
  std::vector<std::uint64_t> words(1);
  classify_row(reinterpret_cast<const std::byte*>(high.data()), SampleType::kUint64, 3, {0x1p63, true, true}, words);
  EXPECT_EQ(words[0] >> 1, 0b011U);
  classify_row(reinterpret_cast<const std::byte*>(high.data()), SampleType::kUint64, 3, {0x1p64, true, true}, words);
  EXPECT_EQ(words[0] >> 1, 0U);
}

TEST(SampleRange, IgnoresNanAndCountsIt) {
  std::vector<float> samples(100, 3.0F);
  samples[41] = -2;
  samples[97] = 9;
  samples[0] = samples[98] = std::nanf("");
  const SampleRange range = sample_range(reinterpret_cast<const std::byte*>(samples.data()), SampleType::kFloat32, 100);
  EXPECT_EQ(range.min, -2);
  EXPECT_EQ(range.max, 9);
  EXPECT_EQ(range.nan, 2u);
  const float nan = std::nanf("");
  EXPECT_TRUE(sample_range(reinterpret_cast<const std::byte*>(&nan), SampleType::kFloat32, 1).empty());
}

TEST(Crossing, StaysAwayFromTheLatticePoints) {
  EXPECT_EQ(crossing_parameter(0, 10, 5, false), 0.5);
  EXPECT_EQ(crossing_parameter(5, 10, 5, true), 1.0 / 256);
  EXPECT_EQ(crossing_parameter(0, 5, 5, false), 255.0 / 256);
  EXPECT_EQ(crossing_parameter(7, std::nan(""), 5, true), 1.0 / 256);
  EXPECT_EQ(crossing_parameter(std::nan(""), 7, 5, false), 255.0 / 256);
  EXPECT_EQ(crossing_parameter(7, -HUGE_VAL, 5, true), 1.0 / 256);
}

}  // namespace
}  // namespace isoweave::testing::extract_classify_test
