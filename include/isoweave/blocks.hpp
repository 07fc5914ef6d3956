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

struct BlockOptions {
  std::int64_t size = 256;  // cells of a block along each axis, 8 or more
  std::array<std::int64_t, 3> first{0, 0,
                                    0};  // where a block begins, in cells from the first one; others lie before it
  // An existing folder: what waits for a block of the next grid waits in a file without a name there, which the system
  // frees however the process ends. Empty: it waits in memory.
  std::string folder{};
};

// The largest size of blocks, 512, 256 or 128, for which a run with a folder is expected to stay below `memory` bytes;
// nothing where not even those of 128 are, or where chunks that must be decoded as a whole are too large. triangles: of
// the full surface. wanted: the number of triangles to stop at; 0: there is none.
// @throws what `open` throws
// @cost Opens the volume for each size, and reads no sample. An estimate: the run itself counts, and throws OverMemory.
std::optional<std::int64_t> block_size_for(const VolumeOpener& open, std::uint64_t triangles, std::uint64_t memory,
                                           std::uint64_t wanted = 0);

// Meshes a volume block by block into a sink, and finishes the sink. Options are those of mesh_volume. The volume must
// be one in which skipping costs next to nothing (SliceSource::skips): each block opens it and reads its own rows.
// @pre `open` always opens the same volume. Nobody writes to the sink meanwhile.
// @throws what mesh_volume throws; BadInput for a volume that has to be read from its beginning, as a packed one; and
//   std::invalid_argument for a size below 8, a guaranteed distance, components to be dropped,
//   values of another volume, dual marching cubes, a device, an observer, an index and states; OverMemory where a
//   block takes more than RunControl::memory
// @cost Memory: a slab of a block, its undecided zone, and what is undecided at the sides of two layers of blocks, or
//   where there is a folder 4 bytes for each of its vertices that has been written. On scans, blocks of 256 cells hand
//   on a tenth of their triangles. A closed surface with large caps hands on more. With a number of triangles 350 bytes
//   for each triangle of 1.5 times the number besides, and time for a forecast, where RunControl::head_start is not
//   known. Chunks of Zarr and tiles are decoded once for each block along x and y that they touch.
// @determinism The mesh is that of mesh_volume, for any size of blocks. The order of triangles depends on them.
MeshReport mesh_in_blocks(const VolumeOpener& open, MeshSink& sink, const MeshOptions& options,
                          const BlockOptions& blocks = {}, const RunControl& control = {});

// The same with levels: sinks as for mesh_volume.
MeshReport mesh_in_blocks(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
                          const BlockOptions& blocks = {}, const RunControl& control = {});

// Meshes labels of a label map in boxes of blocks.size samples along each axis, each into its own sink. The labels that
// a box holds are meshed together, in a sweep over that box, which may begin at half a size as well. A label that no
// box holds is meshed by itself, in blocks. Give LabelSink::box (find_labels_in_blocks): a label without one is as
// large as the map. Sinks are called as by mesh_labels, and finished in the end.
// @pre `open` always opens the same map. Nobody writes to the sinks meanwhile.
// @throws what mesh_labels throws, and what mesh_in_blocks throws for blocks, and for options where a label is larger
//   than a box
// @cost Memory: as mesh_labels for a map as large as a box. Each box that holds labels is read once; with a shift by
//   half a size that is eight times the map at the most.
// @determinism The meshes are those of mesh_labels, for any size. The total has no range of samples.
LabelsReport mesh_labels_in_blocks(const VolumeOpener& open, std::span<const LabelSink> labels,
                                   const MeshOptions& options, const BlockOptions& blocks = {},
                                   const RunControl& control = {});

// Takes the meshes of many labels, one group after the other.
class LabelOutput {
 public:
  virtual ~LabelOutput() = default;

  // The offset of all sinks, as MeshSink::offset.
  virtual std::array<double, 3> offset() const = 0;

  // The sink of label n of the list, which is not called for any more once end(n) has been called. A label that does
  // not occur has none.
  virtual MeshSink& begin(std::size_t n) = 0;

  // The mesh of label n is complete; its sink has not been finished. report: as one of LabelsReport::labels.
  virtual void end(std::size_t n, MeshReport report) = 0;
};

// The same for any number of labels, as find_labels_in_blocks found them: only those of one box are open at a time.
// Returns the total. What `output` throws comes out. Its members are called by the calling thread.
// @cost Memory: as above, and 100 bytes for each label.
MeshReport mesh_labels_in_blocks(const VolumeOpener& open, std::span<const LabelExtent> labels, LabelOutput& output,
                                 const MeshOptions& options, const BlockOptions& blocks = {},
                                 const RunControl& control = {});

}  // namespace isoweave
#pragma GCC visibility pop
