// Where a mesh is not an oriented manifold.
#pragma once

#include <cstdint>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave {

// 1 for every vertex on an edge with three or more triangles or with two that run along it in the same direction,
// and for every vertex whose triangles form more than one fan. Triangles that repeat a vertex do not count.
std::vector<std::uint8_t> defective_vertices(const TriangleMesh& mesh);

}  // namespace isoweave
