// Distances to a surface that is never whole: it comes in pieces, and the nearest of them counts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave::cli {

// Hands a surface over, the same one whenever it is called.
using SurfacePass = std::function<void(MeshSink&)>;

// The distances of the vertices of meshes from a surface: those of vertex_distances to the complete one. All meshes
// have one offset, which the surface is relative to as well. Calls the pass once, and once more where a vertex is
// farther from the surface than simplification moves it.
// @cost 12 bytes for each vertex of the surface, and some 100 MB.
std::vector<std::vector<float>> piece_distances(const std::vector<const TriangleMesh*>& meshes,
                                                const SurfacePass& surface, int threads);

}  // namespace isoweave::cli
