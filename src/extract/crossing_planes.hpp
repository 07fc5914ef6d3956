// The tangent planes of the surface at the crossings of a slab's cube edges. Up to four cells ask for each of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "extract/cell_slab.hpp"
#include "isoweave/mesh.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

struct CrossingPlane {
  double t;      // of the crossing, from the lower end of its edge on
  Point normal;  // unit, outwards, or zero
};

// Slices count from the one below the slab: slice n is next_layer() - 1 + n. Crossings are bits in words, as in
// EdgeExtractor.
class CrossingPlanes {
 public:
  // Finds the crossings of so many slices; of the last one, those along x and y alone.
  void find(const CellSlab& slab, std::size_t slices);

  // Makes the planes of the first so many slices. Throws OverMemory for 2^32 of them or more.
  void make(const CellSlab& slab, const SliceWindow& window, const std::array<double, 3>& spacing, std::size_t slices);

  // The crossings of the edges along an axis that begin in a row of points, in words.
  const std::uint64_t* along(std::size_t axis, std::size_t slice, std::size_t row) const {
    return &along_[axis][(slice * rows_ + row) * words_];
  }

  // The plane at the edge along an axis that begins at a bit of a row. It has to be crossed.
  const CrossingPlane& plane(std::size_t axis, std::size_t slice, std::size_t row, std::size_t bit) const {
    const std::size_t word = (slice * rows_ + row) * words_ + bit / 64;
    std::uint64_t number = first_in_word_[word];
    for (std::size_t before = 0; before < axis; ++before) number += ones(along_[before][word]);
    return planes_[number + ones(along_[axis][word] & ((std::uint64_t{1} << bit % 64) - 1))];
  }

 private:
  void place_rows(std::size_t slices);
  template <class MakePlane>
  void make_row(std::size_t slice, std::size_t row, const MakePlane& make_plane);

  std::size_t rows_ = 0, words_ = 0;
  std::array<std::vector<std::uint64_t>, 3> along_;
  std::vector<std::uint64_t> first_in_row_;   // before place_rows(): how many there are
  std::vector<std::uint32_t> first_in_word_;  // number of the first crossing, direction by direction
  std::vector<CrossingPlane> planes_;
};

}  // namespace isoweave
