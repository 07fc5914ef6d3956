#include "pipeline/strands.hpp"

#include <algorithm>

#include "pipeline/loop.hpp"
#include "pipeline/run_report.hpp"

namespace isoweave {

void add_to(MeshReport& total, const MeshReport& mesh) {
  total.triangles += mesh.triangles;
  total.vertices += mesh.vertices;
  total.open_edges += mesh.open_edges;
  total.nonmanifold_edges += mesh.nonmanifold_edges;
  total.nonmanifold_vertices += mesh.nonmanifold_vertices;
  total.components += mesh.components;
  total.euler += mesh.euler;
  total.error = std::max(total.error, mesh.error);
  total.digest += mesh.digest;
  total.cells_crossed += mesh.cells_crossed;
  total.triangles_extracted += mesh.triangles_extracted;
  total.vertices_extracted += mesh.vertices_extracted;
  total.collapses += mesh.collapses;
  total.postponed += mesh.postponed;
  total.rekeyed += mesh.rekeyed;
  total.rounds += mesh.rounds;
  total.specks += mesh.specks;
  total.seconds_extract += mesh.seconds_extract + mesh.seconds_read;
  total.seconds_simplify += mesh.seconds_simplify;
  total.seconds_write += mesh.seconds_write;
}

StrandsSweep::StrandsSweep(SliceSource& volume, const Task& task, const RunControl& control, const StrandGuide& guide,
                           MeshReport& total)
    : slices_(volume.info()),
      task_(task),
      control_(control),
      guide_(guide),
      total_(total),
      identity_(identity_of(task)),
      executor_(control.threads),
      window_(volume, 0, SliceWindow::reading_with(executor_.threads())) {}

void StrandsSweep::run() {
  start_report();
  while (done_ < slices_.dims[2]) {
    check_stop(control_);
    read_slab();
    sweep_slab();
    record_slab();
  }
  require_unchanged(task_, identity_);
}

void StrandsSweep::skip(const SampleBytes& sample) {
  start_report();
  range_ = range_of_constant(sample, task_.volume);
}

void StrandsSweep::start_report() {
  total_.threads = executor_.threads();
  total_.slab = control_.slab;
  total_.schedule = control_.schedule == Schedule::kAutomatic ? Schedule::kLocal : control_.schedule;
  for (StrandState& state : strands_) report_no_triangles(task_.simplify, state.report);
  warn_of_space(task_, total_);
  warn_of_rounding(task_, total_);
}

void StrandsSweep::read_slab() {
  Stopwatch clock;
  const NextSlices next = guide_.next(done_);
  window_.advance(next.kept, done_ + next.count, next.ahead);
  if (control_.measure) {
    for (std::int64_t k = done_; k < done_ + next.count; ++k) {
      range_.merge(sample_range(window_.slice(k), slices_.type, slices_.slice_samples()));
    }
  }
  recent_layers_ = next.count;
  done_ += next.count;
  clock.lap(total_.seconds_read);
}

// Sweeps the slab in every strand: large ones one after the other by all threads, then small ones side by side by one
// thread each.
void StrandsSweep::sweep_slab() {
  std::vector<std::size_t> small;
  for (std::size_t n = 0; n < strands_.size(); ++n) {
    const StrandState& state = strands_[n];
    const bool is_on = state.first < state.end && state.first < done_ && !state.done;
    if (is_on) state.large ? sweep(n, executor_) : small.push_back(n);
  }
  const Executor alone(1);
  executor_.for_each(static_cast<std::int64_t>(small.size()), 1,
                     [&](std::int64_t n) { sweep(small[static_cast<std::size_t>(n)], alone); });
}

void StrandsSweep::sweep(std::size_t n, const Executor& executor) {
  std::unique_ptr<Strand>& strand = strands_[n].strand;
  if (strand == nullptr) strand = guide_.begin(n, window_, executor);
  strand->sweep_below(done_);
}

// Adds up what the strands hold and have written. A strand that is done gives its memory back.
void StrandsSweep::record_slab() {
  SlabRecord sum;
  sum.layer = done_;
  sum.bytes = window_.bytes();
  for (StrandState& state : strands_) record(state, sum);
  total_.sweep.push_back(sum);
  if (!control_.progress) return;
  const auto voxels = static_cast<std::uint64_t>(done_ * slices_.slice_samples());
  control_.progress({done_, slices_.dims[2], voxels, sum.live_triangles, sum.final_triangles, sum.bytes});
}

void StrandsSweep::record(StrandState& state, SlabRecord& record) const {
  const std::uint64_t extracted = state.report.triangles_extracted;
  state.undecided = 0;
  if (state.strand != nullptr) {
    const SlabRecord& of_strand = state.strand->record();
    record.live_triangles += of_strand.live_triangles;
    record.undecided_triangles += of_strand.undecided_triangles;
    record.bytes += of_strand.bytes;
    state.undecided = of_strand.undecided_triangles;
    state.report = state.strand->report();
  }
  state.recent_triangles = state.report.triangles_extracted - extracted;
  record.final_triangles += state.report.triangles;
  if (state.strand == nullptr || !state.strand->is_done()) return;
  state.done = true;
  state.report = state.strand->finish();
  state.strand.reset();
}

void StrandsSweep::add_up() {
  for (const StrandState& state : strands_) add_to(total_, state.report);
}

}  // namespace isoweave
