#include "volume/noise.hpp"

#include <algorithm>

#include "parallel/size.hpp"

namespace isoweave {

ValueNoise::ValueNoise(std::int64_t pitch, std::uint64_t seed)
    : pitch_(pitch), seed_(scramble_bits(seed + static_cast<std::uint64_t>(pitch))) {
  for (std::int64_t offset = 0; offset < pitch; ++offset) {
    // Half a sample off the random values, so that no sample sits where the noise is flat.
    const double t = (static_cast<double>(offset) + 0.5) / static_cast<double>(pitch);
    steps_.push_back(t * t * (3 - 2 * t));
  }
}

void ValueNoise::begin_slice(std::int64_t k) {
  slice_ = k;
  for (Line& line : lines_) line.row = -1;
}

const ValueNoise::Line& ValueNoise::line(std::size_t place, std::int64_t row, std::int64_t begin, std::size_t count) {
  Line& line = lines_[place];
  if (line.row == row && line.begin == begin && line.values.size() == count) return line;
  line.row = row;
  line.begin = begin;
  line.values.resize(count);
  const std::int64_t below = slice_ / pitch_;
  const double step = steps_[static_cast<std::size_t>(slice_ % pitch_)];
  const std::uint64_t lower = row_bits(seed_, row, below) + static_cast<std::uint64_t>(begin);
  const std::uint64_t upper = row_bits(seed_, row, below + 1) + static_cast<std::uint64_t>(begin);
  for (std::size_t x = 0; x < count; ++x) {
    const double a = unit_value(scramble_bits(lower + x));
    const double b = unit_value(scramble_bits(upper + x));
    line.values[x] = a + (b - a) * step;
  }
  return line;
}

void ValueNoise::add_row(std::int64_t j, std::int64_t first, double weight, std::span<double> row) {
  const std::int64_t begin = first / pitch_;
  const std::int64_t end = (first + static_cast<std::int64_t>(row.size()) - 1) / pitch_ + 2;
  const std::size_t count = to_size(end - begin);
  const double* lower = line(0, j / pitch_, begin, count).values.data();
  const double* upper = line(1, j / pitch_ + 1, begin, count).values.data();
  const double step = steps_[static_cast<std::size_t>(j % pitch_)];
  heights_.resize(count);
  for (std::size_t x = 0; x < count; ++x) heights_[x] = weight * (lower[x] + (upper[x] - lower[x]) * step);
  const auto pitch = static_cast<std::size_t>(pitch_);
  auto n = static_cast<std::size_t>(first % pitch_);
  for (std::size_t at = 0, cell = 0; at < row.size(); ++cell, n = 0) {
    const double a = heights_[cell];
    const double rise = heights_[cell + 1] - a;
    for (; n < pitch && at < row.size(); ++n, ++at) row[at] += a + rise * steps_[n];
  }
}

}  // namespace isoweave
