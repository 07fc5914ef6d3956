#include "pipeline/host_back_end.hpp"

#include <algorithm>

#include "output/sweep_view.hpp"
#include "pipeline/run_report.hpp"

namespace isoweave {

HostBackEnd::HostBackEnd(const SimplifyTask& task, const World& world, std::span<MeshSink* const> sinks,
                         const Executor& executor, const RunControl& control, const std::atomic<bool>* stop,
                         const HeadStart& head_start)
    : task_(task),
      world_(world),
      executor_(executor),
      simplifier_({task.zone, control.schedule, task.level_costs, control.measure}, executor, stop),
      full_output_(world, *sinks.back(), executor, control.measure, control.observer.get()) {
  for (std::size_t level = 0; level < simplifier_.levels(); ++level) {
    SweepObserver* const observer = simplifier_.is_last(level) ? control.observer.get() : nullptr;
    outputs_.push_back(std::make_unique<FinalOutput>(world, *sinks[level], executor, control.measure, observer));
  }
  if (!task.goal.given()) return;
  const TriangleGoal known{head_start.number};
  target_.emplace(simplifier_, executor, known.given() ? known : task.goal, head_start);
}

void HostBackEnd::simplify(const SurfacePiece& piece, bool complete, SlabRecord& record) {
  if (!task_.needed) return;
  simplifier_.append(piece);
  record.live_triangles = simplifier_.live_triangles();
  zone_bytes_ = simplifier_.zone().bytes();
  record.bytes += zone_bytes_;
  for (std::size_t level = 0; !simplifier_.is_last(level); ++level) {
    simplifier_.decide(level);
    outputs_[level]->take(simplifier_.final_source(level));
  }
  simplifier_.decide(simplifier_.levels() - 1);
  if (target_) decide_to_number(complete);
}

void HostBackEnd::decide_to_number(bool complete) {
  if (!complete) {
    target_->thin_out();
    hands_out_ = target_->leaves_enough();
    waiting_ = hands_out_ ? 0 : waiting_triangles();
    return;
  }
  hands_out_ = !target_->has_overshot();
  if (hands_out_) return target_->finish();
  overshot_ = target_->next_head_start();
}

void HostBackEnd::write(const SurfacePiece& piece, SlabRecord& record, MeshReport& report) {
  if (task_.needed) {
    FinalSource& source = simplifier_.final_source(simplifier_.levels() - 1);
    if (!hands_out_) {
      simplifier_.close_gaps();
    } else if (counts()) {
      FinalPiece dropped;
      do source.take_final({0, 0}, dropped);
      while (source.has_more());
    } else {
      outputs_.back()->take(source);
    }
    outputs_.back()->report(report);
    record.undecided_triangles = simplifier_.live_triangles();
  } else {
    full_output_.take(piece);
    full_output_.report(report);
  }
}

Held HostBackEnd::held() const {
  if (!task_.needed) return {};
  return {simplifier_.live_triangles(), zone_bytes_, 0, waiting_};
}

// The triangles at vertices all of whose edges wait for a higher limit; about, as a vertex stands for two triangles.
std::uint64_t HostBackEnd::waiting_triangles() const {
  if (target_->head_start().cost == kUnknownCost) return 0;
  const Zone& zone = simplifier_.zone();
  const auto waits = [&](Key turn) { return cost_of(turn) > zone.limit; };
  return std::min(2 * static_cast<std::uint64_t>(std::ranges::count_if(zone.turn_keys, waits)),
                  simplifier_.live_triangles());
}

void HostBackEnd::view_undecided(const SweepObserver::Visitor& visitor) const {
  if (task_.needed) view_zone(simplifier_.zone(), world_, executor_, visitor);
}

void HostBackEnd::wait_for_sinks() {
  for (const auto& output : outputs_) output->wait();
  full_output_.wait();
}

void HostBackEnd::finish(MeshReport& report) const {
  report.schedule = simplifier_.schedule();
  report.locked_vertices = simplifier_.zone().locked;
  report_simplifier(simplifier_, report);
  for (std::size_t level = 0; level < simplifier_.levels(); ++level) {
    SurfaceReport& mesh = simplifier_.is_last(level) ? report : report.levels[level];
    if (!simplifier_.is_last(level)) {
      outputs_[level]->report(mesh);
      report_defects(simplifier_.defects(level), mesh);
    }
    if (report.locked_vertices > 0) outputs_[level]->report_locked(mesh);
  }
  if (target_) report_target(simplifier_.counts(), task_, target_->number(), report);
}

std::uint64_t HostBackEnd::inherited() const {
  return task_.needed ? simplifier_.zone().front_size() : full_output_.front_size();
}

void HostBackEnd::serialize(StateWriter& state) const {
  state.value(std::uint8_t{task_.needed});
  if (!task_.needed) return full_output_.serialize(state);
  for (const auto& output : outputs_) output->serialize(state);
  if (target_) {
    const HeadStart& head_start = target_->head_start();
    state.value(head_start.cost);
    state.value(head_start.met);
    state.value(head_start.counts);
  }
  simplifier_.serialize(state);
  if (target_) simplifier_.serialize_removed(state);
}

void HostBackEnd::serialize(StateReader& state) {
  require_kind(state, task_.needed);
  if (!task_.needed) return full_output_.serialize(state);
  PartShape shape = part_shape(task_);
  for (const auto& output : outputs_) {
    output->serialize(state);
    shape.ends.push_back(output->end());
  }
  if (target_) {
    HeadStart head_start;
    state.value(head_start.cost);
    state.value(head_start.met);
    state.value(head_start.counts);
    target_->begin_with(head_start);
    shape.retire = simplifier_.zone().options.retire;
    if (counts()) shape.ends.back() = {kNotHandedOver, ~std::uint32_t{0}};  // nothing was written
  }
  simplifier_.serialize(state, shape);
  if (target_) simplifier_.serialize_removed(state);
}

}  // namespace isoweave
