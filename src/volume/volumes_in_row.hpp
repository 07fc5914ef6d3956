// Files that hold several volumes of one size, one behind another.
#pragma once

#include <cstdint>

#include "isoweave/volume.hpp"

namespace isoweave {

// Chooses among `count` volumes of info.dims the one at options.time, or the first with a note; with --slices-from it
// is all of them that are the slices. Sets dims, part and notes, and returns the bytes of samples before it. Throws
// BadInput for an index that is not there, and for --channel.
std::uint64_t choose_in_row(VolumeInfo& info, std::int64_t count, const OpenOptions& options);

}  // namespace isoweave
