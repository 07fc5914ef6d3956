#include "pipeline/strand.hpp"

#include <algorithm>
#include <utility>

#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"

namespace isoweave {

// A layer needs the slice above it and, for normals, one slice more. Smoothing needs two more for each pass.
std::int64_t slices_kept(const SurfaceOptions& options) { return 2 + 2 * static_cast<std::int64_t>(options.smooth); }

StrandPieces::StrandPieces(SurfaceField& field, Extractor& extractor, const SliceWindow* shared, std::int64_t slab,
                           bool simplifies)
    : field_(field), extractor_(extractor), shared_(shared), slab_(slab), simplifies_(simplifies) {
  if (shared_ == nullptr) own_.emplace(field.source(), 0, SliceWindow::Reading::kInPlace);
}

std::int64_t StrandPieces::layers_ready() const {
  const std::int64_t slices = field_.info().dims[2];
  const std::int64_t there = field_.slices_from(std::min(end_, slices));
  return there == slices ? extractor_.layers_left() : there - extractor_.slices_for(0).second;
}

void StrandPieces::read(const Held& held, MeshReport& report) {
  Stopwatch clock;
  const SlabGoal goal = beside_zone(slab_goal(simplifies_), static_cast<double>(held.triangles - held.waiting));
  most_vertices_ = slab_ > 0 ? ~std::uint64_t{0} : goal.most_vertices;
  layers_ = slab_ > 0 ? std::min(layers_ready(), slab_) : layers_ready();
  const auto [first, end] = extractor_.slices_for(layers_);
  if (own_) own_->advance(first, end);
  clock.lap(report.seconds_read);
}

void StrandPieces::make(SurfacePiece& piece, MeshReport& report) {
  Stopwatch clock;
  const SlabCounts slab = extractor_.extract(own_ ? *own_ : *shared_, layers_, most_vertices_, piece);
  add_extracted(slab, report);
  clock.lap(report.seconds_extract);
}

Strand::Strand(StrandSource source, MeshSink& sink, const Task& task, const RunControl& control,
               const Executor& executor)
    : executor_(executor),
      source_(std::move(source)),
      field_(*source_.slices, task.surface, executor_, false),
      world_(task.volume.geometry, task.space, task.offset),
      sink_(&sink),
      extractor_(make_extractor(task.surface.extractor, field_.info(),
                                {field_.rule(), task.has_normals(), source_.part_of}, executor_)),
      back_end_(task.simplify, world_, std::span(&sink_, 1), executor_, control, control.stop.get()),
      pieces_(field_, *extractor_, task.surface.smooth > 0 ? nullptr : source_.window, control.slab,
              task.simplify.needed),
      loop_(pieces_, {}, &back_end_, report_) {
  report_.error = task.simplify.error;
}

void Strand::sweep_below(std::int64_t end) {
  pieces_.set_end(end - source_.first_slice);
  while (!loop_.complete() && pieces_.layers_ready() > 0) record_ = loop_.step();
}

MeshReport Strand::finish() {
  loop_.wait_for_sinks();
  loop_.finish();
  return std::move(report_);
}

}  // namespace isoweave
