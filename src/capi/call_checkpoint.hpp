// The saved states of a call.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "isoweave/isoweave.h"
#include "isoweave/run.hpp"

namespace isoweave::capi {

// The folder of an unfinished mesh, and the mark from which it is continued, as in MeshFileOptions.
struct UnfinishedMesh {
  std::string parts, mark;
};

// The folder in which a run is saved. Without one it does nothing.
class CallCheckpoint {
 public:
  // Locks the folder and, where the run is to be resumed, finds the state in it for `control`.
  // @throws CannotWrite where another run goes on in the folder, or an unfinished one is in it that is not to be
  // resumed
  // @throws BadInput for a state that cannot be read
  CallCheckpoint(const iw_run& given, std::size_t outputs, RunControl& control);

  // One for each output, or none where nothing is saved.
  const std::vector<UnfinishedMesh>& meshes() const { return meshes_; }

 private:
  std::vector<UnfinishedMesh> meshes_;
};

}  // namespace isoweave::capi
