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

  // The finite samples that are less than (first + n) * width, for n from 0 on. The width must be a whole multiple of
  // width(), and `first` a whole number.
  std::vector<std::uint64_t> below(double first, double width, std::size_t count) const;

  // The width of the bins.
  double width() const;

  // The range of the finite samples; min > max where there are none.
  double min() const { return min_; }
  double max() const { return max_; }

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
