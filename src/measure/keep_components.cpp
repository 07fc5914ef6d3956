// Components of a mesh in memory.
#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "isoweave/components.hpp"
#include "parallel/union_find.hpp"

namespace isoweave {
namespace {

constexpr std::uint32_t kDropped = std::numeric_limits<std::uint32_t>::max();

// For each vertex, the smallest vertex of its component.
std::vector<std::uint32_t> component_roots(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> roots(mesh.vertices.size());
  std::iota(roots.begin(), roots.end(), 0U);
  for (const auto& [a, b, c] : mesh.triangles) {
    join_sets(roots, a, b);
    join_sets(roots, a, c);
  }
  for (std::uint32_t v = 0; v < roots.size(); ++v) roots[v] = find_root(roots, v);
  return roots;
}

// Closes the gaps that dropped vertices leave.
void drop_vertices(TriangleMesh& mesh, const std::vector<bool>& kept) {
  std::vector<std::uint32_t> number(mesh.vertices.size(), kDropped);
  std::uint32_t next = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (!kept[v]) continue;
    mesh.vertices[next] = mesh.vertices[v];
    if (!mesh.normals.empty()) mesh.normals[next] = mesh.normals[v];
    if (!mesh.values.empty()) mesh.values[next] = mesh.values[v];
    number[v] = next++;
  }
  mesh.vertices.resize(next);
  if (!mesh.normals.empty()) mesh.normals.resize(next);
  if (!mesh.values.empty()) mesh.values.resize(next);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& v : triangle) v = number[v];
  }
}

}  // namespace

DroppedComponents keep_components(TriangleMesh& mesh, const ComponentRule& rule) {
  const std::vector<std::uint32_t> roots = component_roots(mesh);
  std::vector<std::uint64_t> sizes(mesh.vertices.size(), 0);  // at roots, in triangles
  for (const auto& triangle : mesh.triangles) ++sizes[roots[triangle[0]]];
  const auto largest = static_cast<std::uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  std::vector<bool> kept(mesh.vertices.size());
  DroppedComponents dropped;
  for (std::uint32_t v = 0; v < kept.size(); ++v) {
    const std::uint64_t size = sizes[roots[v]];
    kept[v] = size > 0 && size >= rule.min_triangles && (!rule.largest || roots[v] == largest);
    if (kept[v]) continue;
    ++dropped.vertices;
    if (sizes[v] == 0) continue;  // not the root of its component
    ++dropped.components;
    dropped.triangles += sizes[v];
  }
  std::erase_if(mesh.triangles, [&](const auto& triangle) { return !kept[triangle[0]]; });
  drop_vertices(mesh, kept);
  return dropped;
}

}  // namespace isoweave
