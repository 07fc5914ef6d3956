#include "volume/samples.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace isoweave {
namespace {

// Independent lanes let the compiler use vector minima without reordering anything that matters.
template <class T>
SampleRange typed_range(const T* samples, std::int64_t count) {
  constexpr std::int64_t kLanes = 32;
  constexpr bool kHasNan = std::numeric_limits<T>::has_quiet_NaN;
  constexpr T kHighest = kHasNan ? std::numeric_limits<T>::infinity() : std::numeric_limits<T>::max();
  constexpr T kLowest = kHasNan ? -std::numeric_limits<T>::infinity() : std::numeric_limits<T>::lowest();
  std::array<T, kLanes> low;
  std::array<T, kLanes> high;
  low.fill(kHighest);
  high.fill(kLowest);
  std::uint64_t nan = 0;
  const auto take = [&](std::int64_t base, std::int64_t lanes) {
    for (std::int64_t lane = 0; lane < lanes; ++lane) {
      const auto slot = static_cast<std::size_t>(lane);
      const T value = samples[base + lane];
      low[slot] = value < low[slot] ? value : low[slot];
      high[slot] = high[slot] < value ? value : high[slot];
      if constexpr (kHasNan) nan += std::isnan(value);
    }
  };
  std::int64_t base = 0;
  for (; base + kLanes <= count; base += kLanes) take(base, kLanes);
  take(base, count - base);

  SampleRange range;
  range.nan = nan;
  if (nan < static_cast<std::uint64_t>(count)) {
    range.min = static_cast<double>(*std::min_element(low.begin(), low.end()));
    range.max = static_cast<double>(*std::max_element(high.begin(), high.end()));
  }
  return range;
}

}  // namespace

void SampleRange::merge(const SampleRange& other) {
  nan += other.nan;
  if (other.empty()) return;
  if (empty()) {
    min = other.min;
    max = other.max;
    return;
  }
  min = std::min(min, other.min);
  max = std::max(max, other.max);
}

std::vector<double> numbers_of_samples(std::span<const std::byte> samples, SampleType type) {
  std::vector<double> values;
  visit_sample_type(type, [&]<class Sample>() {
    for (std::size_t at = 0; at + sizeof(Sample) <= samples.size(); at += sizeof(Sample)) {
      Sample value;
      std::memcpy(&value, samples.data() + at, sizeof value);
      values.push_back(static_cast<double>(value));
    }
  });
  return values;
}

SampleRange sample_range(const std::byte* samples, SampleType type, std::int64_t count) {
  return visit_sample_type(type, [&]<class T>() { return typed_range(reinterpret_cast<const T*>(samples), count); });
}

}  // namespace isoweave
