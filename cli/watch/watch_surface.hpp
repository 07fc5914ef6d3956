// Triangles to be looked at while they come: on a grid, and no more of them than can be drawn.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "page/view_grid.hpp"

namespace isoweave::cli {

// The point that stands for a cubic cell. The table has open addresses, as it is looked up three times for each
// triangle that is kept.
class CellTable {
 public:
  using Place = GridPoint;

  std::size_t size() const { return size_; }

  // The first point that came in the cell of `place`, where cells have so many bits less.
  Place first_in_cell(const Place& place, int bits);

 private:
  struct Slot {
    std::uint64_t cell = kEmpty;
    Place first{};
  };
  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

  Slot& slot_of(std::uint64_t cell);
  void grow();

  std::vector<Slot> slots_;
  std::size_t size_ = 0;
};

// A surface that stays below a number of triangles. Each time there would be more, the vertices within a cell become
// one (Rossignac and Borrel 1993, Multi-resolution 3D approximations), and triangles that have become edges or points
// are dropped. The first cells are as wide as the edges are long, then twice as wide each time. Until then triangles
// stay as they came.
class CoarseSurface {
 public:
  // Cells of 2^bits steps to begin with; 0: none.
  explicit CoarseSurface(std::size_t most_triangles, int bits = 0) : most_(most_triangles), bits_(bits) {}

  void add(const GridTriangle& triangle);

  std::span<const GridTriangle> triangles() const { return triangles_; }
  int bits() const { return bits_; }

  // Marks the present triangles, to tell later what has become of them.
  void mark() { marked_ = triangles_.size(); }
  std::span<const GridTriangle> marked() const { return triangles().first(marked_); }

 private:
  bool snap(GridTriangle& triangle);
  bool is_full() const;
  int first_bits() const;
  void coarsen();

  std::size_t most_;
  int bits_;
  CellTable cells_;
  std::vector<GridTriangle> triangles_;
  std::size_t marked_ = 0;
};

}  // namespace isoweave::cli
