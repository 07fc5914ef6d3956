// Meshes as meshoptimizer takes them: flat arrays of indices and floats.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "isoweave/mesh.hpp"
#include "task.hpp"

namespace bench {

// The triangle count alone decides when to stop.
constexpr float kAnyError = std::numeric_limits<float>::max();

// The triangles as they lie in memory.
inline std::span<const unsigned> flat_indices(const isoweave::TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return {};
  return {mesh.triangles.front().data(), mesh.triangles.size() * 3};
}

inline std::vector<std::array<std::uint32_t, 3>> to_triangles(const std::vector<unsigned>& indices) {
  std::vector<std::array<std::uint32_t, 3>> triangles(indices.size() / 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    triangles[t] = {indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]};
  }
  return triangles;
}

// meshopt_simplify on the triangles of `indices`. The vertices stay where they are; many are unused afterwards.
std::vector<unsigned> meshoptimizer_simplify(std::span<const unsigned> indices,
                                             const std::vector<isoweave::Point>& vertices, std::size_t target_triangles,
                                             unsigned options);

struct FlatMesh {
  std::vector<unsigned> indices;
  std::vector<isoweave::Point> vertices;

  isoweave::TriangleMesh to_mesh() const { return {vertices, to_triangles(indices), {}}; }
};

// On all threads. `full` comes in the order of marching cubes.
FlatMesh meshoptimizer_simplify_in_slabs(const isoweave::TriangleMesh& full, const Goal& goal);

}  // namespace bench
