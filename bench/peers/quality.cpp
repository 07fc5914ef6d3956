#include "quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "isoweave/measure.hpp"

namespace bench {
namespace {

constexpr double kSliverDegrees = 5;

double squared_distance(const isoweave::Point& a, const isoweave::Point& b) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double difference = double{a[axis]} - double{b[axis]};
    sum += difference * difference;
  }
  return sum;
}

// The smallest angle lies opposite the shortest side.
double smallest_angle(const isoweave::Point& p, const isoweave::Point& q, const isoweave::Point& r) {
  std::array<double, 3> sides{squared_distance(p, q), squared_distance(q, r), squared_distance(r, p)};
  std::sort(sides.begin(), sides.end());
  if (sides[0] == 0) return 0;
  const double cosine = (sides[1] + sides[2] - sides[0]) / (2 * std::sqrt(sides[1] * sides[2]));
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

}  // namespace

double sliver_share(const isoweave::TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return 0;
  constexpr double kLimit = kSliverDegrees * std::numbers::pi / 180;
  const auto is_sliver = [&](const std::array<std::uint32_t, 3>& t) {
    return smallest_angle(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]) < kLimit;
  };
  const auto slivers = std::count_if(mesh.triangles.begin(), mesh.triangles.end(), is_sliver);
  return static_cast<double>(slivers) / static_cast<double>(mesh.triangles.size());
}

Json quality(const isoweave::TriangleMesh& mesh, const FullSurface& full) {
  const isoweave::MeshCheck check = check_mesh(mesh);
  const isoweave::MeshDistance distance = compare_meshes(mesh, isoweave::read_mesh(full.path));
  return {{"mean", distance.mean / full.voxel},
          {"rms", distance.rms / full.voxel},
          {"max", distance.max / full.voxel},
          {"nonmanifold_edges", check.nonmanifold_edges},
          {"nonmanifold_vertices", check.nonmanifold_vertices},
          {"degenerate_triangles", check.degenerate_triangles},
          {"euler", check.euler},
          {"components", check.components},
          {"slivers", sliver_share(mesh)}};
}

}  // namespace bench
