// Passes over rows of cells, for the instruction set of this processor. Every set gives the same bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "extract/tables.hpp"

namespace isoweave {

// A row of cells, one bit each, and the rows of samples and crossings around it, all of as many words. The ends of a
// lattice edge at some bit are corners of the cell at that bit. So an edge with a crossing makes that cell crossed,
// unless the cell lies behind the last one of the volume. From one crossed cell to the next there is therefore no
// crossing but those at the first one's bit.
struct CellRow {
  std::size_t words;
  const std::uint64_t* crossed;                   // the cells that the surface crosses
  std::array<const std::uint64_t*, 4> inside;     // samples, in the order of cell_case()
  std::array<const std::uint64_t*, 8> crossings;  // of the lattice edges, in the order of edge_row()
  std::array<const std::uint32_t*, 4> x_base;     // number of each word's first crossing along x; those along y follow
  std::array<const std::uint32_t*, 2> z_base;     // the same along z
};

// The rows of lattice edges that a row of cells touches: four along x, two along y, two along z.
constexpr std::size_t edge_row(int axis, std::size_t dy, std::size_t dz) {
  if (axis == 0) return dy + 2 * dz;
  return axis == 1 ? 4 + dz : 6 + dy;
}

// The place of a cell edge's crossing among 16 numbers: those of the crossings at the cell's bit of the eight rows,
// then those at the next bit.
constexpr std::size_t corner_place(std::size_t edge) {
  const CellEdge e = kEdgeTable[edge];
  return edge_row(e.axis, e.dy, e.dz) + 8U * e.dx;
}

// For each case, the places of its triangles' corners. Each triangle has three places; zeros follow the last one.
inline constexpr std::array<std::array<std::uint8_t, 16>, 256> kCornerPlaces = [] {
  std::array<std::array<std::uint8_t, 16>, 256> places{};
  for (std::size_t cell = 0; cell < places.size(); ++cell) {
    for (std::size_t corner = 0; corner < 3U * kCaseTable[cell].triangles; ++corner) {
      places[cell][corner] = static_cast<std::uint8_t>(corner_place(kCaseTable[cell].edges[corner]));
    }
  }
  return places;
}();

struct CellKernels {
  // Counts the triangles in the crossed cells. Reads `crossed` and `inside` only.
  std::uint32_t (*count_triangles)(const CellRow& row);

  // Writes the triangles of the crossed cells of word w, cell by cell, and the case of each of these cells. `out` has
  // room for the triangles from there to the end of the row; what lies behind those of the word may be overwritten.
  void (*write_triangles)(const CellRow& row, std::size_t w, std::span<std::array<std::uint32_t, 3>> out,
                          std::span<std::uint8_t, 64> cases);
};

// The best kernels for this processor.
const CellKernels& cell_kernels();

// All kernels that this processor can run, the best last.
std::span<const CellKernels* const> all_cell_kernels();

}  // namespace isoweave
