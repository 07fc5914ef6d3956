// What a saved state, or a part of a result, is good for.
#pragma once

#include <string>

#include "pipeline/task.hpp"

namespace isoweave {

// Everything that the result depends on, as text.
struct RunIdentity {
  std::string volume;
  std::string options;
};

RunIdentity identity_of(const Task& task);

// What the surface that components are chosen in depends on.
std::string surface_text(const VolumeInfo& volume, const SurfaceOptions& surface);

// What was read of a file that somebody wrote meanwhile may be of two volumes: throws BadInput when the volume is not
// as it was when the run began.
void require_unchanged(const Task& task, const RunIdentity& before);

}  // namespace isoweave
