#include "isoweave/histogram.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "isoweave/error.hpp"
#include "parallel/float_environment.hpp"
#include "parallel/size.hpp"
#include "volume/histogram_counter.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kHistogramBytes = 4 << 20;  // read at a time

}  // namespace

Histogram read_histogram(SliceSource& volume, const std::atomic<bool>* stop) {
  const StandardFloats floats;
  const VolumeInfo& info = volume.info();
  HistogramCounter counter(info.type);
  if (const std::optional<SampleBytes> sample = constant_sample(volume)) {
    counter.add_equal(sample->data(), static_cast<std::uint64_t>(info.slice_samples() * info.dims[2]));
    return counter.histogram(info.slope, info.intercept);
  }
  const std::int64_t row = info.dims[0] * static_cast<std::int64_t>(sample_bytes(info.type));
  const std::int64_t rows = std::clamp<std::int64_t>(kHistogramBytes / row, 1, info.dims[1]);
  std::vector<std::byte> block(to_size(rows * row));
  RowReader reader(volume);
  for (std::int64_t k = 0; k < info.dims[2]; ++k) {
    for (std::int64_t j = 0; j < info.dims[1]; j += rows) {
      if (stop != nullptr && stop->load()) throw Interrupted("interrupted, nothing was written");
      const std::int64_t count = std::min(rows, info.dims[1] - j);
      reader.read(k, j, count, block);
      counter.add(block.data(), count * info.dims[0]);
    }
  }
  return counter.histogram(info.slope, info.intercept);
}

namespace {

// The value at a part of the range, above its least one, which as an iso-value would have all samples inside.
double value_at(const Histogram& histogram, double part) {
  return std::max(histogram.min * (1 - part) + histogram.max * part, std::nextafter(histogram.min, histogram.max));
}

}  // namespace

std::optional<double> otsu_threshold(const Histogram& histogram) {
  if (histogram.empty() || histogram.min == histogram.max) return std::nullopt;
  double total = 0;
  double moment = 0;
  for (std::size_t n = 0; n < Histogram::kBins; ++n) {
    total += static_cast<double>(histogram.bins[n]);
    moment += static_cast<double>(n) * static_cast<double>(histogram.bins[n]);
  }
  double below = 0;
  double moment_below = 0;
  double best = 0;
  std::size_t first_best = 0;
  std::size_t last_best = 0;
  for (std::size_t n = 0; n + 1 < Histogram::kBins; ++n) {
    below += static_cast<double>(histogram.bins[n]);
    moment_below += static_cast<double>(n) * static_cast<double>(histogram.bins[n]);
    const double above = total - below;
    if (below <= 0 || above <= 0) continue;
    const double gap = moment_below / below - (moment - moment_below) / above;
    const double variance = below * above * gap * gap;
    if (variance > best) {
      best = variance;
      first_best = n;
    }
    if (variance >= best) last_best = n;
  }
  const double edge = (static_cast<double>(first_best + last_best) / 2 + 1) / static_cast<double>(Histogram::kBins);
  return value_at(histogram, edge);
}

namespace {

// Counts and moments of all bins before each bin.
struct Sums {
  std::array<double, Histogram::kBins + 1> counts{}, moments{};

  explicit Sums(const Histogram& histogram) {
    for (std::size_t n = 0; n < Histogram::kBins; ++n) {
      const auto count = static_cast<double>(histogram.bins[n]);
      counts[n + 1] = counts[n] + count;
      moments[n + 1] = moments[n] + static_cast<double>(n) * count;
    }
  }

  // The part of the variance between classes that the class of bins [first, end) has; below 0 for none.
  double of_class(std::size_t first, std::size_t end) const {
    const double count = counts[end] - counts[first];
    const double moment = moments[end] - moments[first];
    return count > 0 ? moment * moment / count : -1;
  }
};

// best[end]: the largest variance of the first `end` bins in some classes; from[end]: the bin where the last begins.
struct Row {
  std::array<double, Histogram::kBins + 1> best{};
  std::array<std::size_t, Histogram::kBins + 1> from{};
};

Row with_one_class_more(const Row& row, const Sums& sums, std::size_t classes) {
  Row more;
  more.best.fill(-1);
  for (std::size_t end = classes; end <= Histogram::kBins; ++end) {
    for (std::size_t first = classes - 1; first < end; ++first) {
      const double last = sums.of_class(first, end);
      if (row.best[first] < 0 || last < 0 || row.best[first] + last <= more.best[end]) continue;
      more.best[end] = row.best[first] + last;
      more.from[end] = first;
    }
  }
  return more;
}

}  // namespace

std::vector<double> otsu_thresholds(const Histogram& histogram, std::size_t classes) {
  constexpr std::size_t kMostClasses = 8;
  if (classes < 2 || classes > kMostClasses) throw std::invalid_argument("classes: expected 2 to 8");
  if (histogram.empty() || histogram.min == histogram.max) return {};
  const Sums sums(histogram);
  std::vector<Row> rows(1);
  for (std::size_t end = 0; end <= Histogram::kBins; ++end) rows[0].best[end] = sums.of_class(0, end);
  for (std::size_t n = 2; n <= classes; ++n) rows.push_back(with_one_class_more(rows.back(), sums, n));
  while (rows.back().best[Histogram::kBins] < 0) rows.pop_back();
  std::vector<double> thresholds(rows.size() - 1);
  std::size_t end = Histogram::kBins;
  for (std::size_t n = thresholds.size(); n > 0; --n) {
    end = rows[n].from[end];
    const double edge = static_cast<double>(end) / static_cast<double>(Histogram::kBins);
    thresholds[n - 1] = value_at(histogram, edge);
  }
  return thresholds;
}

std::span<const HounsfieldPreset> hounsfield_presets() {
  static constexpr std::array<HounsfieldPreset, 3> kPresets{{{"bone", 226}, {"skin", -300}, {"lung", -500}}};
  return kPresets;
}

bool is_hounsfield_range(double min, double max) {
  constexpr double kAir = -500;
  constexpr double kDense = 150;
  constexpr double kLeast = -32768, kMost = 65535;  // that scanners write
  return kLeast <= min && min <= kAir && kDense <= max && max <= kMost;
}

std::vector<std::uint64_t> coarser_bins(const Histogram& histogram, std::size_t parts) {
  if (parts == 0 || Histogram::kBins % parts != 0) throw std::invalid_argument("the number of bins must divide 256");
  std::vector<std::uint64_t> bins(parts);
  for (std::size_t n = 0; n < Histogram::kBins; ++n) bins[n * parts / Histogram::kBins] += histogram.bins[n];
  return bins;
}

}  // namespace isoweave
