#include "pipeline/mesh_surface.hpp"

#include <cmath>

#include "measure/defects.hpp"

namespace isoweave {
namespace {

Vec3 position_of(const Point& p) { return {p[0], p[1], p[2]}; }

}  // namespace

void make_piece(const TriangleMesh& mesh, SurfacePiece& piece, std::uint64_t& dropped) {
  piece.clear();
  dropped = 0;
  piece.positions.reserve(mesh.vertices.size());
  piece.ids.reserve(mesh.vertices.size());
  for (const Point& p : mesh.vertices) {
    piece.ids.push_back(piece.positions.size());
    piece.positions.push_back(position_of(p));
  }
  piece.triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      ++dropped;
    } else {
      piece.triangles.push_back(t);
    }
  }
  const std::vector<std::uint8_t> defective = defective_vertices(mesh);
  for (std::uint32_t v = 0; v < defective.size(); ++v) {
    if (defective[v] != 0) piece.locked.push_back(v);
  }
}

double mean_triangle_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = position_of(mesh.vertices[t[0]]);
    const Vec3 normal = cross(position_of(mesh.vertices[t[1]]) - a, position_of(mesh.vertices[t[2]]) - a);
    sum += std::sqrt(dot(normal, normal)) / 2;
  }
  return mesh.triangles.empty() ? 0 : sum / static_cast<double>(mesh.triangles.size());
}

}  // namespace isoweave
