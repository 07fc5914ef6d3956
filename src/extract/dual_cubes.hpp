// Dual marching cubes over slabs of layers (Nielson, 2004; dual_table.hpp).
//
// With a layer come the vertices in its cells, and the triangles around the lattice edges in the layer and on the slice
// below it. So vertices of the layer below the slab are asked for once more: its cells are found again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "extract/cell_slab.hpp"
#include "extract/crossing_planes.hpp"
#include "extract/dual_table.hpp"
#include "extract/edge_extractor.hpp"
#include "extract/extractor.hpp"
#include "extract/row_counts.hpp"
#include "extract/surface_piece.hpp"

namespace isoweave {

class DualCubes final : public Extractor {
 public:
  // Throws OverMemory for rows of more than kMostRowSamples.
  DualCubes(const VolumeInfo& volume, const ExtractOptions& options, const Executor& executor);

  VertexNumbering numbering() const override { return numbering_; }
  std::int64_t layers_left() const override { return slab_.layers_left(); }
  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override;

  // Throws OverMemory when the slab holds 2^32 vertices or triangles, or more.
  SlabCounts extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                     SurfacePiece& piece) override;

  std::uint64_t inherited() const override { return front_size_; }
  void serialize(StateWriter& state) const override { slab_.serialize(state); }
  void serialize(StateReader& state) override;

 private:
  // A cell that the surface crosses.
  struct Cell {
    std::uint32_t first = 0;  // number of its first vertex; below the slab, of those that are incomplete
    std::uint8_t inside = 0;  // its case
    CellSides border = 0;     // sides in the border of an open volume
    std::int8_t face = -1;    // the lower face whose vertex belongs to it
  };

  // A row of cells, or of points: layers count from the one below the slab.
  struct Row {
    std::size_t layer, row;
  };

  // The cell whose corner 0 is a bit of a row.
  struct Place {
    Row at;
    std::ptrdiff_t bit;
  };

  struct Polygon;
  class VertexMaker;

  std::size_t number_of(const Row& at) const { return at.layer * slab_.rows() + at.row; }
  std::ptrdiff_t slice_of(const Row& at) const { return static_cast<std::ptrdiff_t>(at.layer) - 1; }

  void find_cells(std::size_t layers);
  void fill_cells(const Row& at);
  int case_of(const Row& at, std::ptrdiff_t bit) const;
  CellSides border_of(const Row& at, std::ptrdiff_t bit) const;
  int face_of(const Row& at, std::ptrdiff_t bit, const Cell& cell) const;
  const Cell& cell_at(const Row& at, std::ptrdiff_t bit) const;
  static DualVertices vertices_of(const Cell& cell) { return {cell.inside, cell.border, cell.face}; }
  template <class Visit>
  void for_cells_of(const Row& at, const Visit& visit);

  std::uint32_t number_inherited();
  void list_front(std::size_t layer, SurfacePiece& piece);
  void count_rows(std::size_t layers);
  void count_vertices(const Row& at);
  void add_extra(const Row& at, const DualVertex& vertex);
  std::uint64_t crossings(const Row& at, int axis, std::size_t w) const;
  void make_vertices(std::size_t layers, SurfacePiece& piece);
  void make_front(const Row& at);
  static Place moved(const Place& from, int axis, int steps);
  std::optional<std::uint32_t> vertex_at(const Place& place, int edge, bool in_face) const;
  Polygon polygon_around(const Place& place, int axis) const;
  std::size_t first_corner(const Polygon& polygon, const SurfacePiece& piece) const;
  void write_triangles(const Row& at, SurfacePiece& piece) const;

  VertexNumbering numbering_;          // of the whole
  std::array<std::int64_t, 3> first_;  // sample in it
  std::array<double, 3> spacing_;
  ExtractOptions options_;
  CellSlab slab_;
  std::vector<std::uint64_t> inner_points_;  // per word of a row: with cells on both sides
  // Of the layer below the slab and those of the slab:
  CrossingPlanes planes_;
  std::vector<std::uint64_t> crossed_;     // cells, in words
  std::vector<std::uint32_t> first_cell_;  // per word: the place of its first cell in the list
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> extra_;  // per row of points: vertices in faces, at each edge that they lie on
  std::vector<RowCounts> rows_;       // of the slab alone; one more follows the last row
  std::vector<Vec3> front_places_;    // of the inherited vertices
  std::uint32_t front_size_ = 0;
};

}  // namespace isoweave
