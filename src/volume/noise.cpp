#include "volume/noise.hpp"

#include <algorithm>

#include "parallel/size.hpp"

namespace isoweave {

ValueNoise::ValueNoise(std::int64_t width, std::int64_t height, std::int64_t pitch, std::uint64_t seed)
    : pitch_(pitch),
      seed_(mix_bits(seed + static_cast<std::uint64_t>(pitch))),
      columns_(to_size(width / pitch + 2)),
      rows_(to_size(height / pitch + 2)),
      plane_(to_size(rows_, columns_)),
      line_(columns_) {
  for (std::int64_t offset = 0; offset < pitch; ++offset) {
    // Half a sample off the random values, so that no sample sits where the noise is flat.
    const double t = (static_cast<double>(offset) + 0.5) / static_cast<double>(pitch);
    steps_.push_back(t * t * (3 - 2 * t));
  }
}

void ValueNoise::begin_slice(std::int64_t k) {
  const std::int64_t below = k / pitch_;
  const double step = steps_[static_cast<std::size_t>(k % pitch_)];
  for (std::size_t y = 0; y < rows_; ++y) {
    const std::uint64_t lower = row_bits(seed_, static_cast<std::int64_t>(y), below);
    const std::uint64_t upper = row_bits(seed_, static_cast<std::int64_t>(y), below + 1);
    for (std::size_t x = 0; x < columns_; ++x) {
      const double a = unit_value(mix_bits(lower + x));
      const double b = unit_value(mix_bits(upper + x));
      plane_[y * columns_ + x] = a + (b - a) * step;
    }
  }
}

void ValueNoise::add_row(std::int64_t j, double weight, std::span<double> row) {
  const double* lower = plane_.data() + static_cast<std::size_t>(j / pitch_) * columns_;
  const double* upper = lower + columns_;
  const double step = steps_[static_cast<std::size_t>(j % pitch_)];
  for (std::size_t x = 0; x < columns_; ++x) line_[x] = weight * (lower[x] + (upper[x] - lower[x]) * step);
  const auto pitch = static_cast<std::size_t>(pitch_);
  for (std::size_t begin = 0, cell = 0; begin < row.size(); begin += pitch, ++cell) {
    const double a = line_[cell];
    const double rise = line_[cell + 1] - a;
    const std::size_t count = std::min(pitch, row.size() - begin);
    for (std::size_t n = 0; n < count; ++n) row[begin + n] += a + rise * steps_[n];
  }
}

}  // namespace isoweave
