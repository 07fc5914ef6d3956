// Vertex clustering, written a second time: over a whole mesh, with a map of cells, sums of long doubles, and
// elimination with pivots.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <set>

#include "isoweave/mesh.hpp"

namespace isoweave::plain {

using Cell = std::array<long, 3>;

struct Clustered {
  std::map<Cell, std::array<double, 3>> vertices;  // of cells that have triangles
  std::set<std::array<Cell, 3>> triangles;         // each from its least cell on
  double plane_rms = 0;
  std::size_t cells = 0, collapsed = 0, repeated = 0;
};

// low: the middle of the cell 0, 0, 0.
Clustered cluster(const TriangleMesh& mesh, const std::array<double, 3>& low, double side);

// The cell in which a point lies.
Cell cell_of(const Point& point, const std::array<double, 3>& low, double side);

}  // namespace isoweave::plain
