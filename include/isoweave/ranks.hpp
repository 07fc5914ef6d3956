// One mesh by ranks: processes that each have a number, work on blocks of their own, and exchange what is left of them
// by messages, as MPI starts them.
//
// The blocks and their stages are those of a run in blocks (blocks.hpp). Each is given to a rank, near ones to the same
// rank, so that all ranks are expected to have as much to do. Rank 0 receives all final triangles and writes the mesh.
// There is no barrier between stages: a rank takes the first of its blocks for which all parts have arrived. The mesh
// is that of mesh_volume.
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "isoweave/blocks.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// A message that has arrived.
struct RankMessage {
  int from = 0;
  std::vector<std::byte> bytes;
};

// The messages of a rank to the others. Whatever carries them is the caller's: isoweave-mpi has one for MPI. All
// members are called by one thread.
class RankLink {
 public:
  RankLink() = default;
  RankLink(const RankLink&) = delete;
  RankLink& operator=(const RankLink&) = delete;
  virtual ~RankLink() = default;

  virtual int rank() const = 0;   // from 0 on
  virtual int ranks() const = 0;  // 1 or more

  // Sends a message to another rank. Returns before it has arrived.
  virtual void send(int to, std::vector<std::byte> message) = 0;

  // The next message, if one has arrived. Messages of one rank come in the order in which it has sent them.
  virtual std::optional<RankMessage> receive() = 0;

  // Waits for a message, for some milliseconds at most.
  virtual void pause() = 0;
};

struct RankOptions {
  // The folder, if any, is this rank's own.
  BlockOptions blocks{};
  // A folder that all ranks see: results of blocks are kept there, so that a run that was cut off goes on from them
  // with any number of ranks. Empty: they are not kept. The caller removes the files (remove_results).
  std::string results{};
};

// The largest size of blocks, 512, 256, 128 or 64, of which each rank gets four or more; 64 where there is none.
std::int64_t block_size_for_ranks(const VolumeInfo& volume, int ranks);

// The size of blocks of the results in a folder; nothing where there are none.
// @throws BadInput for a file of results that is damaged
std::optional<std::int64_t> block_size_of_results(const std::string& folder);

// Meshes a volume by all ranks of a link. All must be given the same volume, options and blocks. sinks: on rank 0, one
// for each level and one more; none on the others. Returns the report of the mesh on rank 0, and an empty one
// elsewhere. Where one rank fails, all throw what it threw, and no sink is finished.
// @throws what mesh_in_blocks throws, on all ranks; BadInput for a message or a file of results that is damaged or of
//   another mesh
// @cost Memory of a rank: a block, and the parts that have arrived for its blocks. Rank 0 holds final triangles besides
//   that have arrived before others that they follow. Before the work begins each rank reads four slices of each of its
//   blocks, to tell how much there is to do. To a number of triangles, rank 0 makes the forecast of mesh_in_blocks,
//   where RunControl::head_start is not known, and ends the mesh at the number by itself: 350 bytes for each triangle
//   of 1.5 times the number.
// @determinism The mesh is that of mesh_volume, for any number of ranks. The order of triangles depends on them.
MeshReport mesh_in_ranks(const VolumeOpener& open, std::span<MeshSink* const> sinks, const MeshOptions& options,
                         const RankOptions& ranks, RankLink& link, const RunControl& control = {});

// Ends the run of all ranks with an error of this one, from outside of mesh_in_ranks: as where a file cannot be opened
// before. The others may be in mesh_in_ranks, or here with errors of their own.
// @throws the error that rank 0 names to all ranks; this one where rank 0 is silent for two seconds
[[noreturn]] void end_ranks(RankLink& link, const std::exception& error);

// Removes the results of a run from their folder, when its mesh is there. Other files stay.
void remove_results(const std::string& folder);

}  // namespace isoweave
#pragma GCC visibility pop
