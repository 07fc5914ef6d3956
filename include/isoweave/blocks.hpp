// Meshing in blocks instead of slabs: memory is that of a block, however large a slice of the volume is.
//
// The volume is cut into cubes of cells. Each is read, extracted and simplified by itself as far as the rest of the
// surface cannot change the outcome. What is left, near the sides of the block, goes on to the blocks of the next grid,
// which is shifted by half a block, and so on until nothing is left. The result is bit for bit the mesh of mesh_volume.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "isoweave/pipeline.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Opens the volume once more, from its beginning.
using VolumeOpener = std::function<std::unique_ptr<SliceSource>()>;

struct BlockOptions {
  std::int64_t size = 256;  // cells of a block along each axis, 8 or more
  std::array<std::int64_t, 3> first{0, 0,
                                    0};  // where a block begins, in cells from the first one; others lie before it
  // An existing folder: what waits for a block of the next grid waits in files there, which are gone when the run ends.
  // Empty: it waits in memory.
  std::string folder{};
};

// The largest size of blocks, 512, 256 or 128, for which a run with a folder is expected to stay below `memory` bytes;
// nothing where not even those of 128 are. triangles: of the full surface.
// @cost None. An estimate: the run itself counts, and throws OverMemory.
std::optional<std::int64_t> block_size_for(const VolumeInfo& volume, std::uint64_t triangles, std::uint64_t memory);

// Meshes a volume block by block into a sink, and finishes the sink. Options are those of mesh_volume. The volume must
// be one in which skipping costs next to nothing (SliceSource::skips): each block opens it and reads its own rows.
// @pre `open` always opens the same volume. Nobody writes to the sink meanwhile.
// @throws what mesh_volume throws; BadInput for a volume that has to be read from its beginning, as a packed one; and
//   std::invalid_argument for a size below 8, a number of triangles, a guaranteed distance, components to be dropped,
//   values of another volume, dual marching cubes, a device, an observer, an index and states; OverMemory where a
//   block takes more than RunControl::memory
// @cost Memory: a slab of a block, its undecided zone, and what is undecided at the sides of two layers of blocks, or
//   where there is a folder 4 bytes for each of its vertices that has been written. On scans, blocks of 256 cells hand
//   on a tenth of their triangles. A closed surface with large caps hands on more.
//   Chunks of Zarr and tiles are decoded once for each block along x and y that they touch.
// @determinism The mesh is that of mesh_volume, for any size of blocks. The order of triangles depends on them.
MeshReport mesh_in_blocks(const VolumeOpener& open, MeshSink& sink, const MeshOptions& options,
                          const BlockOptions& blocks = {}, const RunControl& control = {});

// The same with levels: sinks as for mesh_volume.
MeshReport mesh_in_blocks(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
                          const BlockOptions& blocks = {}, const RunControl& control = {});

}  // namespace isoweave
#pragma GCC visibility pop
