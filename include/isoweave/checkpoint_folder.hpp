// The folder of a run that can be resumed: states, and the unfinished mesh of each output.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "isoweave/run.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Makes the folder where it is missing, and locks it. When the lock is no more, and no state is in the folder,
// unfinished meshes in it are removed, and so are folders that were made here and have nothing in them: a run that is
// refused, or done, leaves none. The sinks must be gone before the lock is.
// @throws CannotWrite
std::shared_ptr<const CheckpointLock> lock_checkpoint_folder(const std::string& folder);

// Whether a folder holds a state of an unfinished run. It may be damaged: read_checkpoint tells.
bool holds_state(const std::string& folder);

// The folders of the unfinished meshes, for MeshFileOptions::parts: `folder` itself for one mesh, and folders in it for
// several. They are empty texts where `folder` is: nothing is kept.
std::vector<std::string> part_folders(const std::string& folder, std::size_t meshes);

// Makes the folder of an unfinished mesh where it is missing, and empties it. To be called where there is no state: the
// parts in it are of a run that ended before its first state, and cannot be continued.
// @throws CannotWrite
void make_part_folder(const std::string& folder);

}  // namespace isoweave
#pragma GCC visibility pop
