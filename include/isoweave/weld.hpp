// Doubled vertices: along seams, or in every triangle.
#pragma once

#include <cstdint>

#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Joins vertices with equal coordinates, in place; 0 and -0 are equal. The first vertex at a place stays, with its
// normal and value. Triangles are renumbered and stay where they are, also those whose corners have become one vertex.
// Returns the number of vertices removed.
// @throws std::invalid_argument when a triangle refers to a vertex that the mesh does not have
std::uint64_t weld_vertices(TriangleMesh& mesh);

// The number of border edges whose two ends lie where the ends of another border edge lie: seams, which weld_vertices
// closes.
// @throws std::invalid_argument when a triangle refers to a vertex that the mesh does not have
std::uint64_t count_seam_edges(const TriangleMesh& mesh);

}  // namespace isoweave
#pragma GCC visibility pop
