// The padded lattice: one virtual layer of points around the samples, in closed and open mode alike.
#pragma once

#include <array>
#include <cstdint>

#include "parallel/annotations.hpp"

namespace isoweave {

// Points are numbered row by row, plane by plane. Sample indices run from -1 to n. The pad makes every number a
// function of the position alone, wherever slabs are cut.
struct Lattice {
  std::array<std::int64_t, 3> dims{0, 0, 0};

  ISOWEAVE_HD std::uint64_t row() const { return static_cast<std::uint64_t>(dims[0]) + 2; }
  ISOWEAVE_HD std::uint64_t plane() const { return row() * (static_cast<std::uint64_t>(dims[1]) + 2); }

  ISOWEAVE_HD std::uint64_t point(std::int64_t i, std::int64_t j, std::int64_t k) const {
    return static_cast<std::uint64_t>(k + 1) * plane() + static_cast<std::uint64_t>(j + 1) * row() +
           static_cast<std::uint64_t>(i + 1);
  }

  // The sample indices of a point.
  std::array<std::int64_t, 3> place(std::uint64_t point) const {
    const std::uint64_t k = point / plane(), j = point % plane() / row(), i = point % row();
    return {static_cast<std::int64_t>(i) - 1, static_cast<std::int64_t>(j) - 1, static_cast<std::int64_t>(k) - 1};
  }
};

// The place of a box of samples in a lattice.
struct PartOfLattice {
  std::array<std::int64_t, 3> dims{0, 0, 0};   // of the whole
  std::array<std::int64_t, 3> first{0, 0, 0};  // sample of it
};

// A box of cells, [first, end) along each axis. Cell (i, j, k) lies between samples (i, j, k) and (i + 1, j + 1, k +
// 1).
struct CellBox {
  std::array<std::int64_t, 3> first{0, 0, 0};
  std::array<std::int64_t, 3> end{0, 0, 0};

  // The cells of a volume. Closed: those between samples and pad as well.
  static CellBox of_volume(const std::array<std::int64_t, 3>& dims, bool closed) {
    const std::int64_t pad = closed ? 1 : 0;
    return {{-pad, -pad, -pad}, {dims[0] - 1 + pad, dims[1] - 1 + pad, dims[2] - 1 + pad}};
  }

  bool empty() const { return first[0] >= end[0] || first[1] >= end[1] || first[2] >= end[2]; }

  // Whether cell `at` of an axis is in the box, and whether a lattice point is a corner of one.
  bool has_cell(std::size_t axis, std::int64_t at) const { return at >= first[axis] && at < end[axis]; }
  bool has_point(std::size_t axis, std::int64_t at) const { return at >= first[axis] && at <= end[axis]; }
};

}  // namespace isoweave
