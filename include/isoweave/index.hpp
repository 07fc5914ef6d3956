// An index of a volume: the least and the greatest sample of each brick of 16 x 16 x 16 cells. A run that has the index
// of its volume neither reads nor decodes the parts that its surface misses, and a forecast knows where in the whole
// volume the surface lies.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "isoweave/volume.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// An index never changes: one may serve several runs at the same time. Memory: about 0.06 % of the volume, and 32 bytes
// for each slice.
class VolumeIndex;

// The numbers of an index.
struct IndexFacts {
  std::array<std::int64_t, 3> dims{0, 0, 0};  // samples of the volume
  SampleType type = SampleType::kUint8;
  std::int64_t brick = 0;   // cells along each side of a brick
  std::int64_t bricks = 0;  // of that size, in all
  std::uint64_t bytes = 0;  // that the index holds in memory
};
IndexFacts index_facts(const VolumeIndex& index);

// Makes an index in one pass over a volume.
// @pre The volume has not been read.
// @throws Interrupted when `stop` is set; BadInput for a volume of 2^63 bytes or more, and for one whose files
//   change meanwhile; what the source throws
// @cost Memory: the index, and about 4 MB, or a slice where the source has no rows.
// @determinism Depends on the samples only.
std::shared_ptr<const VolumeIndex> build_index(SliceSource& volume, const std::atomic<bool>* stop = nullptr);

// Writes an index, complete or not at all.
// @throws CannotWrite; BadInput for an index of a volume that lies in no files, such as one from a formula or a pipe:
//   nothing would tell later whether the volume is still the same
void write_index(const VolumeIndex& index, const std::string& path);

// Reads an index for a volume that has been opened. The files of the volume must have the sizes and times of change
// that they had when the index was made, wherever they lie, and the same part of them must be read, in the same way.
// @throws BadInput for a file that is no index or a damaged one, and for the index of another volume, of another part
//   of it, or of a volume that has changed
std::shared_ptr<const VolumeIndex> read_index(const std::string& path, const VolumeInfo& volume);

// The places where an index of a volume is looked for: beside its file or folder, NAME.minmax, then in the folder
// isoweave of XDG_CACHE_HOME or of ~/.cache. A part of a file that was chosen (VolumeInfo::part) has a name of its own.
// Empty for a volume that lies in no files.
std::vector<std::string> index_places(const VolumeInfo& volume);

// The first of these places that holds a file; empty where none does.
std::string find_index(const VolumeInfo& volume);

}  // namespace isoweave
#pragma GCC visibility pop
