#include "extract/cell_slab.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "extract/classify.hpp"
#include "extract/front_bits.hpp"
#include "extract/row_counts.hpp"
#include "isoweave/error.hpp"
#include "parallel/size.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// Words with the bits [first, end) set.
std::vector<std::uint64_t> bit_range(std::size_t words, std::int64_t first, std::int64_t end) {
  std::vector<std::uint64_t> mask(words, 0);
  for (std::int64_t bit = first; bit < end; ++bit)
    mask[static_cast<std::size_t>(bit >> 6)] |= std::uint64_t{1} << (bit & 63);
  return mask;
}

const std::array<std::int64_t, 3>& checked_dims(const VolumeInfo& volume) {
  if (volume.dims[0] <= kMostRowSamples) return volume.dims;
  throw OverMemory(volume.path + ": a row has " + std::to_string(volume.dims[0]) + " samples, expected at most " +
                   std::to_string(kMostRowSamples));
}

}  // namespace

CellSlab::CellSlab(const VolumeInfo& volume, const IsoRule& rule, const CellBox& cells, std::size_t below,
                   const Executor& executor)
    : dims_(checked_dims(volume)),
      cells_(cells),
      type_(volume.type),
      rule_(rule),
      executor_(executor),
      rows_(to_size(volume.dims[1] + 2)),
      words_(to_size((volume.dims[0] + 2 + 63) / 64)),
      below_(static_cast<std::ptrdiff_t>(below)),
      edge_mask_(bit_range(words_, cells.first[0] + 1, cells.end[0] + 1)),
      end_mask_(bit_range(words_, 1, 2)),
      next_layer_(std::max<std::int64_t>(cells.first[2] - 1, -1)),
      end_layer_(cells.end[2]),
      slices_(below + 1, std::vector<std::uint64_t>(to_size(rows_, words_), 0)) {
  const std::int64_t nx = dims_[0];
  end_mask_[static_cast<std::size_t>(nx >> 6)] |= std::uint64_t{1} << (nx & 63);
  if (cells.has_point(0, 0) && cells.has_point(0, nx - 1)) return;
  point_mask_ = bit_range(words_, cells.first[0] + 1, cells.end[0] + 2);
}

void CellSlab::classify(const SliceWindow& window, std::size_t layers) {
  const auto kept = static_cast<std::size_t>(below_) + 1;
  slices_.resize(kept + layers);
  for (std::size_t n = kept; n < slices_.size(); ++n) slices_[n].resize(plane_words());
  for_rows(layers, [&](std::size_t n, std::size_t row, std::size_t) {
    classify_row_of(window, next_layer_ + static_cast<std::int64_t>(n) + 1, row, slices_[kept + n]);
  });
}

// Sets the bits of one row of slice k.
void CellSlab::classify_row_of(const SliceWindow& window, std::int64_t k, std::size_t row,
                               std::vector<std::uint64_t>& slice) {
  const auto bits = std::span(slice).subspan(row * words_, words_);
  const std::int64_t j = static_cast<std::int64_t>(row) - 1;
  if (k < 0 || k >= dims_[2] || j < 0 || j >= dims_[1]) {
    std::fill(bits.begin(), bits.end(), 0);
    return;
  }
  const std::size_t row_bytes = static_cast<std::size_t>(dims_[0]) * sample_bytes(type_);
  classify_row(window.slice(k) + static_cast<std::size_t>(j) * row_bytes, type_, dims_[0], rule_, bits, kernels_);
}

bool CellSlab::has_y(std::size_t row) const { return cells_.has_cell(1, static_cast<std::int64_t>(row) - 1); }

bool CellSlab::has_z(std::ptrdiff_t n) const { return cells_.has_cell(2, next_layer_ + n); }

// Whether the points of a row are corners of cells, along y and z.
bool CellSlab::has_points(std::ptrdiff_t n, std::size_t row) const {
  return cells_.has_point(1, static_cast<std::int64_t>(row) - 1) && cells_.has_point(2, next_layer_ + n);
}

std::array<const std::uint64_t*, 4> CellSlab::rows_around(std::ptrdiff_t n, std::size_t row) const {
  return {inside(n, row), inside(n, row + 1), inside(n + 1, row), inside(n + 1, row + 1)};
}

std::uint32_t CellSlab::find_crossed(std::ptrdiff_t n, std::size_t row, std::span<std::uint64_t> crossed) const {
  if (!has_cells(n, row)) {
    std::fill(crossed.begin(), crossed.end(), 0);
    return 0;
  }
  kernels_.cells_crossed(rows_around(n, row), edge_mask_.data(), words_, crossed.data());
  std::uint32_t count = 0;
  for (const std::uint64_t word : crossed) count += ones(word);
  return count;
}

void CellSlab::advance(std::size_t layers) {
  for (std::size_t n = 0; n <= static_cast<std::size_t>(below_); ++n) std::swap(slices_[n], slices_[n + layers]);
  next_layer_ += static_cast<std::int64_t>(layers);
}

void CellSlab::serialize(StateWriter& state) const {
  FrontBits front{next_layer_, {}};
  for (std::size_t n = 0; n <= static_cast<std::size_t>(below_); ++n) {
    front.inside.insert(front.inside.end(), slices_[n].begin(), slices_[n].end());
  }
  front.write(state);
}

void CellSlab::serialize(StateReader& state) {
  const std::size_t kept = static_cast<std::size_t>(below_) + 1;
  const FrontBits front = FrontBits::read(state, dims_, end_layer_, kept);
  next_layer_ = front.next_layer;
  const auto size = static_cast<std::ptrdiff_t>(plane_words());
  for (std::size_t n = 0; n < kept; ++n) {
    const auto first = front.inside.begin() + static_cast<std::ptrdiff_t>(n) * size;
    slices_[n].assign(first, first + size);
  }
}

}  // namespace isoweave
