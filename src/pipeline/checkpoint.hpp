// Where the states of an unfinished run are kept: two files in a folder, written in turn, so that one is always whole.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "files/state_file.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave {

// What a state is good for: everything that the result depends on, as text.
struct RunIdentity {
  std::string volume;
  std::string options;
};

// What the surface that is extracted depends on.
std::string surface_text(const VolumeInfo& volume, const MeshOptions& options);

// offset: of the output. measured: as RunControl::measure; a state of a run without has no components to go on with.
RunIdentity identity_of(const VolumeInfo& volume, const MeshOptions& options,
                        const std::array<double, 3>& offset = {0, 0, 0}, bool measured = true);

// What was read of a file that somebody wrote meanwhile may be of two volumes: throws BadInput when the volume is not
// as it was when the run began.
void require_unchanged(const VolumeInfo& volume, const MeshOptions& options, const RunIdentity& before);

// Opens a saved state behind its header. Throws BadInput when it was saved by another version or in a run with another
// identity.
StateReader open_state(const Checkpoint& checkpoint, const RunIdentity& identity);

class CheckpointFolder {
 public:
  // Goes on with the numbers of the states that are there.
  explicit CheckpointFolder(const std::string& folder);

  // A file in place of the older state, with a header. It counts once it is committed.
  std::unique_ptr<StateWriter> begin_state(const Checkpoint& checkpoint, const RunIdentity& identity);

  // Removes all states: the run is finished.
  void clear();

 private:
  std::string folder_;
  std::uint64_t number_ = 0;  // of the newest state
};

}  // namespace isoweave
