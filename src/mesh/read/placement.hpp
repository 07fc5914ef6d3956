// Affine maps that place parts of a mesh, and meshes that are put together from placed parts.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "isoweave/mesh.hpp"
#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_place.hpp"

namespace isoweave::mesh_io {

// The most vertices and corners of copies for each byte of a file. A file with more is no scene, but a way to fill
// memory.
inline constexpr std::uint64_t kMostCopies = 64;

// p -> linear * p + shift.
struct Placement {
  std::array<double, 9> linear{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row by row
  WidePoint shift{0, 0, 0};

  bool operator==(const Placement&) const = default;

  WidePoint operator()(const WidePoint& point) const;
  double determinant() const;

  // Whether it maps space onto space, with numbers that are finite.
  bool is_regular() const;
};

// The map that applies `first` and then `second`.
Placement both(const Placement& first, const Placement& second);

// The image of a direction that is orthogonal to a surface; not of unit length.
WidePoint turned_normal(const Placement& placement, const WidePoint& normal);

// Parts of a mesh, one after another.
class PlacedMesh {
 public:
  explicit PlacedMesh(const MeshInput& input) : input_(input) {}

  // Adds vertices at their place and gives the number of the first.
  std::uint32_t add_vertices(std::vector<WidePoint> vertices, const Placement& placement);

  // Adds triangles over the `count` vertices from `first` on. A mirroring placement turns triangles over, so that their
  // outside stays outside.
  void add_triangles(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::uint32_t first,
                     std::uint64_t count, bool mirrored);

  TriangleMesh& mesh() { return mesh_; }

  TriangleMesh finish(const MeshPlace& place);

 private:
  const MeshInput& input_;
  TriangleMesh mesh_;
  std::vector<WidePoint> vertices_;
};

}  // namespace isoweave::mesh_io
