#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "volume/histogram_counter.hpp"

namespace isoweave::testing::volume_histogram_test {
namespace {

template <class T>
Histogram histogram_of(SampleType type, const std::vector<T>& samples, std::int64_t block = 1 << 20) {
  HistogramCounter counter(type);
  const auto count = static_cast<std::int64_t>(samples.size());
  for (std::int64_t first = 0; first < count; first += block) {
    counter.add(reinterpret_cast<const std::byte*>(samples.data() + first), std::min(block, count - first));
  }
  return counter.histogram(1, 0);
}

std::uint64_t sum(const Histogram& histogram) {
  return std::accumulate(histogram.bins.begin(), histogram.bins.end(), std::uint64_t{0});
}

TEST(Histogram, CountsEveryValueOfABytePlainly) {
  std::vector<std::uint8_t> samples;
  for (unsigned value = 0; value < 256; ++value)
    samples.insert(samples.end(), value + 1, static_cast<std::uint8_t>(value));
  const Histogram histogram = histogram_of(SampleType::kUint8, samples);
  EXPECT_EQ(histogram.min, 0);
  EXPECT_EQ(histogram.max, 255);
  for (std::size_t value = 0; value < 256; ++value) EXPECT_EQ(histogram.bins[value], value + 1);
}

// 2^64 - 1 and 2^53 + 1 are no doubles.
TEST(Histogram, EndsOf64BitsAreExact) {
  const std::vector<std::uint64_t> samples{(std::uint64_t{1} << 53) + 1, ~std::uint64_t{0}, std::uint64_t{1} << 60};
  const Histogram histogram = histogram_of(SampleType::kUint64, samples, 1);
  ASSERT_TRUE(histogram.whole);
  EXPECT_EQ((*histogram.whole)[0].text(), "9007199254740993");
  EXPECT_EQ((*histogram.whole)[1].text(), "18446744073709551615");
  EXPECT_EQ(std::accumulate(histogram.bins.begin(), histogram.bins.end(), std::uint64_t{0}), 3U);
  const std::vector<std::int64_t> negative{-5, std::numeric_limits<std::int64_t>::lowest()};
  EXPECT_EQ((*histogram_of(SampleType::kInt64, negative).whole)[0].text(), "-9223372036854775808");
  EXPECT_FALSE(histogram_of(SampleType::kInt32, std::vector<std::int32_t>{3}).whole);
  HistogramCounter scaled(SampleType::kInt64);
  scaled.add(reinterpret_cast<const std::byte*>(negative.data()), 1);
  EXPECT_FALSE(scaled.histogram(2, 0).whole);
}

TEST(Histogram, IsTheSameHoweverTheSamplesAreCut) {
  std::vector<float> samples;
  for (int n = 0; n < 5000; ++n) samples.push_back(std::ldexp(static_cast<float>((n * 7919) % 5003), (n % 40) - 20));
  const Histogram whole = histogram_of(SampleType::kFloat32, samples);
  EXPECT_EQ(sum(whole), samples.size());
  for (const std::int64_t block : {1, 3, 1000}) {
    EXPECT_EQ(histogram_of(SampleType::kFloat32, samples, block).bins, whole.bins) << block;
  }
}

TEST(Histogram, HoldsRangesThatGrowBothWays) {
  const std::vector<std::int32_t> samples{0, 5, -70000, 2000000000, -2000000000, 1};
  const Histogram histogram = histogram_of(SampleType::kInt32, samples, 1);
  EXPECT_EQ(histogram.min, -2e9);
  EXPECT_EQ(histogram.max, 2e9);
  EXPECT_EQ(sum(histogram), samples.size());
  EXPECT_EQ(histogram.bins.front(), 1U);
  EXPECT_EQ(histogram.bins.back(), 1U);
}

TEST(Histogram, HoldsTheWholeRangeOfDoublesAndTheSmallest) {
  constexpr double kMax = std::numeric_limits<double>::max();
  const std::vector<double> samples{0, std::numeric_limits<double>::denorm_min(), 1e-300, -1e-300, 1, kMax, -kMax};
  const Histogram histogram = histogram_of(SampleType::kFloat64, samples, 1);
  EXPECT_EQ(histogram.min, -kMax);
  EXPECT_EQ(histogram.max, kMax);
  EXPECT_EQ(sum(histogram), samples.size());
  ASSERT_TRUE(otsu_threshold(histogram));
  EXPECT_TRUE(std::isfinite(*otsu_threshold(histogram)));
}

TEST(Histogram, CountsNanAndInfinitiesApart) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<float> samples{std::nanf(""), kInfinity, -kInfinity, 3, 4};
  const Histogram histogram = histogram_of(SampleType::kFloat32, samples);
  EXPECT_EQ(histogram.nan, 1U);
  EXPECT_EQ(histogram.infinite, 2U);
  EXPECT_EQ(histogram.min, 3);
  EXPECT_EQ(histogram.max, 4);
  EXPECT_TRUE(histogram_of(SampleType::kFloat32, std::vector<float>{std::nanf("")}).empty());
}

TEST(Histogram, IsInValues) {
  const std::vector<std::int16_t> samples{-10, 0, 0, 0, 10};
  HistogramCounter counter(SampleType::kInt16);
  counter.add(reinterpret_cast<const std::byte*>(samples.data()), 5);
  const Histogram histogram = counter.histogram(-2, 100);
  EXPECT_EQ(histogram.min, 80);
  EXPECT_EQ(histogram.max, 120);
  EXPECT_EQ(coarser_bins(histogram, 2), (std::vector<std::uint64_t>{1, 4}));
  EXPECT_THROW(coarser_bins(histogram, 3), std::invalid_argument);
}

TEST(Otsu, LiesInTheMiddleBetweenTwoValues) {
  EXPECT_NEAR(*otsu_threshold(histogram_of(SampleType::kUint8, std::vector<std::uint8_t>{0, 0, 200, 200})), 100, 0.5);
  EXPECT_NEAR(*otsu_threshold(histogram_of(SampleType::kFloat32, std::vector<float>{-1, -1, 1})), 0, 0.01);
}

// The variance between classes, by its definition.
double variance_between(const std::vector<double>& samples, const std::vector<double>& thresholds) {
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  double variance = 0;
  for (std::size_t n = 0; n <= thresholds.size(); ++n) {
    const double low = n == 0 ? -1e9 : thresholds[n - 1];
    const double high = n == thresholds.size() ? 1e9 : thresholds[n];
    double sum = 0, count = 0;
    for (const double sample : samples) {
      if (sample < low || sample >= high) continue;
      sum += sample;
      ++count;
    }
    if (count > 0) variance += count * (sum / count - mean) * (sum / count - mean);
  }
  return variance;
}

TEST(Otsu, SeveralThresholdsAreTheBestOfAll) {
  std::vector<std::uint8_t> bytes{0, 255};
  std::vector<double> samples{0, 255};
  for (unsigned n = 0; n < 300; ++n) {
    const unsigned value = n % 3 == 0 ? 20 + n * 7 % 31 : n % 3 == 1 ? 90 + n * 11 % 47 : 180 + n * 13 % 61;
    bytes.push_back(static_cast<std::uint8_t>(value));
    samples.push_back(value);
  }
  const Histogram histogram = histogram_of(SampleType::kUint8, bytes);
  double best = 0;
  for (int a = 1; a < 255; ++a) {
    for (int b = a + 1; b < 256; ++b) {
      best = std::max(best, variance_between(samples, {static_cast<double>(a), static_cast<double>(b)}));
    }
  }
  const std::vector<double> found = otsu_thresholds(histogram, 3);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR(variance_between(samples, found), best, 1e-9 * best);
  const std::vector<double> two = otsu_thresholds(histogram, 2);
  ASSERT_EQ(two.size(), 1U);
  EXPECT_NEAR(variance_between(samples, two), variance_between(samples, {*otsu_threshold(histogram)}), 1e-9 * best);
}

TEST(Otsu, HasAsManyThresholdsAsThereAreValuesToPart) {
  const auto count = [](const std::vector<std::uint8_t>& samples) {
    return otsu_thresholds(histogram_of(SampleType::kUint8, samples), 4).size();
  };
  EXPECT_EQ(count({5, 5}), 0U);
  EXPECT_EQ(count({5, 9}), 1U);
  EXPECT_EQ(count({5, 9, 200}), 2U);
  EXPECT_EQ(count({5, 9, 200, 220, 240}), 3U);
  EXPECT_TRUE(otsu_thresholds(Histogram{}, 3).empty());
  EXPECT_THROW(otsu_thresholds(Histogram{}, 1), std::invalid_argument);
}

TEST(Hounsfield, IsARangeFromAirToBone) {
  EXPECT_TRUE(is_hounsfield_range(-1024, 3071));
  EXPECT_TRUE(is_hounsfield_range(-3024, 1500));
  EXPECT_FALSE(is_hounsfield_range(0, 4095));
  EXPECT_FALSE(is_hounsfield_range(-1, 1));
  EXPECT_TRUE(is_hounsfield_range(-32768, 32767));
  EXPECT_FALSE(is_hounsfield_range(-1e308, 1e308));
  EXPECT_FALSE(is_hounsfield_range(-1024, 50));
}

// An iso-value at the lower one would have all samples inside.
TEST(Otsu, LiesAboveTheLowerOfTwoNeighbouringNumbers) {
  for (const double low : {1.0, 0.0, -1.0}) {
    const double high = std::nextafter(low, 2);
    const Histogram histogram = histogram_of(SampleType::kFloat64, std::vector<double>{low, high, low});
    EXPECT_EQ(otsu_threshold(histogram), high);
    for (const double threshold : otsu_thresholds(histogram, 2)) EXPECT_EQ(threshold, high);
  }
}

TEST(Otsu, SaysNothingAboutOneValue) {
  EXPECT_FALSE(otsu_threshold(histogram_of(SampleType::kUint8, std::vector<std::uint8_t>{7, 7, 7})));
  EXPECT_FALSE(otsu_threshold(Histogram{}));
}

}  // namespace
}  // namespace isoweave::testing::volume_histogram_test
