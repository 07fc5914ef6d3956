#include "pipeline/label_sweep.hpp"

#include <algorithm>
#include <vector>

#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"

namespace isoweave {

// A layer needs the slice above it and, for normals, one slice more. Smoothing needs two more for each pass.
std::int64_t slices_kept(const SurfaceOptions& options) { return 2 + 2 * static_cast<std::int64_t>(options.smooth); }

Region box_to_sweep(const Region& box, const VolumeInfo& volume, const SurfaceOptions& options) {
  // Crossings lie beside an inside sample. Gradients look one sample further, and smoothing two for each pass.
  const std::int64_t margin = 2 + 2 * static_cast<std::int64_t>(std::max(options.smooth, 0));
  Region swept;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    swept.first[axis] = std::max<std::int64_t>(box.first[axis] - margin, 0);
    swept.end[axis] = std::min(box.end[axis] + margin, volume.dims[axis]);
  }
  return swept;
}

LabelPieces::LabelPieces(SurfaceField& field, Extractor& extractor, std::int64_t slab, bool simplifies)
    : field_(field),
      extractor_(extractor),
      slab_(slab),
      most_vertices_(slab > 0 ? ~std::uint64_t{0} : slab_goal(simplifies).most_vertices),
      window_(field.source(), 0, SliceWindow::Reading::kInPlace) {}

std::int64_t LabelPieces::layers_ready() const {
  const std::int64_t slices = field_.info().dims[2];
  const std::int64_t there = field_.slices_from(std::min(end_, slices));
  return there == slices ? extractor_.layers_left() : there - extractor_.slices_for(0).second;
}

void LabelPieces::read(const Held&, MeshReport& report) {
  Stopwatch clock;
  layers_ = slab_ > 0 ? std::min(layers_ready(), slab_) : layers_ready();
  const auto [first, end] = extractor_.slices_for(layers_);
  window_.advance(first, end);
  clock.lap(report.seconds_read);
}

void LabelPieces::make(SurfacePiece& piece, MeshReport& report) {
  Stopwatch clock;
  const SlabCounts slab = extractor_.extract(window_, layers_, most_vertices_, piece);
  add_extracted(slab, report);
  clock.lap(report.seconds_extract);
}

LabelSweep::LabelSweep(const SliceWindow& map, const Region& box, const LabelSink& label, const Task& task,
                       const RunControl& control, const Executor& executor)
    : executor_(executor),
      box_(map, box, label.label),
      field_(box_, task.surface, executor_, false),
      world_(task.volume.geometry, task.space, label.sink->offset()),
      sink_(label.sink),
      extractor_(make_extractor(task.surface.extractor, field_.info(),
                                {field_.rule(), task.has_normals(), PartOfLattice{task.volume.dims, box.first}},
                                executor_)),
      back_end_(task.simplify, world_, std::span(&sink_, 1), executor_, control, control.stop.get()),
      pieces_(field_, *extractor_, control.slab, task.simplify.needed),
      loop_(pieces_, {}, &back_end_, report_) {
  report_.error = task.simplify.error;
}

void LabelSweep::sweep_below(std::int64_t end) {
  pieces_.set_end(end - box_.first_slice());
  while (!loop_.complete() && pieces_.layers_ready() > 0) record_ = loop_.step();
}

MeshReport LabelSweep::finish() {
  loop_.wait_for_sinks();
  loop_.finish();
  return std::move(report_);
}

}  // namespace isoweave
