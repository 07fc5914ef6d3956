// The cells of a slab: which lattice points are inside, and which cells the surface crosses. Every extractor begins
// with them.
//
// Bits are in words: every row of the padded lattice has one bit for each point, and bit n stands for sample n - 1.
// Layer k lies between slices k and k + 1.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "extract/cube_rules.hpp"
#include "extract/row_kernels.hpp"
#include "files/state_file.hpp"
#include "isoweave/volume.hpp"
#include "lattice/lattice.hpp"
#include "parallel/parallel.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// How many bits of a word are set.
inline std::uint32_t ones(std::uint64_t word) { return static_cast<std::uint32_t>(std::popcount(word)); }

class CellSlab {
 public:
  // cells: of the volume; no others have a surface. below: layers under the slab whose cells can be asked for. Throws
  // OverMemory for rows of more than kMostRowSamples.
  CellSlab(const VolumeInfo& volume, const IsoRule& rule, const CellBox& cells, std::size_t below,
           const Executor& executor);

  std::size_t rows() const { return rows_; }    // padded, of a slice
  std::size_t words() const { return words_; }  // of a padded row
  std::size_t plane_words() const { return rows_ * words_; }
  const std::array<std::int64_t, 3>& dims() const { return dims_; }
  const IsoRule& rule() const { return rule_; }
  const Executor& executor() const { return executor_; }
  const RowKernels& kernels() const { return kernels_; }

  // The first layer is the one below the cells, which is empty, or -1, in the pad.
  std::int64_t next_layer() const { return next_layer_; }
  std::int64_t layers_left() const { return end_layer_ - next_layer_; }

  // Sets the bits of the slices above the next layers.
  void classify(const SliceWindow& window, std::size_t layers);

  // The bits of a row of slice next_layer() + n, where n is -below or more.
  const std::uint64_t* inside(std::ptrdiff_t n, std::size_t row) const {
    return &slices_[static_cast<std::size_t>(n + below_)][row * words_];
  }

  // Per word: the edges along x that exist, which are the cells, too; and the first and the last sample of a row.
  const std::uint64_t* edge_mask() const { return edge_mask_.data(); }
  const std::uint64_t* end_mask() const { return end_mask_.data(); }

  // Whether edges along y begin in a row, and edges along z on slice next_layer() + n.
  bool has_y(std::size_t row) const;
  bool has_z(std::ptrdiff_t n) const;
  bool has_cells(std::ptrdiff_t n, std::size_t row) const { return has_z(n) && has_y(row); }

  // The rows of bits around a row of cells of layer next_layer() + n, in the order of cell_case().
  std::array<const std::uint64_t*, 4> rows_around(std::ptrdiff_t n, std::size_t row) const;

  // Finds the cells of a row that the surface crosses. Returns how many there are.
  std::uint32_t find_crossed(std::ptrdiff_t n, std::size_t row, std::span<std::uint64_t> crossed) const;

  // Finds the crossings of the edges of a direction (bits x, y, z) that begin in a row of slice next_layer() + n. `out`
  // has the words of a slice.
  template <std::uint8_t Direction>
  void find_along(std::ptrdiff_t n, std::size_t row, std::span<std::uint64_t> out) const;

  // Calls visit(layer, row, number of the row in the slab) for every row of so many layers, in parallel.
  template <class Visit>
  void for_rows(std::size_t layers, const Visit& visit) const;

  // Leaves so many layers behind.
  void advance(std::size_t layers);

  // The state between two slabs. Throws BadInput.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state);

 private:
  static constexpr std::int64_t kSamplesPerBlock = 4096;  // of rows that a thread takes at a time

  void classify_row_of(const SliceWindow& window, std::int64_t k, std::size_t row, std::vector<std::uint64_t>& slice);

  bool has_points(std::ptrdiff_t n, std::size_t row) const;

  std::array<std::int64_t, 3> dims_;
  CellBox cells_;
  SampleType type_;
  IsoRule rule_;
  const Executor& executor_;
  const RowKernels& kernels_ = row_kernels();
  std::size_t rows_, words_;
  std::ptrdiff_t below_;
  std::vector<std::uint64_t> edge_mask_, end_mask_;
  std::vector<std::uint64_t> point_mask_;  // the corners of cells in a row; empty: no bit of a row is set elsewhere
  std::int64_t next_layer_;
  std::int64_t end_layer_;
  std::vector<std::vector<std::uint64_t>> slices_;  // from next_layer() - below on
};

template <std::uint8_t Direction>
void CellSlab::find_along(std::ptrdiff_t n, std::size_t row, std::span<std::uint64_t> out) const {
  constexpr bool kX = (Direction & 1) != 0, kY = (Direction & 2) != 0, kZ = (Direction & 4) != 0;
  const std::span<std::uint64_t> words = out.subspan(row * words_, words_);
  if (!has_points(n, row) || (kY && !has_y(row)) || (kZ && !has_z(n))) {
    std::ranges::fill(words, 0);
    return;
  }
  const std::uint64_t* const low = inside(n, row);
  const std::uint64_t* const high = inside(kZ ? n + 1 : n, kY ? row + 1 : row);
  if constexpr (kX) {
    kernels_.differ_along(low, high, edge_mask_.data(), words_, words.data());
  } else {
    kernels_.differ(low, high, words_, words.data());
    for (std::size_t w = 0; w < point_mask_.size(); ++w) words[w] &= point_mask_[w];
  }
}

template <class Visit>
void CellSlab::for_rows(std::size_t layers, const Visit& visit) const {
  const auto count = static_cast<std::int64_t>(layers * rows_);
  executor_.for_blocks(count, kSamplesPerBlock / dims_[0] + 1, [&](std::int64_t begin, std::int64_t end) {
    std::size_t n = static_cast<std::size_t>(begin) / rows_;
    std::size_t row = static_cast<std::size_t>(begin) % rows_;
    for (auto number = static_cast<std::size_t>(begin); number < static_cast<std::size_t>(end); ++number) {
      visit(n, row, number);
      if (++row < rows_) continue;
      row = 0;
      ++n;
    }
  });
}

}  // namespace isoweave
