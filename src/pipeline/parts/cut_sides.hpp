// The sides at which a block is cut from the rest of a surface.
#pragma once

#include <cstdint>
#include <vector>

#include "extract/surface_piece.hpp"
#include "lattice/lattice.hpp"
#include "lattice/vertex_numbering.hpp"

namespace isoweave {

// Tells by its id where a vertex of a block lies.
struct BlockSides {
  VertexNumbering numbering;
  CellBox cells;  // of the block
  CellBox all;    // of the volume

  // Whether the vertex lies in a plane between this block and another one: triangles of it are there.
  bool is_cut(std::uint64_t id) const;

  // Whether the vertex is counted here, of all blocks that have it.
  bool is_own(std::uint64_t id) const;

  // Whether two neighbours lie in one face of an open volume. An edge of one triangle is on the border of the surface
  // then, as no diagonal lies in a face of a cell.
  bool on_border(std::uint64_t a, std::uint64_t b) const;

 private:
  bool lies_at(const VertexNumbering::Place& place, std::size_t axis, std::int64_t plane) const {
    return !place.along(axis) && place.low[axis] == plane;
  }
};

// Keeps the vertices at cuts incomplete: from piece to piece each inherits them, and none adds to them.
class CutSides {
 public:
  explicit CutSides(const BlockSides& sides) : sides_(sides) {}

  // Takes the next piece of the block.
  void apply(SurfacePiece& piece);

  // The vertices so far that are counted in another block.
  std::uint64_t foreign() const { return foreign_; }

 private:
  std::vector<std::uint32_t> list_cut(const SurfacePiece& piece, std::vector<std::uint32_t>& places);

  BlockSides sides_;
  std::uint32_t cut_ = 0;             // vertices at cuts so far: the first ones that the next piece inherits
  std::uint32_t inherited_ = 0;       // with those of the front
  std::vector<std::uint32_t> names_;  // what the vertices are called that the extractor inherits
  std::uint64_t foreign_ = 0;
};

}  // namespace isoweave
