// Vectors in double for measures of float32 meshes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "isoweave/mesh.hpp"
#include "lattice/vec3.hpp"

namespace isoweave::measure {

using Vector = std::array<double, 3>;

inline Vector vector_of(const Point& p) { return {double{p[0]}, double{p[1]}, double{p[2]}}; }
inline Vector vector_of(const Vec3& p) { return {p.x, p.y, p.z}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

using TriangleCorners = std::array<Vector, 3>;

inline TriangleCorners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {vector_of(mesh.vertices[t[0]]), vector_of(mesh.vertices[t[1]]), vector_of(mesh.vertices[t[2]])};
}

inline double area_of(const TriangleCorners& t) {
  const Vector normal = cross(t[1] - t[0], t[2] - t[0]);
  return 0.5 * std::sqrt(dot(normal, normal));
}

[[noreturn]] inline void refuse_index() {
  throw std::invalid_argument("a triangle refers to a vertex that the mesh does not have");
}

// Throws where a triangle names a vertex that the mesh does not have. Meshes may come from any program, so every index
// is tested before it is followed.
inline void require_in_range(const std::array<std::uint32_t, 3>& triangle, std::size_t vertices) {
  if (std::max({triangle[0], triangle[1], triangle[2]}) >= vertices) refuse_index();
}

inline void require_indices_in_range(const TriangleMesh& mesh) {
  for (const auto& triangle : mesh.triangles) require_in_range(triangle, mesh.vertices.size());
}

// Throws where a coordinate is not finite, or where triangles cannot be numbered in 32 bits.
inline void require_finite_mesh(const TriangleMesh& mesh) {
  if (mesh.triangles.size() > 0xffffffffU) throw std::invalid_argument("expected at most 2^32 - 1 triangles");
  require_indices_in_range(mesh);
  for (const Point& p : mesh.vertices) {
    if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
      throw std::invalid_argument("a vertex has a coordinate that is not finite");
    }
  }
}

}  // namespace isoweave::measure
