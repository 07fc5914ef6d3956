// The lattice edges whose crossings are vertices. An edge begins at a point of the lattice and ends one step further
// along the axes of its direction: bit 0 for x, bit 1 for y, bit 2 for z.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lattice/vertex_numbering.hpp"

namespace isoweave {

// The edges of the lattice's cubes.
struct CubeEdges {
  static constexpr std::array<std::uint8_t, 2> kOnSlice{1, 2};  // both ends on one slice
  static constexpr std::array<std::uint8_t, 1> kInLayer{4};     // from one slice to the next

  static VertexNumbering numbering(const std::array<std::int64_t, 3>& dims) {
    return VertexNumbering::of_cube_edges(dims);
  }
};

// The edges of the six tetrahedra around the diagonal of each cube (Kuhn, 1960): those of the cubes, the diagonals of
// faces that ascend along both axes, and the diagonal.
struct KuhnEdges {
  static constexpr std::array<std::uint8_t, 3> kOnSlice{1, 2, 3};
  static constexpr std::array<std::uint8_t, 4> kInLayer{4, 5, 6, 7};

  static VertexNumbering numbering(const std::array<std::int64_t, 3>& dims) {
    return VertexNumbering::of_kuhn_edges(dims);
  }
};

// The slot of a direction among the ids of a point: directions on a slice come first.
template <class Edges>
constexpr std::uint32_t slot_of_direction(std::uint8_t direction) {
  std::uint32_t slot = 0;
  for (const std::uint8_t other : Edges::kOnSlice) {
    if (other == direction) return slot;
    ++slot;
  }
  for (const std::uint8_t other : Edges::kInLayer) {
    if (other == direction) return slot;
    ++slot;
  }
  return slot;
}

}  // namespace isoweave
