// The distribution of a volume's values, found in one pass in constant memory, and a threshold from it.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "isoweave/volume.hpp"

namespace isoweave {

// The distribution in values: slope and intercept of the volume are applied. Infinities are counted, but lie outside
// the range.
struct Histogram {
  static constexpr std::size_t kBins = 256;

  double min = 1;  // of the finite values; min > max when there are none
  double max = 0;
  std::uint64_t nan = 0;
  std::uint64_t infinite = 0;
  std::optional<std::array<Label, 2>> whole;  // min and max without rounding, of integers of 64 bits without a scaling
  std::array<std::uint64_t, kBins> bins{};    // equal parts of [min, max], the last one closed

  bool empty() const { return min > max; }
};

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

// Reads the whole volume once, some rows at a time. Nothing is read where all samples are known to be one value. Throws
// Interrupted when `stop` is set, and what the source throws.
Histogram read_histogram(SliceSource& volume, const std::atomic<bool>* stop = nullptr);

// Otsu's threshold: the value that splits the histogram into the two classes with the largest variance between them;
// the middle one of equally good values. Nothing when there are not two different values.
std::optional<double> otsu_threshold(const Histogram& histogram);

// The histogram in fewer equal parts; `parts` divides 256.
std::vector<std::uint64_t> coarser_bins(const Histogram& histogram, std::size_t parts);

}  // namespace isoweave
