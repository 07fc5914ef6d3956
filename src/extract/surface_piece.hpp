// A piece: the part of a surface that an extractor hands over. No later part of the loop knows how it was made.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "isoweave/mesh.hpp"
#include "lattice/vec3.hpp"
#include "parallel/array.hpp"

namespace isoweave {

// Vertices 0...inherited-1 are the previous piece's `incomplete`, in its order. New vertices follow. Triangles come in
// the order in which quadrics are summed. Indices have 32 bits: a piece holds fewer than 2^32 vertices.
struct SurfacePiece {
  std::uint32_t inherited = 0;
  Array<Vec3> positions;                                            // of new vertices, physical lengths
  Array<std::uint64_t> ids;                                         // of new vertices, unique in the whole surface
  Array<Point> normals;                                             // of new vertices, unit or zero, outwards; or none
  Array<float> values;                                              // of new vertices, or none
  Array<std::array<std::uint32_t, 3>> triangles;                    // counter-clockwise seen from outside
  std::vector<std::uint32_t> incomplete;                            // vertices that later pieces give more triangles
  double complete_below = std::numeric_limits<double>::infinity();  // z: no later piece has a point below it
  bool manifold = true;  // a promise; without it vertices where the surface is not an oriented manifold are locked
  std::uint64_t cells_crossed = 0;
  std::uint64_t open_edges = 0;  // of the whole surface, among the new vertices: one for each on a border

  void clear() {
    inherited = 0;
    cells_crossed = 0;
    open_edges = 0;
    positions.resize(0);
    ids.resize(0);
    normals.resize(0);
    values.resize(0);
    triangles.resize(0);
    incomplete.clear();
    complete_below = std::numeric_limits<double>::infinity();
    manifold = true;
  }
};

}  // namespace isoweave
