#include "extract/classify.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "volume/samples.hpp"

namespace isoweave {
namespace {

// The comparison in the sample's own type that equals the comparison with the iso-value in double.
template <class T>
struct Threshold {
  T value{};
  bool reachable = true;  // false: no sample of this type can be inside
};

template <class T>
Threshold<T> threshold_for(const IsoRule& rule) {
  constexpr double kLowest = static_cast<double>(std::numeric_limits<T>::lowest());
  constexpr double kHighest = static_cast<double>(std::numeric_limits<T>::max());
  if constexpr (std::numeric_limits<T>::is_integer) {
    const double bound = rule.above ? std::ceil(rule.iso) : std::floor(rule.iso);
    if (rule.above ? bound > kHighest : bound < kLowest) return {T{}, false};
    return {static_cast<T>(std::clamp(bound, kLowest, kHighest)), true};
  } else {
    constexpr T kInfinity = std::numeric_limits<T>::infinity();
    if (rule.iso > kHighest || rule.iso < kLowest) {
      const bool beyond = rule.iso > 0;
      if (rule.above) return {beyond ? kInfinity : std::numeric_limits<T>::lowest(), true};
      return {beyond ? std::numeric_limits<T>::max() : -kInfinity, true};
    }
    T value = static_cast<T>(rule.iso);
    if (rule.above && static_cast<double>(value) < rule.iso) value = std::nextafter(value, kInfinity);
    if (!rule.above && static_cast<double>(value) > rule.iso) value = std::nextafter(value, -kInfinity);
    return {value, true};
  }
}

}  // namespace

void classify_row(const std::byte* row, SampleType type, std::int64_t n, const IsoRule& rule,
                  std::span<std::uint64_t> words, const RowKernels& kernels) {
  visit_sample_type(type, [&]<class T>() {
    const Threshold<T> threshold = threshold_for<T>(rule);
    if (!threshold.reachable) return std::fill(words.begin(), words.end(), 0);
    const auto& compare = std::get<Comparison<T>>(kernels.compare);
    (rule.above ? compare.at_least : compare.at_most)(reinterpret_cast<const T*>(row), n, threshold.value, words);
  });
}

}  // namespace isoweave
