#include "pipeline/volume_sweep.hpp"

#include <utility>

#include "extract/make_extractor.hpp"
#include "pipeline/run_report.hpp"
#include "volume/row_source.hpp"

namespace isoweave {

VolumeSweep::VolumeSweep(SliceSource& source, const Task& task, const RunControl& control, MeshReport& report)
    : source_(source),
      indexed_(indexed(source, control.index, task.surface, task.has_normals())),
      task_(task),
      control_(control),
      report_(report),
      reader_bytes_(held_by_slices(this->source())),
      executor_(control.threads),
      field_(this->source(), task.surface, executor_, control.measure) {}

std::unique_ptr<Extractor> VolumeSweep::make_extractor() const {
  return isoweave::make_extractor(task_.surface.extractor, field_.info(), {field_.rule(), task_.has_normals()},
                                  executor_);
}

void VolumeSweep::begin(Extractor& extractor, std::vector<PieceStage*> stages, BackEnd* back_end) {
  extractor_ = &extractor;
  layers_ = extractor.layers_left();
  planner_.emplace(task_, control_, field_.info(), extractor, executor_.threads(), reader_bytes_);
  pieces_.emplace(task_, field_, extractor, *planner_, executor_);
  if (task_.surface.closed) pieces_->count_caps();
  loop_.emplace(*pieces_, std::move(stages), back_end, report_);
  find_constant();
}

// Finds a volume of one value outside. It has no surface, and may declare more samples than anyone can look at.
void VolumeSweep::find_constant() {
  const VolumeInfo& volume = task_.volume;
  const std::optional<SampleBytes> sample = constant_sample(source_);
  if (!sample || is_inside(*sample, volume.type, task_.rule)) return;
  all_outside_ = true;
  pieces_->set_range(range_of_constant(*sample, volume));
}

void VolumeSweep::step() {
  SlabRecord record = loop_->step();
  record.layer = layers_done();
  planner_->weigh_zone(record, loop_->held());
  report_.sweep.push_back(record);
  tell(record);
}

void VolumeSweep::tell(const SlabRecord& record) {
  const Progress progress{record.layer,           layers_,     pieces_->voxels(), record.live_triangles,
                          record.final_triangles, record.bytes};
  if (control_.progress) control_.progress(progress);
  if (control_.observer == nullptr) return;
  control_.observer->end_slab(progress, record,
                              [&](const SweepObserver::Visitor& visitor) { loop_->view_undecided(visitor); });
}

void VolumeSweep::finish() {
  loop_->finish();
  report_samples(task_.volume, pieces_->range(), report_);
  if (task_.surface.closed && task_.measured) report_.cap_cells = pieces_->cap_samples();
  if (!indexed_) return;
  const LeftOut left_out = indexed_->left_out();
  report_.left_out = {left_out.chunks, left_out.chunks_left_out, left_out.bytes_left_out};
}

}  // namespace isoweave
