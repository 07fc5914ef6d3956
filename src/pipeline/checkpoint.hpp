// Where the states of an unfinished run are kept: two files in a folder, written in turn, so that one is always whole.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "files/state_file.hpp"
#include "isoweave/run.hpp"
#include "pipeline/run_identity.hpp"

namespace isoweave {

// Opens a saved state behind its header. Throws BadInput when another version saved it, or a run with another identity.
StateReader open_state(const Checkpoint& checkpoint, const RunIdentity& identity);

class CheckpointFolder {
 public:
  // Continues the numbers of the states in the folder.
  explicit CheckpointFolder(const std::string& folder);

  // Begins a state with its header, in place of the older one in the folder. The state counts once the writer is
  // committed.
  std::unique_ptr<StateWriter> begin_state(const Checkpoint& checkpoint, const RunIdentity& identity);

  // Removes all states, as the run is finished.
  void clear();

 private:
  std::string folder_;
  std::uint64_t number_ = 0;  // of the newest state
};

}  // namespace isoweave
