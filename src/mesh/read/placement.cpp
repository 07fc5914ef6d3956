#include "mesh/read/placement.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace isoweave::mesh_io {

WidePoint Placement::operator()(const WidePoint& point) const {
  WidePoint placed = shift;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) placed[row] += linear[3 * row + column] * point[column];
  }
  return placed;
}

double Placement::determinant() const {
  const auto& a = linear;
  return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[1] * (a[3] * a[8] - a[5] * a[6]) + a[2] * (a[3] * a[7] - a[4] * a[6]);
}

bool Placement::is_regular() const {
  for (const double number : shift) {
    if (!std::isfinite(number)) return false;
  }
  const double volume = determinant();
  return std::isfinite(volume) && volume != 0;
}

Placement both(const Placement& first, const Placement& second) {
  Placement placement;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      double sum = 0;
      for (std::size_t n = 0; n < 3; ++n) sum += second.linear[3 * row + n] * first.linear[3 * n + column];
      placement.linear[3 * row + column] = sum;
    }
  }
  placement.shift = second(first.shift);
  return placement;
}

// Turns a normal by the matrix of cofactors, which is the inverse transposed times the determinant.
WidePoint turned_normal(const Placement& placement, const WidePoint& normal) {
  const auto& a = placement.linear;
  const Placement cofactors{{a[4] * a[8] - a[5] * a[7], a[5] * a[6] - a[3] * a[8], a[3] * a[7] - a[4] * a[6],
                             a[2] * a[7] - a[1] * a[8], a[0] * a[8] - a[2] * a[6], a[1] * a[6] - a[0] * a[7],
                             a[1] * a[5] - a[2] * a[4], a[2] * a[3] - a[0] * a[5], a[0] * a[4] - a[1] * a[3]},
                            {0, 0, 0}};
  WidePoint turned = cofactors(normal);
  if (placement.determinant() < 0) {
    for (double& coordinate : turned) coordinate = -coordinate;
  }
  return turned;
}

std::uint32_t PlacedMesh::add_vertices(std::vector<WidePoint> vertices, const Placement& placement) {
  const std::size_t first = vertices_.size();
  if (vertices.size() > kMostVertices - first) input_.fail("has more than 4294967295 vertices");
  if (placement != Placement{}) {
    for (WidePoint& vertex : vertices) vertex = placement(vertex);
  }
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    for (const double coordinate : vertices[v]) {
      if (std::abs(coordinate) <= double{std::numeric_limits<float>::max()}) continue;
      input_.fail("vertex " + std::to_string(first + v) + " has a coordinate that is not a finite number of 32 bits");
    }
  }
  if (first == 0) {
    vertices_ = std::move(vertices);
  } else {
    vertices_.insert(vertices_.end(), vertices.begin(), vertices.end());
  }
  return static_cast<std::uint32_t>(first);
}

void PlacedMesh::add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::uint32_t first,
                               std::uint64_t count, bool mirrored) {
  for (std::array<std::uint32_t, 3> triangle : triangles) {
    for (std::uint32_t& corner : triangle) {
      if (corner >= count) {
        input_.fail("a triangle refers to vertex " + std::to_string(corner) + ", its mesh has " +
                    std::to_string(count) + ", counted from 0");
      }
      corner += first;
    }
    if (mirrored) std::swap(triangle[1], triangle[2]);
    mesh_.triangles.push_back(triangle);
  }
}

TriangleMesh PlacedMesh::finish(const MeshPlace& place) {
  place.put_into(mesh_);
  set_vertices(mesh_, vertices_, place.offset());
  check_mesh_numbers(input_, mesh_);
  return std::move(mesh_);
}

}  // namespace isoweave::mesh_io
