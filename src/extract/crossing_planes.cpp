#include "extract/crossing_planes.hpp"

#include <algorithm>
#include <span>

#include "extract/cube_rules.hpp"
#include "extract/gradient.hpp"
#include "extract/row_counts.hpp"
#include "extract/sample_view.hpp"
#include "parallel/size.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// The crossing of the edge that begins at a sample, along an axis.
template <class T>
Crossing crossing_at(const SampleView<T>& samples, const std::array<std::int64_t, 3>& low, std::size_t axis,
                     bool low_inside) {
  Crossing crossing{low, static_cast<std::uint8_t>(1U << axis), 0, 0, 0, low_inside};
  const std::array<std::int64_t, 3> high = crossing.high();
  crossing.f0 = samples.row(low[1], low[2])[low[0]];
  crossing.f1 = samples.row(high[1], high[2])[high[0]];
  crossing.t = crossing_parameter(crossing.f0, crossing.f1, samples.iso(), low_inside);
  return crossing;
}

}  // namespace

void CrossingPlanes::find(const CellSlab& slab, std::size_t slices) {
  rows_ = slab.rows();
  words_ = slab.words();
  first_in_row_.resize(slices * rows_);
  for (std::vector<std::uint64_t>& words : along_) words.resize(to_size(slices * rows_, words_));
  slab.for_rows(slices, [&](std::size_t slice, std::size_t row, std::size_t number) {
    const std::ptrdiff_t n = static_cast<std::ptrdiff_t>(slice) - 1;
    const auto words_of = [&](std::size_t axis) {
      return std::span(along_[axis]).subspan(slice * slab.plane_words(), slab.plane_words());
    };
    slab.find_along<1>(n, row, words_of(0));
    slab.find_along<2>(n, row, words_of(1));
    if (slice + 1 < slices) slab.find_along<4>(n, row, words_of(2));
    if (slice + 1 == slices) std::ranges::fill(words_of(2).subspan(row * words_, words_), 0);
    std::uint64_t count = 0;
    for (std::size_t w = number * words_; w < (number + 1) * words_; ++w) {
      for (const std::vector<std::uint64_t>& words : along_) count += ones(words[w]);
    }
    first_in_row_[number] = count;
  });
}

// Gives every row the number of its first plane, and makes room for all.
void CrossingPlanes::place_rows(std::size_t slices) {
  std::uint64_t sum = 0;
  for (std::size_t row = 0; row < slices * rows_; ++row) {
    const std::uint64_t count = first_in_row_[row];
    first_in_row_[row] = sum;
    sum += count;
  }
  require_numbers(slices, sum, "crossings of edges");
  first_in_word_.resize(slices * rows_ * words_);
  planes_.resize(to_size(sum));
}

// Makes the planes of a row. make_plane(axis, bit): that of one of its crossings.
template <class MakePlane>
void CrossingPlanes::make_row(std::size_t slice, std::size_t row, const MakePlane& make_plane) {
  const std::size_t number = slice * rows_ + row;
  std::uint64_t next = first_in_row_[number];
  for (std::size_t w = 0; w < words_; ++w) {
    first_in_word_[number * words_ + w] = static_cast<std::uint32_t>(next);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::uint64_t bits = along(axis, slice, row)[w]; bits != 0; bits &= bits - 1) {
        planes_[next++] = make_plane(axis, static_cast<std::int64_t>(64 * w) + std::countr_zero(bits));
      }
    }
  }
}

void CrossingPlanes::make(const CellSlab& slab, const SliceWindow& window, const std::array<double, 3>& spacing,
                          std::size_t slices) {
  place_rows(slices);
  visit_sample_type(window.info().type, [&]<class T>() {
    const SampleView<T> samples(window, slab.rule().iso);
    slab.for_rows(slices, [&](std::size_t slice, std::size_t row, std::size_t) {
      const std::ptrdiff_t n = static_cast<std::ptrdiff_t>(slice) - 1;
      const std::uint64_t* const inside = slab.inside(n, row);
      make_row(slice, row, [&](std::size_t axis, std::int64_t bit) {
        const bool low_inside = (inside[bit / 64] >> bit % 64 & 1) != 0;
        const std::array<std::int64_t, 3> low{bit - 1, static_cast<std::int64_t>(row) - 1, slab.next_layer() + n};
        const Crossing crossing = crossing_at(samples, low, axis, low_inside);
        return CrossingPlane{crossing.t, sharp_normal_at(samples, crossing, spacing, slab.rule().above)};
      });
    });
  });
}

}  // namespace isoweave
