// The samples that a run does not need, and the chunks that a stream leaves out for that reason.
#pragma once

#include <cstdint>

#include "isoweave/volume.hpp"

namespace isoweave {

class NeededSamples {
 public:
  NeededSamples() = default;
  NeededSamples(const NeededSamples&) = delete;
  NeededSamples& operator=(const NeededSamples&) = delete;
  virtual ~NeededSamples() = default;

  // Whether any sample of a box of the volume is needed.
  virtual bool any_in(const Region& box) const = 0;
};

// Where a stream of chunks asks before it reads one. Whoever says that samples are not needed fills them in afterwards:
// the stream leaves anything in their place. Used by the thread that reads.
struct Gaps {
  const NeededSamples* needed = nullptr;  // null: all samples are needed
  std::uint64_t chunks = 0, chunks_left_out = 0;
  std::uint64_t samples_left_out = 0;

  // Whether a chunk with the samples of this box is to be left out. Counts it.
  bool leaves_out(const Region& box) {
    ++chunks;
    if (needed == nullptr || needed->any_in(box)) return false;
    ++chunks_left_out;
    std::uint64_t samples = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      samples *= static_cast<std::uint64_t>(box.end[axis] - box.first[axis]);
    }
    samples_left_out += samples;
    return true;
  }
};

}  // namespace isoweave
