// Counts of a mesh at some of its vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave {

// The counts of the edges with an end among some vertices, and of these vertices; the terms are those of MeshCheck.
struct AroundCheck {
  std::uint64_t sides = 0;  // of triangles, along these edges
  std::uint64_t edges = 0, open_edges = 0, nonmanifold_edges = 0, misoriented_edges = 0;
  std::uint64_t nonmanifold_vertices = 0;
};

// among: per vertex, nonzero for the vertices to look at. All triangles around these must be in the mesh, others need
// not be.
AroundCheck check_around(const TriangleMesh& mesh, const std::vector<std::uint8_t>& among);

}  // namespace isoweave
