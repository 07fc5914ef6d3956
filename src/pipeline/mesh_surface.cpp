#include "pipeline/mesh_surface.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "measure/geometry.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 4096;

Vec3 position_of(const Point& p) { return {p[0], p[1], p[2]}; }

bool repeats_a_vertex(const std::array<std::uint32_t, 3>& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

// Twice the sum of the areas.
double sum_areas(const TriangleMesh& mesh, std::int64_t begin, std::int64_t end) {
  double sum = 0;
  for (std::int64_t n = begin; n < end; ++n) {
    const auto& t = mesh.triangles[static_cast<std::size_t>(n)];
    const Vec3 a = position_of(mesh.vertices[t[0]]);
    const Vec3 normal = cross(position_of(mesh.vertices[t[1]]) - a, position_of(mesh.vertices[t[2]]) - a);
    sum += std::sqrt(dot(normal, normal));
  }
  return sum;
}

}  // namespace

void make_piece(const TriangleMesh& mesh, const Executor& executor, SurfacePiece& piece, std::uint64_t& dropped) {
  measure::require_indices_in_range(mesh);
  piece.clear();
  dropped = 0;
  piece.manifold = false;
  piece.positions.resize(mesh.vertices.size());
  piece.ids.resize(mesh.vertices.size());
  executor.for_each(static_cast<std::int64_t>(mesh.vertices.size()), kBlock, [&](std::int64_t n) {
    const auto v = static_cast<std::size_t>(n);
    piece.positions[v] = position_of(mesh.vertices[v]);
    piece.ids[v] = v;
  });
  piece.triangles.resize(mesh.triangles.size());
  std::atomic<bool> any_repeats{false};
  executor.for_each(static_cast<std::int64_t>(mesh.triangles.size()), kBlock, [&](std::int64_t n) {
    const auto t = static_cast<std::size_t>(n);
    piece.triangles[t] = mesh.triangles[t];
    if (repeats_a_vertex(mesh.triangles[t])) any_repeats.store(true, std::memory_order_relaxed);
  });
  if (!any_repeats) return;
  const auto kept = std::remove_if(piece.triangles.begin(), piece.triangles.end(), repeats_a_vertex);
  dropped = static_cast<std::uint64_t>(piece.triangles.end() - kept);
  piece.triangles.resize(piece.triangles.size() - dropped);
}

double mean_triangle_area(const TriangleMesh& mesh, const Executor& executor) {
  if (mesh.triangles.empty()) return 0;
  const auto count = static_cast<std::int64_t>(mesh.triangles.size());
  std::vector<double> sums(static_cast<std::size_t>((count + kBlock - 1) / kBlock));
  executor.for_blocks(count, kBlock, [&](std::int64_t begin, std::int64_t end) {
    sums[static_cast<std::size_t>(begin / kBlock)] = sum_areas(mesh, begin, end);
  });
  double sum = 0;
  for (const double block : sums) sum += block;
  return sum / 2 / static_cast<double>(count);
}

}  // namespace isoweave
