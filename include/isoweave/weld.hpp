// Vertices that are doubled: along seams, or in every triangle.
#pragma once

#include <cstdint>

#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Makes one vertex of all that have equal coordinates, 0 and -0 being equal. The first of them stays, with its normal
// and its value. Triangles are renumbered and stay where they are, those too whose corners have become one. Tells how
// many vertices have gone.
std::uint64_t weld_vertices(TriangleMesh& mesh);

// Border edges whose two ends lie where those of another border edge lie: seams, which weld_vertices closes.
std::uint64_t count_seam_edges(const TriangleMesh& mesh);

// Both throw std::invalid_argument when a triangle refers to a vertex that the mesh does not have.

}  // namespace isoweave
#pragma GCC visibility pop
