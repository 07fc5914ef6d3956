// The manifest of a mesh with levels of detail, which neuroglancer reads first: the nodes of each level, and the sizes
// of their fragments.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/write/node_grid.hpp"

namespace isoweave {

// A node and its fragment.
struct OctreeNode {
  std::uint64_t number = 0;  // along the curve
  std::uint32_t bytes = 0;   // of the fragment; 0: nothing is there
};

struct OctreeLevel {
  float scale = 0;                     // the length that the level shows
  std::vector<OctreeNode> nodes;       // by their numbers
  std::vector<std::uint64_t> eighths;  // nodes one level below that this level has triangles in, in any order
};

// Adds nodes without fragments where the reader would go wrong without them. A node that is missing hides those below
// it. A node that is missing below shows the triangles of the coarser level there.
void complete_octree(std::vector<OctreeLevel>& levels);

// The manifest of levels, finest first.
std::vector<std::byte> octree_manifest(const NodeGrid& grid, std::span<const OctreeLevel> levels);

}  // namespace isoweave
