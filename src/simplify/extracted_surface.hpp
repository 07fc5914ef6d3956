// The surface as it was extracted, around the undecided zone: what a guaranteed distance is measured from.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "measure/geometry.hpp"
#include "parallel/array.hpp"
#include "simplify/reach.hpp"
#include "slab/vec3.hpp"

namespace isoweave {

// The triangles of a surface that comes in pieces, ordered by z, in a grid of cells, for one question: is every point
// of a triangle within a distance of them? The answer, once it is known, depends on the whole surface alone, not on the
// pieces.
class ExtractedSurface {
 public:
  using Corners = measure::TriangleCorners;

  // most: the distance, above 0. cell: lengths of a box in which there are a few triangles.
  ExtractedSurface(double most, const Vec3& cell);

  // The layer of cells that holds z.
  double layer_of(double z) const { return std::floor(z / cell_[2] + kShift); }

  // Takes the triangles of a piece. No later piece has a point below `complete_below`.
  void append(const Array<Corners>& triangles, double complete_below);

  // Questions will be about triangles in the layer of z and above.
  void forget_below(double z);

  // Whether all of a triangle lies within the distance. It is cut at its longest side until the corners of each part
  // are within the distance of one and the same triangle of the surface, and with them, as that is convex, the part.
  // Parts smaller than a sixteenth of the distance are not cut again. So what is within 15/16 of the distance is always
  // found to be, and nothing beyond it ever is. May be called by several threads at the same time.
  Reach reach(const Vec3& a, const Vec3& b, const Vec3& c) const;

  std::uint64_t bytes() const;

  // What is held between two appends.
  template <class Archive>
  void exchange(Archive& archive) {
    std::uint64_t count = pieces_.size();
    archive.value(count);
    archive.value(complete_below_);
    if constexpr (Archive::kReads) pieces_.clear();
    for (std::uint64_t n = 0; n < count; ++n) {
      if constexpr (Archive::kReads) pieces_.emplace_back();
      Piece& piece = pieces_[n];
      archive.list(piece.triangles);
      archive.list(piece.slots);
      archive.value(piece.listed);
      archive.value(piece.first_layer);
      archive.value(piece.last_layer);
      archive.value(piece.top);
    }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  // Of the layers that layer_of() tells apart: not where surfaces like to lie, on slices or halfway between them.
  static constexpr double kShift = 0.382;

  // A cell that holds triangles of its piece.
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t first = 0, count = 0;  // none: the slot is free
  };

  // A triangle in a cell.
  struct Place {
    std::uint64_t key;
    std::uint32_t triangle;
  };

  struct Piece {
    Array<Corners> triangles;  // one cell after the other, in each that it may touch; then those in too many cells
    std::vector<Slot> slots;   // a hash table with open addresses
    std::uint64_t listed = 0;  // triangles that are in cells
    std::int64_t first_layer = std::numeric_limits<std::int64_t>::max();  // of cells
    std::int64_t last_layer = std::numeric_limits<std::int64_t>::min();
    double top = -std::numeric_limits<double>::infinity();  // z
  };

  // A part of the triangle that is asked about.
  struct Part {
    Corners corners;
    measure::Vector centre;
    double radius;  // of the ball around the centre that holds it
  };

  enum class Found : std::uint8_t { kNothing, kCentre, kAll };  // what is within the distance of some triangle

  static Part part_of(const Corners& corners);
  Cell cell_of(const measure::Vector& p) const;
  static std::uint64_t key_of(const Cell& cell);
  template <class Visit>
  bool each_cell(const Corners& triangle, const Visit& visit) const;
  static void make_slots(Piece& piece, std::span<const Place> places);
  static std::size_t slot_of(const Piece& piece, std::uint64_t key);
  Found find(const Part& part) const;
  Found find_in_ring(const Part& part, const Cell& centre, std::int64_t ring) const;
  Found find_in_cell(const Part& part, const Cell& cell) const;
  Found find_among(const Part& part, std::span<const Corners> triangles) const;

  double most_;
  std::array<double, 3> cell_;
  double complete_below_ = -std::numeric_limits<double>::infinity();
  std::vector<Piece> pieces_;
};

}  // namespace isoweave
