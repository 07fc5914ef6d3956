#include "pipeline/forecast/forecast_tile.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "parallel/size.hpp"
#include "volume/samples.hpp"
#include "volume/threshold.hpp"

namespace isoweave {
namespace {

// Copies the rectangle `part` of slices whose rows have `row` samples of `each` bytes.
void copy_part(const std::byte* slice, std::int64_t row, const Rectangle& part, std::size_t each, std::byte* out) {
  const std::size_t bytes = static_cast<std::size_t>(part.size[0]) * each;
  for (std::int64_t j = part.from[1]; j < part.from[1] + part.size[1]; ++j, out += bytes) {
    std::memcpy(out, slice + static_cast<std::size_t>(j * row + part.from[0]) * each, bytes);
  }
}

}  // namespace

double inside_on_sides(std::span<const std::byte> slice, const VolumeInfo& info, const IsoRule& rule,
                       std::int64_t rows) {
  const std::int64_t nx = info.dims[0];
  const bool whole = rows == info.dims[1];
  return visit_sample_type(info.type, [&]<class T>() {
    const T* const samples = reinterpret_cast<const T*>(slice.data());
    const Threshold<T> threshold = threshold_for<T>(rule.iso, rule.above);
    std::uint64_t inside = 0;
    const auto add = [&](std::int64_t i, std::int64_t j) {
      const T value = samples[j * nx + i];
      const bool is_beyond = rule.above ? value >= threshold.value : value <= threshold.value;
      inside += threshold.reachable && is_beyond ? 1 : 0;
    };
    for (std::int64_t i = 0; whole && i < nx; ++i) add(i, 0), add(i, rows - 1);
    for (std::int64_t j = 0; j < rows; ++j) add(0, j), add(nx - 1, j);
    const auto sides = static_cast<double>(info.dims[0] + info.dims[1]);
    return static_cast<double>(inside) * (whole ? 1 : sides / static_cast<double>(rows));
  });
}

std::size_t TriangleMap::bin(double place, std::size_t axis) const {
  const double bin = place / static_cast<double>(dims_[axis]) * static_cast<double>(kBins);
  return std::min(static_cast<std::size_t>(std::max(bin, 0.0)), kBins - 1);
}

std::uint64_t TriangleMap::count(std::size_t i, std::size_t j, std::size_t side) const {
  std::uint64_t sum = 0;
  for (std::size_t row = j; row < j + side; ++row) {
    for (std::size_t at = row * kBins + i; at < row * kBins + i + side; ++at) sum += counts_[at];
  }
  return sum;
}

std::vector<Rectangle> TriangleMap::parts(std::size_t number, double share, double most) const {
  const auto side_of = [](double area) {
    return static_cast<std::size_t>(std::clamp(std::floor(std::sqrt(area) * kBins), 1.0, double{kBins}));
  };
  const std::uint64_t all = count(0, 0, kBins);
  const auto together = static_cast<double>(number);
  if (all == 0 || (most >= 1 && 2 * share * together > 1)) {
    const std::size_t side = side_of(most);
    return {rectangle((kBins - side) / 2, (kBins - side) / 2, side)};
  }
  std::vector<Rectangle> parts;
  for (std::size_t n = 0; n < number; ++n) {
    const std::uint64_t rank = all * (2 * n + 1) / (2 * number);
    parts.push_back(part_around(bin_at(rank), share * static_cast<double>(all), side_of(most / together)));
  }
  return parts;
}

// The smallest square part around a bin, as far as that is inside the slice, with so many triangles; none larger than
// `most_side`.
Rectangle TriangleMap::part_around(const std::array<std::size_t, 2>& bin, double triangles,
                                   std::size_t most_side) const {
  for (std::size_t side = 1;; ++side) {
    const auto around = [side](std::size_t at) { return std::min(at - std::min(at, side / 2), kBins - side); };
    const std::size_t i = around(bin[0]), j = around(bin[1]);
    if (side >= most_side || static_cast<double>(count(i, j, side)) >= triangles) return rectangle(i, j, side);
  }
}

// The bin with the triangle of that rank. Bins are counted along a curve that leaves no square before it has been in
// all of it (G. M. Morton 1966), so that ranks far from each other lie in different parts of the slice.
std::array<std::size_t, 2> TriangleMap::bin_at(std::uint64_t rank) const {
  std::uint64_t before = 0;
  std::array<std::size_t, 2> bin{};
  for (std::size_t code = 0; code < kBins * kBins; ++code) {
    bin = {};
    for (std::size_t bit = 0; bit < 10; ++bit) bin[bit % 2] |= (code >> bit & 1) << bit / 2;
    before += counts_[bin[1] * kBins + bin[0]];
    if (before > rank) break;
  }
  return bin;
}

Rectangle TriangleMap::rectangle(std::size_t i, std::size_t j, std::size_t side) const {
  const std::array from{i, j};
  Rectangle found;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto edge = [&](std::size_t at) { return dims_[axis] * static_cast<std::int64_t>(at) / std::int64_t{kBins}; };
    const std::int64_t least = std::min<std::int64_t>(2, dims_[axis]);
    found.from[axis] = std::min(edge(from[axis]), dims_[axis] - least);
    found.size[axis] = std::max(edge(from[axis] + side) - found.from[axis], least);
  }
  return found;
}

Tile::Tile(const VolumeInfo& volume, const Rectangle& part, std::int64_t slices)
    : info_(volume), part_(part), whole_row_(volume.dims[0]) {
  info_.dims = {part.size[0], part.size[1], slices};
  samples_.resize(to_size(slices, info_.slice_bytes()));
}

void Tile::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  std::memcpy(out.data(), samples_.data() + offset(first), offset(count));
}

void Tile::take(std::int64_t n, std::span<const std::byte> whole) {
  copy_part(whole.data(), whole_row_, part_, sample_bytes(info_.type), samples_.data() + offset(n));
}

Tile Tile::cut(const Rectangle& part) const {
  Rectangle inner;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    inner.size[axis] = std::min(part.size[axis], part_.size[axis]);
    inner.from[axis] =
        std::clamp<std::int64_t>(part.from[axis] - part_.from[axis], 0, part_.size[axis] - inner.size[axis]);
  }
  Tile smaller(info_, inner, info_.dims[2]);
  for (std::int64_t n = 0; n < info_.dims[2]; ++n) smaller.take(n, std::span(samples_).subspan(offset(n)));
  return smaller;
}

Section::Section(RowReader& rows, const VolumeInfo& info, std::int64_t first, std::int64_t slices, RowBand band,
                 Look look)
    : rows_(rows), first_(first), band_(band), info_(info), look_(std::move(look)) {
  info_.dims[1] = band.count;
  info_.dims[2] = slices;
}

void Section::read(std::int64_t first, std::int64_t count, std::span<std::byte> out) {
  const std::size_t bytes = info_.slice_bytes();
  for (std::int64_t n = 0; n < count; ++n) {
    const std::span<std::byte> slice = out.subspan(static_cast<std::size_t>(n) * bytes, bytes);
    rows_.read(first_ + first + n, band_.from, band_.count, slice);
    look_(first + n, slice);
  }
}

}  // namespace isoweave
