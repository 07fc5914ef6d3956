// The places of chunks of precomputed volumes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "volume/formats/chunked/chunk_places.hpp"

namespace isoweave {

// array: one that is precomputed. It must outlive the places.
std::unique_ptr<ChunkPlaces> precomputed_places(const ChunkedArray& array);

// The number of a chunk in shards: the bits of its numbers along x, y, z in turn, as many as the grid needs.
std::uint64_t compressed_morton(const std::array<std::uint64_t, 3>& chunk, const std::array<std::uint64_t, 3>& grid);

}  // namespace isoweave
