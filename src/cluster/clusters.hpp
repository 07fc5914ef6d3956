// Vertex clustering (Rossignac and Borrel, 1993) with quadrics (Lindstrom, 2000), piece by piece: the vertices of a
// surface that lie in one cell become one, at the place nearest to the planes of the triangles there.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cluster/cell_grid.hpp"
#include "cluster/cell_sum.hpp"
#include "cluster/cell_table.hpp"
#include "extract/piece_stage.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

// The surface of the clusters. Vertices are in the order in which the surface met their cells, triangles in that of
// their vertices, each from its least vertex on: the same for any pieces.
struct ClusteredSurface {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // The root of the mean square of the distances between vertices and the planes of the triangles that had a corner in
  // their cells, by area.
  double rms = 0;
  std::uint64_t cells = 0;      // that the surface occupies; some have no vertex
  std::uint64_t collapsed = 0;  // triangles dropped, as two corners are in one cell
  std::uint64_t repeated = 0;   // triangles dropped, as another one has the same corners in the same direction
};

// A stage that keeps occupied cells, and the triangles with corners in three of them. Pieces leave it as they came.
class Clusters final : public PieceStage {
 public:
  Clusters(const CellGrid& grid, const Executor& executor) : grid_(grid), executor_(executor) {}

  // Takes the next piece. Throws OverMemory at 2^32 - 1 cells.
  void apply(SurfacePiece& piece) override;

  // The surface, once all pieces have come. Must be called once only.
  ClusteredSurface finish();

  std::uint64_t bytes() const override;

  // Throw std::logic_error: no state is saved of a preview.
  void serialize(StateWriter& state) const override;
  void serialize(StateReader& state) override;

 private:
  using Corners = std::array<std::uint32_t, 3>;

  void find_cells(const SurfacePiece& piece);
  void sum_planes(const SurfacePiece& piece);
  void keep_triangles();
  void drop_repeated();
  void list_front(const SurfacePiece& piece);
  std::vector<std::uint32_t> cells_with_triangles() const;
  void place(const std::vector<std::uint32_t>& cells, ClusteredSurface& surface) const;

  const CellGrid grid_;
  const Executor& executor_;
  CellTable table_;
  Array<CellSum> sums_;             // by cell
  std::vector<Corners> triangles_;  // of three cells each, from the least one on
  std::size_t different_ = 0;       // of them, when repeated ones were dropped last
  std::uint64_t collapsed_ = 0, repeated_ = 0;

  // The vertices of the piece, then those that the next piece inherits.
  std::vector<Vec3> positions_;
  std::vector<std::uint32_t> cells_;
  Array<std::uint64_t> keys_;  // of new vertices
  Array<Corners> corners_;     // cells of the corners of the piece's triangles
  std::vector<Corners> kept_;
};

}  // namespace isoweave
