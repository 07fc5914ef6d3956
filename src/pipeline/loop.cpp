#include "pipeline/loop.hpp"

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
  if (source_.reads_early() && !complete) read();
  if (back_end_ == nullptr) return record;
  Stopwatch clock;
  back_end_->simplify(piece_, complete, record);
  clock.lap(report_.seconds_simplify);
  back_end_->write(piece_, record, report_);
  clock.lap(report_.seconds_write);
  record.final_triangles = report_.triangles;
  return record;
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

void Loop::finish() {
  if (back_end_ != nullptr) back_end_->finish(report_);
}

Held Loop::held() const {
  Held held = back_end_ != nullptr ? back_end_->held() : Held{};
  for (const PieceStage* stage : stages_) held.other_bytes += stage->bytes();
  return held;
}

}  // namespace isoweave
