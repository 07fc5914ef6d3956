#include "pipeline/saved_run.hpp"

#include <memory>
#include <utility>

#include "isoweave/error.hpp"
#include "pipeline/loop.hpp"

namespace isoweave {

SavedRun::SavedRun(const RunControl& control, RunIdentity identity, std::int64_t layers,
                   std::span<MeshSink* const> sinks, State& state)
    : control_(control), identity_(std::move(identity)), layers_(layers), sinks_(sinks), state_(state) {
  const CheckpointOptions& options = control.checkpoint;
  if (options.folder.empty()) return;
  if (options.lock == nullptr) lock_.emplace(options.folder);
  folder_.emplace(options.folder);
}

void SavedRun::load() {
  if (!control_.resume) return;
  StateReader reader = open_state(*control_.resume, identity_);
  state_.read(reader);
  saved_layer_ = control_.resume->layer;
}

void SavedRun::save() {
  Checkpoint checkpoint;
  checkpoint.layers = layers_;
  checkpoint.layer = state_.layers_done();
  if (checkpoint.layer == saved_layer_) return;
  checkpoint.note = control_.checkpoint.note;
  state_.wait_for_sinks();
  for (MeshSink* sink : sinks_) checkpoint.marks.push_back(sink->mark());
  const std::unique_ptr<StateWriter> writer = folder_->begin_state(checkpoint, identity_);
  state_.write(*writer);
  writer->commit();
  saved_layer_ = checkpoint.layer;
  saved_time_ = std::chrono::steady_clock::now();
}

void SavedRun::save_if_due() {
  if (!saves()) return;
  const CheckpointOptions& options = control_.checkpoint;
  const double passed = std::chrono::duration<double>(std::chrono::steady_clock::now() - saved_time_).count();
  const bool due =
      options.layers > 0 ? state_.layers_done() - saved_layer_ >= options.layers : passed >= options.seconds;
  if (due) save();
}

void SavedRun::stop_if_asked() {
  if (control_.stop == nullptr || !control_.stop->load()) return;
  if (!saves()) check_stop(control_);
  save();
  throw Interrupted("interrupted; the run can be resumed from " + control_.checkpoint.folder);
}

void SavedRun::clear() {
  if (folder_) folder_->clear();
}

}  // namespace isoweave
