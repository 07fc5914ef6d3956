#include "mesh/write/octree_manifest.hpp"

#include <algorithm>
#include <bit>

#include "mesh/write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

// Adds nodes to a level where it has none of their numbers.
void add_nodes(OctreeLevel& level, std::span<const std::uint64_t> numbers) {
  for (const std::uint64_t number : numbers) level.nodes.push_back({number, 0});
  std::stable_sort(level.nodes.begin(), level.nodes.end(),
                   [](const OctreeNode& a, const OctreeNode& b) { return a.number < b.number; });
  const auto same = [](const OctreeNode& a, const OctreeNode& b) { return a.number == b.number; };
  level.nodes.erase(std::unique(level.nodes.begin(), level.nodes.end(), same), level.nodes.end());
}

}  // namespace

void complete_octree(std::vector<OctreeLevel>& levels) {
  for (std::size_t level = 1; level < levels.size(); ++level) {
    add_nodes(levels[level - 1], levels[level].eighths);
    std::vector<std::uint64_t> above;
    for (const OctreeNode& node : levels[level - 1].nodes) above.push_back(node.number >> 3);
    add_nodes(levels[level], above);
  }
}

std::vector<std::byte> octree_manifest(const NodeGrid& grid, std::span<const OctreeLevel> levels) {
  std::size_t nodes = 0;
  for (const OctreeLevel& level : levels) nodes += level.nodes.size();
  std::vector<std::byte> bytes(28 + 20 * levels.size() + 16 * nodes);
  std::byte* out = bytes.data();
  store_point(out, {grid.side(), grid.side(), grid.side()});
  store_point(out, grid.origin());
  store_u32(out, static_cast<std::uint32_t>(levels.size()));
  for (const OctreeLevel& level : levels) store_u32(out, std::bit_cast<std::uint32_t>(level.scale));
  for (std::size_t n = 0; n < levels.size(); ++n) store_point(out, {0, 0, 0});  // of the vertices
  for (const OctreeLevel& level : levels) store_u32(out, static_cast<std::uint32_t>(level.nodes.size()));
  for (const OctreeLevel& level : levels) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const OctreeNode& node : level.nodes) store_u32(out, node_at(node.number)[axis]);
    }
    for (const OctreeNode& node : level.nodes) store_u32(out, node.bytes);
  }
  return bytes;
}

}  // namespace isoweave
