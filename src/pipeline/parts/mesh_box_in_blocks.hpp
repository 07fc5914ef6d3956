// A mesh in blocks, of a volume that has a surface in a box only.
#pragma once

#include <span>

#include "isoweave/blocks.hpp"

namespace isoweave {

// As mesh_in_blocks, but the sinks are not finished. box: samples; those beside it are all outside, and most of them
// are not read.
MeshReport mesh_box_in_blocks(const VolumeOpener& open, const Region& box, std::span<MeshSink* const> sinks,
                              const MeshOptions& options, const BlockOptions& blocks, const RunControl& control);

}  // namespace isoweave
