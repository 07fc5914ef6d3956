// The check of a memory cap before anything is read.
#pragma once

#include "isoweave/pipeline.hpp"

namespace isoweave {

// Throws OverMemory when reading alone takes more than the cap leaves. Reads nothing.
void check_reader(SliceSource& volume, const MeshOptions& options, const RunControl& control);

}  // namespace isoweave
