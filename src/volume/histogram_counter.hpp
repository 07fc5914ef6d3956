// Counts the values of a volume in one pass and constant memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "isoweave/histogram.hpp"

namespace isoweave {

// Counts samples whose range is not known beforehand: fine bins of a power-of-two width, which doubles (and pairs of
// bins merge) whenever a sample falls outside. The outcome depends on the samples only, not on how they are cut into
// blocks.
class HistogramCounter {
 public:
  explicit HistogramCounter(SampleType type);

  // Samples in the machine's byte order.
  void add(const std::byte* samples, std::int64_t count);

  // Counts the same sample so many times.
  void add_equal(const std::byte* sample, std::uint64_t count);

  // The histogram of slope * sample + intercept.
  Histogram histogram(double slope, double intercept) const;

 private:
  template <class T>
  void add_typed(const T* samples, std::int64_t count);
  void make_room(double low, double high);
  void widen(int exponent);

  SampleType type_;
  double min_ = 1, max_ = 0;
  std::optional<std::array<Label, 2>> whole_;  // the same, of integers of 64 bits
  std::uint64_t nan_ = 0, infinite_ = 0;
  int exponent_;            // the width of a bin is 2^exponent_
  std::int64_t first_ = 0;  // fine bin n counts the samples in [first_ + n, first_ + n + 1) * width
  std::vector<std::uint64_t> counts_;
};

}  // namespace isoweave
