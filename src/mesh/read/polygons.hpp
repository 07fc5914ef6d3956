// Polygons of mesh files as triangles.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave::mesh_io {

// Makes the triangles over polygons no worse than the polygons. Over a polygon that is not convex, a fan may turn
// triangles over. Such polygons are cut anew, by ears; others keep their fan.
class Polygons {
 public:
  // The mesh must outlive this. Its triangles change in place.
  explicit Polygons(TriangleMesh& mesh) : mesh_(mesh) {}

  // To be called for each polygon, when its fan stands at the end of the triangles. Vertices may come later.
  void end(std::uint64_t corners);

  // To be called when the mesh has all its vertices and no triangle refers to others. Notes how many polygons cross
  // themselves, which keep their fan.
  void finish();

 private:
  struct Fan {
    std::size_t first;  // of its triangles
    std::size_t corners;
  };

  bool has_vertices(const Fan& fan) const;
  void cut(const Fan& fan);

  TriangleMesh& mesh_;
  std::vector<Fan> waiting_;  // for their vertices
  std::uint64_t crossed_ = 0;
};

}  // namespace isoweave::mesh_io
