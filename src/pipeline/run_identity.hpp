// The text that says for which runs a saved state, or a part of a result, is valid.
#pragma once

#include <string>

#include "pipeline/task.hpp"

namespace isoweave {

// Everything that the result depends on, as text.
struct RunIdentity {
  std::string volume;
  std::string options;
};

// The header of a volume, and the sizes and times of change of its files.
std::string volume_text(const VolumeInfo& volume);

RunIdentity identity_of(const Task& task);

// Everything that the surface in which components are chosen depends on.
std::string surface_text(const VolumeInfo& volume, const SurfaceOptions& surface);

// Throws BadInput when the volume is not as it was when the run began: the slices that were read may be of two volumes
// then.
void require_unchanged(const Task& task, const RunIdentity& before);

}  // namespace isoweave
