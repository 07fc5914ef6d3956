// When the state of a run is saved, and how it is loaded. The run itself reads and writes its state.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "files/state_file.hpp"
#include "isoweave/run.hpp"
#include "pipeline/checkpoint.hpp"

namespace isoweave {

class SavedRun {
 public:
  // The state of a run, without the parts of its sinks.
  class State {
   public:
    virtual ~State() = default;
    virtual std::int64_t layers_done() const = 0;
    virtual void write(StateWriter& writer) = 0;
    virtual void read(StateReader& reader) = 0;
    virtual void wait_for_sinks() = 0;
  };

  // The state and the sinks must outlive this. Takes the lock of the folder where the caller has none.
  SavedRun(const RunControl& control, RunIdentity identity, std::int64_t layers, std::span<MeshSink* const> sinks,
           State& state);

  bool saves() const { return folder_.has_value(); }

  // Loads the saved state that the control names, if it names one. Throws BadInput.
  void load();

  // Saves a state, unless one of this layer has been saved. The sinks first make their parts durable: a state must not
  // refer to more of the mesh than is on disk.
  void save();
  void save_if_due();

  // Throws Interrupted when the run is to stop, after saving a state if there is a folder.
  void stop_if_asked();

  // Removes the states, when the run and its sinks are finished.
  void clear();

 private:
  const RunControl& control_;
  const RunIdentity identity_;
  const std::int64_t layers_;
  const std::span<MeshSink* const> sinks_;
  State& state_;
  std::optional<CheckpointLock> lock_;  // where the caller holds none
  std::optional<CheckpointFolder> folder_;
  std::int64_t saved_layer_ = -1;
  std::chrono::steady_clock::time_point saved_time_ = std::chrono::steady_clock::now();
};

}  // namespace isoweave
