#include "capi/call_checkpoint.hpp"

#include "isoweave/checkpoint_folder.hpp"
#include "isoweave/error.hpp"

namespace isoweave::capi {

CallCheckpoint::CallCheckpoint(const iw_run& given, std::size_t outputs, RunControl& control) {
  const std::string& folder = control.checkpoint.folder;
  if (folder.empty()) return;
  control.checkpoint.lock = lock_checkpoint_folder(folder);
  const bool unfinished = holds_state(folder);
  if (unfinished && given.resume == 0)
    throw CannotWrite(folder + ": holds an unfinished run: go on with resume, or remove it");
  if (unfinished) control.resume = read_checkpoint(folder);
  if (unfinished && control.resume->marks.size() != outputs) {
    throw BadInput(control.resume->path + ": expected a state of a run with " + std::to_string(outputs) +
                   " outputs, found " + std::to_string(control.resume->marks.size()));
  }
  for (const std::string& parts : part_folders(folder, outputs)) {
    if (!unfinished) make_part_folder(parts);
    meshes_.push_back({parts, unfinished ? control.resume->marks[meshes_.size()] : ""});
  }
}

}  // namespace isoweave::capi
