#include "isoweave/histogram.hpp"

#include <algorithm>
#include <stdexcept>

#include "isoweave/error.hpp"
#include "parallel/float_environment.hpp"
#include "parallel/size.hpp"
#include "volume/histogram_counter.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlockBytes = 4 << 20;  // read at a time

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
  const std::int64_t rows = std::clamp<std::int64_t>(kBlockBytes / row, 1, info.dims[1]);
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
  return histogram.min * (1 - edge) + histogram.max * edge;
}

std::vector<std::uint64_t> coarser_bins(const Histogram& histogram, std::size_t parts) {
  if (parts == 0 || Histogram::kBins % parts != 0) throw std::invalid_argument("the number of bins must divide 256");
  std::vector<std::uint64_t> bins(parts);
  for (std::size_t n = 0; n < Histogram::kBins; ++n) bins[n * parts / Histogram::kBins] += histogram.bins[n];
  return bins;
}

}  // namespace isoweave
