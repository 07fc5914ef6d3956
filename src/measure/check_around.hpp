// Counts of a mesh at some of its vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave {

// Of the edges with an end among the vertices, and of the vertices; the terms are those of MeshCheck.
struct AroundCheck {
  std::uint64_t sides = 0;  // of triangles, along these edges
  std::uint64_t edges = 0, open_edges = 0, nonmanifold_edges = 0, misoriented_edges = 0;
  std::uint64_t nonmanifold_vertices = 0;
};

// among: per vertex, nonzero for those that are looked at. All triangles around these have to be there, others need
// not.
AroundCheck check_around(const TriangleMesh& mesh, const std::vector<std::uint8_t>& among);

}  // namespace isoweave
