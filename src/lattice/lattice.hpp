// Numbering of the padded lattice: one virtual layer of points around the samples, in closed and open mode alike.
#pragma once

#include <array>
#include <cstdint>

#include "parallel/annotations.hpp"

namespace isoweave {

// Ids of lattice edges, which are the ids of surface vertices: 3 * linear(point) + axis. Sample indices run from
// -1 to n. The pad makes every id a function of the position alone, wherever slabs are cut.
struct Lattice {
  std::array<std::int64_t, 3> dims{0, 0, 0};

  ISOWEAVE_HD std::uint64_t row() const { return static_cast<std::uint64_t>(dims[0]) + 2; }
  ISOWEAVE_HD std::uint64_t plane() const { return row() * (static_cast<std::uint64_t>(dims[1]) + 2); }

  ISOWEAVE_HD std::uint64_t edge_id(std::int64_t i, std::int64_t j, std::int64_t k, int axis) const {
    const std::uint64_t point = static_cast<std::uint64_t>(k + 1) * plane() +
                                static_cast<std::uint64_t>(j + 1) * row() + static_cast<std::uint64_t>(i + 1);
    return 3 * point + static_cast<std::uint64_t>(axis);
  }

  // An edge: its lower end and its axis.
  struct Edge {
    std::array<std::int64_t, 3> low;
    std::size_t axis;
  };

  // The edge that has an id.
  Edge edge(std::uint64_t id) const {
    const std::uint64_t point = id / 3;
    const std::uint64_t k = point / plane(), j = point % plane() / row(), i = point % row();
    return {{static_cast<std::int64_t>(i) - 1, static_cast<std::int64_t>(j) - 1, static_cast<std::int64_t>(k) - 1},
            static_cast<std::size_t>(id % 3)};
  }

  // The layer whose extraction makes the vertex of an edge: that below the slice the edge lies on, or that it crosses.
  std::int64_t layer_of(std::uint64_t edge) const {
    const auto above = static_cast<std::int64_t>(edge / (3 * plane()));
    return edge % 3 == 2 ? above - 1 : above - 2;
  }

  // Whether an edge between samples lies in a face of the volume.
  bool is_on_border(std::uint64_t edge) const;

  // Whether mesh-edge ids (256 per vertex id, see EdgeNumbering) fit in 64 bits.
  static bool fits(const std::array<std::int64_t, 3>& dims);
};

// Where a box of samples lies in a lattice.
struct PartOfLattice {
  std::array<std::int64_t, 3> dims{0, 0, 0};   // of the whole
  std::array<std::int64_t, 3> first{0, 0, 0};  // sample of it
};

}  // namespace isoweave
