// How the vertices of a surface are numbered: the contract between the source of a surface and all that follows.
//
// An id tells where a vertex lies, or its place in a file, and nothing of when or in which piece it came. It is unique
// in the whole surface. Everything whose order must not depend on pieces goes by ids: ties, sums around a vertex, the
// two ends of an edge.
#pragma once

#include <array>
#include <cstdint>

#include "lattice/lattice.hpp"
#include "parallel/annotations.hpp"

namespace isoweave {

struct VertexNumbering {
  static constexpr std::uint32_t kMostSlots = 16;

  Lattice lattice{};
  // Ids per point of the lattice, one for each kind of vertex that a source has there; 0: ids are positions in a file,
  // below 2^32.
  std::uint32_t slots = 0;
  std::uint32_t width = 0;  // ids of mesh edges per id of a vertex
  // Per slot, bits x, y and z: the vertex lies between its point and the one that is further along these axes.
  std::array<std::uint8_t, kMostSlots> directions{};
  std::uint32_t border_slots = kMostSlots;  // from this slot on, vertices lie on the border of the surface, wherever

  // Vertices on the edges of the lattice's cubes, one for each of the three edges that begin at a point.
  static VertexNumbering of_cube_edges(const std::array<std::int64_t, 3>& dims);

  // Vertices on the edges of Kuhn's tetrahedra, one for each of the seven edges that begin at a point.
  static VertexNumbering of_kuhn_edges(const std::array<std::int64_t, 3>& dims);

  // Vertices on the edges of cubes, and seven inside the cube that begins at a point.
  static VertexNumbering of_cubes(const std::array<std::int64_t, 3>& dims);

  // Vertices inside cubes alone. The last eight of a cube are those on the border of the surface.
  static VertexNumbering of_dual_cubes(const std::array<std::int64_t, 3>& dims);

  // Vertices of a mesh file.
  static VertexNumbering of_file() { return {}; }

  // Whether ids of mesh edges fit into 64 bits.
  bool fits() const;

  ISOWEAVE_HD std::uint64_t id(std::int64_t i, std::int64_t j, std::int64_t k, std::uint32_t slot) const {
    return slots * lattice.point(i, j, k) + slot;
  }

  // Where the vertex with an id lies: its point, and the bits of its direction.
  struct Place {
    std::array<std::int64_t, 3> low;
    std::uint8_t direction;

    bool along(std::size_t axis) const { return (direction >> axis & 1) != 0; }
  };
  Place place(std::uint64_t id) const {
    return {lattice.place(id / slots), directions[static_cast<std::size_t>(id % slots)]};
  }

  // The layer whose extraction makes a vertex: that below the slice it lies on, or that in which it lies.
  std::int64_t layer_of(std::uint64_t id) const;

  // Whether a vertex between samples lies in a face of the volume.
  bool is_on_border(std::uint64_t id) const;

  // The id of a mesh edge, from the ids of its ends, which come in any order. On a lattice the points of the two differ
  // by -1, 0 or 1 along each axis: the smaller id and one of fewer than `width` differences name the edge.
  ISOWEAVE_HD std::uint64_t edge_id(std::uint64_t a, std::uint64_t b) const {
    const std::uint64_t low = a < b ? a : b;
    const std::uint64_t high = a < b ? b : a;
    if (slots == 0) return low << 32 | high;
    // Made positive, and taken apart in mixed radix: each digit is below 4 as row, plane / row >= 3.
    const std::uint64_t row = lattice.row();
    const std::uint64_t plane = lattice.plane();
    const std::uint64_t step = high - low + (slots - 1) + slots * (1 + row + plane);
    const std::uint64_t points = slots == 3 ? step / 3 : step / slots;  // a constant divides faster
    const std::uint64_t slot = step - points * slots;
    const std::uint64_t z = quotient(points, plane);
    const std::uint64_t y = quotient(points - z * plane, row);
    const std::uint64_t x = points - z * plane - y * row;
    return low * width + slot + slots * (x + 4 * (y + 4 * z));
  }

 private:
  // a / b where that is below 4: a division takes longer.
  ISOWEAVE_HD static std::uint64_t quotient(std::uint64_t a, std::uint64_t b) {
    return std::uint64_t{a >= b} + std::uint64_t{a >= 2 * b} + std::uint64_t{a >= 3 * b};
  }
};

}  // namespace isoweave
