#include "extract/classify.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
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

// Eight bytes of 0 or 1 to eight bits, by one multiplication.
std::uint64_t pack_flags(const std::uint8_t* flags) {
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, flags, 8);
  return (bytes * 0x0102040810204080u) >> 56;
}

template <class T, class Inside>
void classify_typed(const T* row, std::int64_t n, Inside inside, std::span<std::uint64_t> words) {
  const auto pack = [](const std::array<std::uint8_t, 64>& flags) {
    std::uint64_t word = 0;
    for (std::size_t byte = 0; byte < 8; ++byte) word |= pack_flags(flags.data() + 8 * byte) << (8 * byte);
    return word;
  };
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::int64_t start = 64 * static_cast<std::int64_t>(w) - 1;
    alignas(64) std::array<std::uint8_t, 64> flags;
    if (start >= 0 && start + 64 <= n) {
      for (std::size_t i = 0; i < 64; ++i) flags[i] = inside(row[start + static_cast<std::int64_t>(i)]);
    } else {
      flags.fill(0);
      for (std::int64_t i = std::max<std::int64_t>(start, 0); i < std::min(n, start + 64); ++i) {
        flags[static_cast<std::size_t>(i - start)] = inside(row[i]);
      }
    }
    words[w] = pack(flags);
  }
}

}  // namespace

void classify_row(const std::byte* row, SampleType type, std::int64_t n, const IsoRule& rule,
                  std::span<std::uint64_t> words) {
  visit_sample_type(type, [&]<class T>() {
    const Threshold<T> threshold = threshold_for<T>(rule);
    const T* samples = reinterpret_cast<const T*>(row);
    if (!threshold.reachable) {
      std::fill(words.begin(), words.end(), 0);
    } else if (rule.above) {
      classify_typed(
          samples, n, [t = threshold.value](T f) { return static_cast<std::uint8_t>(f >= t); }, words);
    } else {
      classify_typed(
          samples, n, [t = threshold.value](T f) { return static_cast<std::uint8_t>(f <= t); }, words);
    }
  });
}

}  // namespace isoweave
