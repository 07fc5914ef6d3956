// The topology of the trilinear interpolant in a cell: rules for one cell after the other.
//
// Faces follow the asymptotic decider (Nielson and Hamann, 1991). Inside the cell it is enough to look along one axis:
// the bilinear interpolant on a plane across it joins two opposite corners of the plane where a quadratic in the
// plane's place has the right sign. Joins at the ends of the cell lie in faces; so a join that faces do not know needs
// an extremum between them, of which a quadratic has one. Therefore a cell has at most one tunnel. Cases were first
// told apart by Chernyaev (1995); Custodio et al. (2013) and Grosso (2016) show what is left to get wrong.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "extract/tables.hpp"
#include "lattice/vec3.hpp"

namespace isoweave {

// The values at the corners of a cell, above 0 or equal to it inside; NaN where there is no sample.
using CornerValues = std::array<double, 8>;

// A closed line of the surface on the faces of a cell, counter-clockwise seen from outside: crossings of cell edges.
using CellLoop = table_rules::Polygon;

// The topology of the surface in a cell.
struct CellTopology {
  static constexpr std::size_t kMostLoops = 4;

  std::size_t loops = 0;
  std::array<CellLoop, kMostLoops> loop{};
  // Per loop: whether no diagonals off the faces triangulate it, so that a vertex in its middle does.
  std::array<bool, kMostLoops> has_centre{};
  bool has_tunnel = false;
  std::array<std::size_t, 2> tunnel{};  // the two loops that it joins

  bool is_in_tunnel(std::size_t n) const { return has_tunnel && (tunnel[0] == n || tunnel[1] == n); }
  std::uint32_t triangles() const;
  std::uint32_t vertices() const;  // inside the cell
};

// Whether the interpolant may differ from marching cubes in a case: it has an ambiguous face, or two opposite corners
// alone are alike.
bool may_differ(std::uint32_t cell);

// The topology of a cell with such corners; `cell` says which of them are inside.
CellTopology topology_of(std::uint32_t cell, const CornerValues& values);

// The corners of the narrowest part of a tunnel, in the unit cell: the hexagon in which the six lines of the surface
// that are parallel to an axis meet (Grosso, 2016).
std::array<Vec3, 6> waist_of(const CornerValues& values);

// The interpolant at a place in the unit cell, and its gradient.
double interpolant_at(const CornerValues& values, const Vec3& at);
Vec3 interpolant_gradient(const CornerValues& values, const Vec3& at);

// The place near `start`, at least `margin` inside the unit cell, where the interpolant is 0, by two steps of Newton's
// method.
Vec3 nearby_zero(const CornerValues& values, const Vec3& start, double margin);

}  // namespace isoweave
