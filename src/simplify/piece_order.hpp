// The order in which the zone holds a piece. Sources make pieces layer by layer and row by row. In that order, passes
// and walks around vertices would find neighbours as far apart in memory as a layer is large.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "extract/surface_piece.hpp"
#include "parallel/bucket.hpp"
#include "parallel/parallel.hpp"
#include "simplify/zone_view.hpp"

namespace isoweave {

// Groups the new vertices and the triangles of a piece by columns. Within a column the order stays.
class PieceOrder {
 public:
  // front: the inherited vertices, by their numbers in the zone, which they keep.
  void sort(const SurfacePiece& piece, const ZoneView& zone, std::span<const Index> front, const Executor& executor);

  // The triangles in their new order, with the new numbers of their vertices.
  std::span<const std::array<std::uint32_t, 3>> triangles() const { return {triangles_.data(), triangles_.size()}; }

  // The triangles of column c: from column_starts()[c] to column_starts()[c + 1].
  std::span<const std::size_t> column_starts() const { return by_column_.start; }

  // The new vertices of column c, likewise.
  std::span<const std::size_t> vertex_column_starts() const { return new_vertices_.start; }

  // The place of the n-th new vertex in the piece.
  std::uint32_t place_of_vertex(std::size_t n) const { return new_vertices_.items[n]; }

  // The new number of a vertex, from its number in the piece.
  std::uint32_t number(std::uint32_t in_piece) const { return numbers_[in_piece]; }

  std::uint64_t bytes() const;

 private:
  void find_columns(const SurfacePiece& piece, const ZoneView& zone, std::span<const Index> front,
                    const Executor& executor);
  void number_vertices(const SurfacePiece& piece, const Executor& executor);
  void move_triangles(const SurfacePiece& piece, const Executor& executor);

  std::vector<std::uint16_t> columns_;  // of all vertices
  Buckets new_vertices_;
  Buckets by_column_;  // triangles
  std::vector<std::uint32_t> numbers_;
  Array<std::array<std::uint32_t, 3>> triangles_;
};

}  // namespace isoweave
