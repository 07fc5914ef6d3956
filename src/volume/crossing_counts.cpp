// Counts the edges that surfaces cross, for all iso-values in one pass: an edge is crossed where its lower end lies
// below the iso-value and its upper end does not.
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "isoweave/error.hpp"
#include "isoweave/histogram.hpp"
#include "parallel/float_environment.hpp"
#include "parallel/size.hpp"
#include "volume/histogram_counter.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"
#include "volume/volume_sizes.hpp"

namespace isoweave {
namespace {

constexpr double kMostValues = 512;

// A sample in the reverse order of its type, so that a surface whose inside is below becomes one whose inside is above.
template <class T>
T turned(T sample) {
  if constexpr (std::is_floating_point_v<T>) {
    return -sample;
  } else {
    return static_cast<T>(~sample);
  }
}

// The number that was turned into this one.
double turned_back(double number, SampleType type) {
  return visit_sample_type(type, [&]<class T>() {
    if constexpr (std::is_floating_point_v<T>) return -number;
    return static_cast<double>(std::numeric_limits<T>::max()) + static_cast<double>(std::numeric_limits<T>::lowest()) -
           number;
  });
}

// The ends of edges, for surfaces whose inside is above.
class EdgeEnds {
 public:
  explicit EdgeEnds(SampleType type) : lows_(type), highs_(type) {}

  // Adds an edge between each sample of a list and that of another one.
  template <class T>
  void add(const T* a, const T* b, std::int64_t count) {
    add_each<T>(count, [&](std::int64_t n) { return Edge<T>{a[n], b[n], true}; });
  }

  // Adds an edge from each `step`-th sample to a point outside the volume.
  template <class T>
  void add_caps(const T* samples, std::int64_t count, std::int64_t step) {
    add_each<T>(count, [&](std::int64_t n) { return Edge<T>{samples[n * step], samples[n * step], false}; });
  }

  // The edges that are crossed at (first + n) * width, for n from 0 on: as HistogramCounter::below.
  std::vector<std::uint64_t> crossed(double first, double width, std::size_t count) const {
    std::vector<std::uint64_t> edges = lows_.below(first, width, count);
    const std::vector<std::uint64_t> below = highs_.below(first, width, count);
    for (std::size_t n = 0; n < count; ++n) edges[n] += outside_ - below[n];
    return edges;
  }

  double width() const { return std::max(lows_.width(), highs_.width()); }

  // The ends of all edges between numbers lie in [low, high].
  double low() const { return lows_.min() > lows_.max() ? highs_.min() : std::min(lows_.min(), highs_.min()); }
  double high() const { return highs_.max(); }
  bool empty() const { return highs_.min() > highs_.max(); }

 private:
  // Two samples, or one whose other end lies outside.
  template <class T>
  struct Edge {
    T a, b;
    bool has_low;
  };

  // The end of an edge that is outside whatever the iso-value is: NaN, minus infinity, no sample.
  template <class T>
  static bool is_outside(T sample) {
    if constexpr (std::is_floating_point_v<T>) {
      return !(sample > -std::numeric_limits<T>::infinity());
    }
    return false;
  }

  template <class T>
  static bool is_above_all(T sample) {
    if constexpr (std::is_floating_point_v<T>) return sample == std::numeric_limits<T>::infinity();
    return false;
  }

  template <class T, class EdgeAt>
  void add_each(std::int64_t count, const EdgeAt& edge_at) {
    const std::size_t bytes = to_size(count, sizeof(T));
    low_.resize(std::max(low_.size(), bytes));
    high_.resize(std::max(high_.size(), bytes));
    T* const lows = reinterpret_cast<T*>(low_.data());
    T* const highs = reinterpret_cast<T*>(high_.data());
    std::int64_t low_count = 0, high_count = 0;
    for (std::int64_t n = 0; n < count; ++n) {
      auto [a, b, has_low] = edge_at(n);
      if (is_outside(a)) std::swap(a, b);
      if (is_outside(a)) continue;
      has_low = has_low && !is_outside(b);
      const T low = has_low ? std::min(a, b) : a, high = has_low ? std::max(a, b) : a;
      outside_ += has_low ? 0 : 1;
      if (has_low && !is_above_all(low)) lows[low_count++] = low;
      // An edge whose ends are both above all is crossed by no surface.
      if (!is_above_all(high)) highs[high_count++] = high;
    }
    lows_.add(low_.data(), low_count);
    highs_.add(high_.data(), high_count);
  }

