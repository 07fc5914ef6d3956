// The extracted surface around the undecided zone: a guaranteed distance is measured from it.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "files/state_file.hpp"
#include "lattice/triangles.hpp"
#include "lattice/vec3.hpp"
#include "parallel/array.hpp"
#include "simplify/kernels.hpp"
#include "simplify/reach.hpp"

namespace isoweave {

// The triangles of a surface that comes in pieces, ordered by z, in grids of cells, for one question: is every point of
// a triangle within a distance of them? The answer, once it is known, depends on the whole surface alone, not on the
// pieces. The cost of an answer is bounded: no more than kMostParts parts of a triangle are looked at, each among the
// triangles in a few cells of the few pieces that are near in z, however many there are; wide parts among the few
// hundred at most that come near them. A triangle is listed in the cells that it touches, so the triangles of a cell
// come near each other, whatever their shape and direction.
class ExtractedSurface {
 public:
  using Corners = measure::TriangleCorners;

  // The facts about a triangle that reach() finds out besides its answer.
  struct Looked {
    std::uint64_t comparisons = 0;  // of a part with a triangle
    double farthest = 0;            // where it is within the distance: the distance of all its points, or more
  };

  // most: the distance, above 0. cell: lengths of a box in which there are a few triangles. largest: lengths of a box
  // that no triangle exceeds.
  ExtractedSurface(double most, const Vec3& cell, const Vec3& largest);

  // The layer of cells that holds z.
  double layer_of(double z) const { return std::floor(z / cell_[2] + kShift); }

  // Takes the triangles of a piece, which name vertices by their places in `positions`. No later piece has a point
  // below `complete_below`.
  void append(Array<Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles, double complete_below);

  // Forgets triangles that are not needed for questions about the layer of z and above.
  void forget_below(double z);

  // Whether all of a triangle lies within a distance, which must be no larger, but for rounding, than the one that was
  // named first; unknown where later pieces may come within it. The triangle is cut at its longest side until the
  // corners of each part are within the distance of one and the same triangle of the surface. The points within the
  // distance of a triangle form a convex set, so all of the part is within it then. Parts smaller than a sixteenth of
  // the distance are not cut again. So a triangle that is within kSure of the distance is always found to be within it,
  // unless that takes more parts than kMostParts. A triangle beyond the distance never is. A wide part is not cut where
  // the surface is seen to lie above or below all of it within kSure of the distance (ProjectedSurface). May be called
  // by several threads at the same time. looked: unless null, what there is to know besides.
  Reach reach(const Vec3& a, const Vec3& b, const Vec3& c, double most, Looked* looked = nullptr) const;

  // Whether a point is known to lie beyond a distance, as for reach().
  bool is_beyond(const Vec3& p, double most) const;

  std::uint64_t bytes() const;

  // The triangles between two appends: written, and read into an empty surface. Throws BadInput for corners farther
  // away from 0 than `farthest` along an axis.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state, const Vec3& farthest);

  // The share of a distance within which all is sure to be found near.
  static constexpr double kSure = 0.937;

 private:
  using Cell = std::array<std::int64_t, 3>;

  // The shift of the layers that layer_of() tells apart: their borders do not lie where surfaces like to lie, on slices
  // or halfway between them.
  static constexpr double kShift = 0.382;

  static constexpr int kLastLevel = 63;  // of grids

  // The most parts of one triangle that is asked about.
  static constexpr int kMostParts = 1 << 14;

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
    Array<Vec3> positions;
    Array<std::array<std::uint32_t, 3>> triangles;
    Array<std::uint32_t> listed;                                // triangles of one cell after the other
    std::vector<Slot> slots;                                    // a hash table with open addresses
    std::uint64_t levels = 0;                                   // bit n: grid n has triangles
    double top = -std::numeric_limits<double>::infinity();      // z
    double highest = -std::numeric_limits<double>::infinity();  // of this piece and of all before it
    double lowest = std::numeric_limits<double>::infinity();    // of this piece and of all behind it
  };

  // A triangle of some piece, or none.
  struct Named {
    const Piece* piece = nullptr;
    std::uint32_t triangle = 0;
  };

  // A part of the triangle that is asked about.
  struct Part {
    Corners corners;
    measure::Vector centre;
    FourPoints points;               // the corners and the centre
    double radius;                   // of the ball around the centre that holds it, squared
    double most;                     // distance
    std::uint64_t* looks = nullptr;  // counts comparisons, where given
    double* nearest = nullptr;       // the least distance that all corners have from a triangle, where asked for
    Named* last = nullptr;  // the triangle that an earlier part was near, or none, and then the one of this part

    bool is_below(double length) const { return radius <= length * length; }
  };

  class Look;

  enum class Found : std::uint8_t { kNothing, kCentre, kAll };  // what is within the distance of some triangle

  // The cells from one to another, in a grid of some level. Cells of level 0 have the length that was asked for; those
  // of each other level are four times as long as those of the level below.
  struct CellBox {
    Cell first{}, last{};
    double cells() const;
    double longest() const;
  };

  // Calls visit(cell) for all cells of a box, until visit() answers false.
  template <class Visit>
  static void each_cell(const CellBox& box, const Visit& visit) {
    Cell cell = box.first;
    for (cell[2] = box.first[2]; cell[2] <= box.last[2]; ++cell[2]) {
      for (cell[1] = box.first[1]; cell[1] <= box.last[1]; ++cell[1]) {
        for (cell[0] = box.first[0]; cell[0] <= box.last[0]; ++cell[0]) {
          if (!visit(cell)) return;
        }
      }
    }
  }

  static Part part_of(const Corners& corners, double most);
  bool is_long(const Part& part) const;
  double length(int level, std::size_t axis) const { return lengths_[static_cast<std::size_t>(level)][axis]; }
  Cell cell_of(const measure::Vector& p, int level) const;
  bool is_near(const Part& part, int level, const Cell& cell) const;
  CellBox cells_of(const Corners& triangle, int level) const;
  CellBox cells_around(const Part& part, int level) const;
  static std::uint64_t key_of(int level, const Cell& cell);
  template <class Visit>
  void each_touched(const Corners& triangle, const CellBox& box, int level, const Visit& visit) const;
  int list_in_cells(const Corners& triangle, std::uint32_t number, std::vector<Place>& places) const;
  static void make_slots(Piece& piece, std::span<const Place> places);
  static void fill_slots(Piece& piece, std::span<const Place> places);
  static std::size_t slot_of(const Piece& piece, std::uint64_t key);
  void push_piece(Piece&& piece);
  std::span<const Piece> pieces_between(double low, double high) const;
  Found find(const Part& part) const;
  bool is_beyond(const measure::Vector& p, double most) const;
  Found find_above(const Part& part, std::span<const Piece> pieces) const;
  Found find_in_ring(const Part& part, const Cell& centre, std::int64_t ring, std::span<const Piece> pieces) const;
  Found find_in_cell(const Part& part, std::uint64_t key, std::span<const Piece> pieces) const;
  static Corners corners_of(const Piece& piece, std::uint32_t number);
  static void measure_corners(const Part& part, const std::array<Vec3, 3>& triangle);
  Found find_near(const Part& part, const Piece& piece, std::uint32_t number, Found known) const;

  const Kernels& kernels_ = kernels();
  double most_;
  std::array<double, 3> cell_;
  std::array<std::array<double, 3>, kLastLevel + 1> lengths_{};  // of the cells of each grid
  std::array<double, 3> largest_;
  double complete_below_ = -std::numeric_limits<double>::infinity();
  std::vector<Piece> pieces_;
};

}  // namespace isoweave
