// The counts of the rows of a slab, and the places of their vertices and triangles that follow from them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "extract/surface_piece.hpp"

namespace isoweave {

// The counts of one row of a layer. place_rows() turns those of vertices and triangles into the sums over the rows
// before it.
struct RowCounts {
  std::uint32_t vertices = 0, triangles = 0;
  std::uint32_t cells = 0;      // crossed
  std::uint32_t on_border = 0;  // crossings, of an open volume
};

// The sums over all rows of a slab.
struct RowSums {
  std::uint64_t vertices = 0, triangles = 0, cells = 0, on_border = 0;
};

// The most samples of a row. A row of a layer has at most one cell more, and a cell has at most 31 triangles in all
// extractors: their count fits into 32 bits.
inline constexpr std::int64_t kMostRowSamples = std::int64_t{1} << 27;

// Throws OverMemory where so many things of a slab cannot be numbered in 32 bits.
void require_numbers(std::size_t layers, std::uint64_t count, const char* what);

// The largest number of layers of so many rows each with no more than `most_vertices` vertices in all, one at least.
std::size_t layers_within(std::span<const RowCounts> rows, std::size_t rows_of_layer, std::uint64_t most_vertices);

// Gives every row the places where its vertices and triangles begin. Vertices are numbered after the `inherited` ones.
// Throws OverMemory where numbers of 32 bits are not enough for a slab of `layers` layers.
RowSums place_rows(std::span<RowCounts> rows, std::size_t layers, std::uint32_t inherited);

// The same, with one row more after the last, and with room for vertices and triangles in the piece.
void make_room(std::vector<RowCounts>& rows, std::size_t layers, bool normals, SurfacePiece& piece);

}  // namespace isoweave
