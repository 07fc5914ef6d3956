// The triangles that a block keeps in a run to a number of triangles: all edges at their vertices are dearer than the
// limit of the pass.
#pragma once

#include <vector>

#include "files/state_file.hpp"
#include "simplify/cost_histogram.hpp"
#include "simplify/zone_part.hpp"

namespace isoweave {

struct KeptTriangles {
  std::vector<ZonePart> parts;
  CostHistogram least;    // costs of the triangles, each no higher than those of the edges at its vertices
  CostHistogram removed;  // triangles that have gone, by the keys of the decisions

  void write(StateWriter& state);

  // Reads into one that is empty. Throws BadInput for parts that are not of that shape.
  void read(StateReader& state, const PartShape& shape);
};

}  // namespace isoweave
