#include "volume/histogram_counter.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>

#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kFineBins = 65536;
constexpr int kNarrowest = -1000;  // its inverse is still a number
constexpr int kMantissaBits = 52;

template <class T>
bool is_finite_sample(T value) {
  if constexpr (std::is_floating_point_v<T>) return std::isfinite(value);
  return true;
}

template <class T>
bool is_nan(T value) {
  if constexpr (std::is_floating_point_v<T>) return std::isnan(value);
  return false;
}

// The number of the bin of width 2^exponent that holds a value. It is exact, as the width is a power of two.
double bin_of(double value, int exponent) { return std::floor(std::ldexp(value, -exponent)); }

// Whether bins of this width cover [low, high] with numbers that are exact in a double.
bool fits(double low, double high, int exponent) {
  const double largest = std::max(std::abs(low), std::abs(high));
  return std::ldexp(largest, -exponent) < std::ldexp(1.0, kMantissaBits) &&
         bin_of(high, exponent) - bin_of(low, exponent) < static_cast<double>(kFineBins);
}

}  // namespace

HistogramCounter::HistogramCounter(SampleType type)
    : type_(type), exponent_(is_integer(type) ? 0 : kNarrowest), counts_(static_cast<std::size_t>(kFineBins)) {}

void HistogramCounter::add(const std::byte* samples, std::int64_t count) {
  visit_sample_type(type_, [&]<class T>() { add_typed(reinterpret_cast<const T*>(samples), count); });
}

void HistogramCounter::add_equal(const std::byte* sample, std::uint64_t count) {
  if (count == 0) return;
  const std::uint64_t nan = nan_, infinite = infinite_;
  add(sample, 1);
  if (nan_ > nan) {
    nan_ += count - 1;
  } else if (infinite_ > infinite) {
    infinite_ += count - 1;
  } else {
    visit_sample_type(type_, [&]<class T>() {
      T value{};
      std::memcpy(&value, sample, sizeof(T));
      const auto bin = static_cast<std::int64_t>(bin_of(static_cast<double>(value), exponent_));
      counts_[static_cast<std::size_t>(bin - first_)] += count - 1;
    });
  }
}

template <class T>
void HistogramCounter::add_typed(const T* samples, std::int64_t count) {
  T low = std::numeric_limits<T>::max();
  T high = std::numeric_limits<T>::lowest();
  std::int64_t finite = 0;
  for (std::int64_t n = 0; n < count; ++n) {
    const T value = samples[n];
    if (is_finite_sample(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
      ++finite;
    } else {
      ++(is_nan(value) ? nan_ : infinite_);
    }
  }
  if (finite == 0) return;
  if constexpr (std::is_integral_v<T> && sizeof(T) == sizeof(std::int64_t)) {
    if (!whole_) whole_ = {low, high};
    whole_ = {std::min<Label>((*whole_)[0], low), std::max<Label>((*whole_)[1], high)};
  }
  make_room(static_cast<double>(low), static_cast<double>(high));
  const double scale = std::ldexp(1.0, -exponent_);
  for (std::int64_t n = 0; n < count; ++n) {
    if (!is_finite_sample(samples[n])) continue;
    const auto bin = static_cast<std::int64_t>(std::floor(static_cast<double>(samples[n]) * scale));
    ++counts_[static_cast<std::size_t>(bin - first_)];
  }
}

// Widens and moves the bins until [low, high] and all values counted before fit into them.
void HistogramCounter::make_room(double low, double high) {
  const bool is_first = min_ > max_;
  if (!is_first && low >= min_ && high <= max_) return;
  const double new_min = is_first ? low : std::min(low, min_);
  const double new_max = is_first ? high : std::max(high, max_);
  int exponent = exponent_;
  while (!fits(new_min, new_max, exponent)) ++exponent;
  if (!is_first && exponent > exponent_) widen(exponent);
  exponent_ = exponent;
  const auto first = static_cast<std::int64_t>(bin_of(new_min, exponent_));
  // Counted bins lie in [new_min, new_max], which fits from the new first bin on.
  if (!is_first && first < first_) {
    std::rotate(counts_.begin(), counts_.end() - std::min(first_ - first, kFineBins), counts_.end());
  }
  if (is_first || first < first_) first_ = first;
  // Room at the front that is not needed any more makes place at the end.
  if (first > first_) {
    std::rotate(counts_.begin(), counts_.begin() + std::min(first - first_, kFineBins), counts_.end());
    first_ = first;
  }
  min_ = new_min;
  max_ = new_max;
}

// Merges bins to a larger width.
void HistogramCounter::widen(int exponent) {
  const int shift = std::min(exponent - exponent_, 62);
  const std::int64_t first = first_ >> shift;
  std::vector<std::uint64_t> merged(counts_.size());
  for (std::int64_t n = 0; n < kFineBins; ++n) {
    const std::uint64_t samples = counts_[static_cast<std::size_t>(n)];
    if (samples > 0) merged[static_cast<std::size_t>(((first_ + n) >> shift) - first)] += samples;
  }
  counts_ = std::move(merged);
  first_ = first;
}

std::vector<std::uint64_t> HistogramCounter::below(double first, double width, std::size_t count) const {
  std::vector<std::uint64_t> result(count);
  auto bin = counts_.begin();
  std::uint64_t sum = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double bins = bin_of((first + static_cast<double>(n)) * width, exponent_) - static_cast<double>(first_);
    const auto end =
        counts_.begin() + static_cast<std::ptrdiff_t>(std::clamp(bins, 0.0, static_cast<double>(kFineBins)));
    sum = std::accumulate(bin, end, sum);
    bin = end;
    result[n] = sum;
  }
  return result;
}

double HistogramCounter::width() const { return std::ldexp(1.0, exponent_); }

Histogram HistogramCounter::histogram(double slope, double intercept) const {
  Histogram result;
  result.nan = nan_;
  result.infinite = infinite_;
  if (min_ > max_) return result;
  const double ends[] = {slope * min_ + intercept, slope * max_ + intercept};
  result.min = std::min(ends[0], ends[1]);
  result.max = std::max(ends[0], ends[1]);
  if (slope == 1 && intercept == 0) result.whole = whole_;
  // A bin of integers holds one value when its width is 1: its lower end, not its middle.
  const double inside = is_integer(type_) && exponent_ == 0 ? 0 : 0.5;
  constexpr double kBins = static_cast<double>(Histogram::kBins);
  for (std::int64_t n = 0; n < kFineBins; ++n) {
    const std::uint64_t samples = counts_[static_cast<std::size_t>(n)];
    if (samples == 0) continue;
    const double stored = std::ldexp(static_cast<double>(first_ + n) + inside, exponent_);
    // Takes halves, so that the width of the whole range of doubles is still a number.
    const double width = max_ / 2 - min_ / 2;
    const double part = width > 0 ? (stored / 2 - min_ / 2) / width : 0;
    const double place = std::clamp(std::floor((slope < 0 ? 1 - part : part) * kBins), 0.0, kBins - 1);
    result.bins[static_cast<std::size_t>(place)] += samples;
  }
  return result;
}

}  // namespace isoweave