  HistogramCounter lows_, highs_;
  std::vector<std::byte> low_, high_;  // of a list
  std::uint64_t outside_ = 0;          // edges with an end that is outside whatever the iso-value is
};

// Adds the edges of slices, one after another.
template <class T>
class SliceEdges {
 public:
  SliceEdges(const VolumeInfo& info, bool closed, EdgeEnds& ends) : info_(info), closed_(closed), ends_(ends) {}

  // before: slice k - 1; null for the first one.
  void add(const T* slice, const T* before, std::int64_t k) {
    const auto [nx, ny, nz] = info_.dims;
    for (std::int64_t j = 0; j < ny; ++j) {
      const T* const row = slice + j * nx;
      ends_.add(row, row + 1, nx - 1);
      if (j > 0) ends_.add(row - nx, row, nx);
      if (before != nullptr) ends_.add(before + j * nx, row, nx);
      const std::int64_t caps = (j == 0) + (j == ny - 1) + (k == 0) + (k == nz - 1);
      for (std::int64_t n = 0; closed_ && n < caps; ++n) ends_.add_caps(row, nx, 1);
    }
    if (!closed_) return;
    ends_.add_caps(slice, ny, nx);
    ends_.add_caps(slice + nx - 1, ny, nx);
  }

 private:
  const VolumeInfo& info_;
  bool closed_;
  EdgeEnds& ends_;
};

void turn(std::span<std::byte> slice, SampleType type) {
  visit_sample_type(type, [&]<class T>() {
    T* const samples = reinterpret_cast<T*>(slice.data());
    for (std::size_t n = 0; n < slice.size() / sizeof(T); ++n) samples[n] = turned(samples[n]);
  });
}

// The counts at the bounds between the bins, in ascending order of the iso-values.
CrossingCounts counts_of(const EdgeEnds& ends, const VolumeInfo& info, bool is_turned) {
  CrossingCounts result;
  if (ends.empty() || ends.low() == ends.high()) return result;
  double width = ends.width();
  const bool every = sample_bytes(info.type) <= 2;
  // Takes halves, as the difference of two doubles may be no number.
  while (!every && (ends.high() / 2 - ends.low() / 2) / width > kMostValues / 2) width *= 2;
  const double begin = std::floor(ends.low() / width) + 1;
  const double end = std::floor(ends.high() / width);
  // Samples that differ by the last bits of a double may have no bound between them.
  result.counts = ends.crossed(begin, width, static_cast<std::size_t>(std::max(end - begin + 1, 0.0)));
  const auto value = [&](double bound) {
    return info.slope * (is_turned ? turned_back(bound, info.type) : bound) + info.intercept;
  };
  const double first = value(begin * width), last = value(end * width);
  if (last < first) std::ranges::reverse(result.counts);
  result.first = std::min(first, last);
  result.step = std::abs(info.slope) * width;
  return result;
}

}  // namespace

CrossingCounts count_crossings(SliceSource& volume, bool closed, bool inside_above, const std::atomic<bool>* stop) {
  const StandardFloats floats;
  const VolumeInfo& info = volume.info();
  checked_volume_bytes(info);
  if (constant_sample(volume)) {
    CrossingCounts constant;
    constant.histogram = read_histogram(volume, stop);
    return constant;
  }
  const bool is_turned = inside_above != (info.slope > 0);
  EdgeEnds ends(info.type);
  HistogramCounter histogram(info.type);
  std::vector<std::byte> slice(info.slice_bytes()), before(slice.size());
  visit_sample_type(info.type, [&]<class T>() {
    SliceEdges<T> edges(info, closed, ends);
    for (std::int64_t k = 0; k < info.dims[2]; ++k) {
      if (stop != nullptr && stop->load()) throw Interrupted("interrupted, nothing was written");
      volume.read(k, 1, slice);
      histogram.add(slice.data(), info.slice_samples());
      if (is_turned) turn(slice, info.type);
      edges.add(reinterpret_cast<const T*>(slice.data()), k > 0 ? reinterpret_cast<const T*>(before.data()) : nullptr,
                k);
      std::swap(slice, before);
    }
  });
  CrossingCounts result = counts_of(ends, info, is_turned);
  result.histogram = histogram.histogram(info.slope, info.intercept);
  return result;
}

}  // namespace isoweave
