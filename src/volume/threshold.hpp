// The comparison with an iso-value in the samples' own type.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace isoweave {

// A comparison that gives what a comparison with the exact iso-value gives.
template <class T>
struct Threshold {
  T value{};
  bool reachable = true;  // false: no sample of this type can be inside
};

// The whole number that is next to `bound`, a whole number as well.
template <class T>
T nearest_integer(double bound) {
  // The largest integer of 64 bits is not a double; the smallest one always is.
  if (bound >= static_cast<double>(std::numeric_limits<T>::max())) return std::numeric_limits<T>::max();
  return static_cast<T>(std::max(bound, static_cast<double>(std::numeric_limits<T>::lowest())));
}

// Inside is sample >= iso where `above`, else sample <= iso.
template <class T>
Threshold<T> threshold_for(double iso, bool above) {
  constexpr double kLowest = static_cast<double>(std::numeric_limits<T>::lowest());
  constexpr double kHighest = static_cast<double>(std::numeric_limits<T>::max());
  if constexpr (std::numeric_limits<T>::is_integer) {
    const double bound = above ? std::ceil(iso) : std::floor(iso);
    const bool rounded = kHighest > 0x1p62;  // up, to a number that no sample reaches
    if (above ? (rounded ? bound >= kHighest : bound > kHighest) : bound < kLowest) return {T{}, false};
    return {nearest_integer<T>(bound), true};
  } else {
    constexpr T kInfinity = std::numeric_limits<T>::infinity();
    if (iso > kHighest || iso < kLowest) {
      const bool beyond = iso > 0;
      if (above) return {beyond ? kInfinity : std::numeric_limits<T>::lowest(), true};
      return {beyond ? std::numeric_limits<T>::max() : -kInfinity, true};
    }
    T value = static_cast<T>(iso);
    if (above && static_cast<double>(value) < iso) value = std::nextafter(value, kInfinity);
    if (!above && static_cast<double>(value) > iso) value = std::nextafter(value, -kInfinity);
    return {value, true};
  }
}

}  // namespace isoweave
