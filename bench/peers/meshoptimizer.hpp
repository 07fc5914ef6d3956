// Meshes as meshoptimizer takes them: flat arrays of indices and floats.
#pragma once

#include <limits>
#include <vector>

#include "isoweave/mesh.hpp"

namespace bench {

// The triangle count alone decides when to stop.
constexpr float kAnyError = std::numeric_limits<float>::max();

inline std::vector<unsigned> flat_indices(const isoweave::TriangleMesh& mesh) {
  std::vector<unsigned> indices;
  indices.reserve(mesh.triangles.size() * 3);
  for (const auto& triangle : mesh.triangles) indices.insert(indices.end(), triangle.begin(), triangle.end());
  return indices;
}

inline std::vector<std::array<std::uint32_t, 3>> to_triangles(const std::vector<unsigned>& indices) {
  std::vector<std::array<std::uint32_t, 3>> triangles(indices.size() / 3);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    triangles[t] = {indices[3 * t], indices[3 * t + 1], indices[3 * t + 2]};
  }
  return triangles;
}

// meshopt_simplify on the triangles of `indices`. The vertices stay where they are; many are unused afterwards.
std::vector<unsigned> meshoptimizer_simplify(const std::vector<unsigned>& indices,
                                             const std::vector<isoweave::Point>& vertices, std::size_t target_triangles,
                                             unsigned options);

}  // namespace bench
