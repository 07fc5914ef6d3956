// An object of neuroglancer's multi-resolution meshes, packed by Draco. Its levels of detail wait in files until their
// box and their counts are known, which say how large nodes are, so the bytes do not depend on the order in which
// pieces came. Then each level is cut triangle by triangle, the triangles are sorted by nodes, and one fragment at a
// time is packed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "mesh/write/node_grid.hpp"

namespace isoweave {

// Reads bytes that wait, from the first one on; takes bytes.
using ByteReader = std::function<void(std::uint64_t first, std::span<std::byte> bytes)>;
using ByteWriter = std::function<void(std::span<const std::byte> bytes)>;

// A level of detail that waits.
struct WaitingLevel {
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;  // 1 or more
  ByteReader positions;         // a Point each
  ByteReader faces;             // three numbers of 64 bits each
};

// Packs levels, finest first: fragments go to `write`, level by level, by their nodes. Returns the manifest. path: the
// name in messages; large levels wait beside it. Throws CannotWrite.
std::vector<std::byte> pack_object(const std::string& path, const NodeGrid& grid, std::span<const WaitingLevel> meshes,
                                   const ByteWriter& write);

}  // namespace isoweave
