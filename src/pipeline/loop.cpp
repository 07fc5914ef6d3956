#include "pipeline/loop.hpp"

#include <optional>
#include <stdexcept>
#include <string>

#include "isoweave/error.hpp"
#include "pipeline/run_report.hpp"

namespace isoweave {

void check_stop(const RunControl& control) {
  if (control.stop != nullptr && control.stop->load()) throw Interrupted("interrupted, nothing was written");
}

SlabRecord Loop::step() {
  if (!is_read_) read();
  source_.make(piece_, report_);
  is_read_ = false;
  for (PieceStage* stage : stages_) stage->apply(piece_);
  SlabRecord record;
  record.bytes = source_.bytes();
  record.live_triangles = piece_.triangles.size();
  const bool complete = source_.complete();
  // An error of reading for the next piece is thrown once this piece is done, so that a state can be saved then.
  std::exception_ptr failure;
  if (source_.reads_early() && !complete) failure = try_to_read();
  if (back_end_ != nullptr) simplify(complete, record);
  if (failure) std::rethrow_exception(failure);
  return record;
}

void Loop::simplify(bool complete, SlabRecord& record) {
  Stopwatch clock;
  back_end_->simplify(piece_, complete, record);
  clock.lap(report_.seconds_simplify);
  back_end_->write(piece_, record, report_);
  clock.lap(report_.seconds_write);
  record.final_triangles = report_.triangles;
  undecided_ = record.undecided_triangles;
}

std::exception_ptr Loop::try_to_read() {
  try {
    read();
  } catch (const Error&) {
    return std::current_exception();
  }
  return nullptr;
}

void Loop::read() {
  source_.read(held(), report_);
  is_read_ = true;
}

void Loop::wait_for_sinks() {
  Stopwatch clock;
  if (back_end_ != nullptr) back_end_->wait_for_sinks();
  clock.lap(report_.seconds_write);
}

void Loop::serialize(StateWriter& state) const {
  for (const PieceStage* stage : stages_) stage->serialize(state);
  if (back_end_ != nullptr) back_end_->serialize(state);
}

void Loop::serialize(StateReader& state) {
  std::optional<std::uint64_t> inherited = source_.inherited();
  for (PieceStage* stage : stages_) {
    stage->serialize(state);
    if (inherited) inherited = stage->inherited(*inherited);
  }
  if (back_end_ == nullptr) return;
  back_end_->serialize(state);
  state.require(inherited == back_end_->inherited(), "one front of the surface in all its parts");
}

void Loop::finish() {
  if (undecided_ > 0) throw std::logic_error(std::to_string(undecided_) + " triangles are left undecided");
  if (back_end_ != nullptr) back_end_->finish(report_);
}

Held Loop::held() const {
  Held held = back_end_ != nullptr ? back_end_->held() : Held{};
  for (const PieceStage* stage : stages_) held.other_bytes += stage->bytes();
  return held;
}

}  // namespace isoweave
