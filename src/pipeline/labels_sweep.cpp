#include "pipeline/labels_sweep.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"
#include "system/process_memory.hpp"
#include "volume/label_box.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

Region whole_of(const VolumeInfo& volume) { return {{0, 0, 0}, volume.dims}; }

double slice_area(const Region& box) {
  return static_cast<double>(box.end[0] - box.first[0]) * static_cast<double>(box.end[1] - box.first[1]);
}

double samples_in(const Region& box) { return slice_area(box) * static_cast<double>(box.end[2] - box.first[2]); }

}  // namespace

bool is_empty(const Region& box) {
  return box.first[0] >= box.end[0] || box.first[1] >= box.end[1] || box.first[2] >= box.end[2];
}

MeshOptions mask_options(const MeshOptions& options) {
  MeshOptions mask = options;
  mask.iso = 0.5;
  mask.inside_above = true;
  return mask;
}

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

void check_box(const VolumeInfo& map, Label label, const Region& box) {
  if (is_empty(box)) return;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (box.first[axis] >= 0 && box.end[axis] <= map.dims[axis]) continue;
    throw std::invalid_argument(map.path + ": label " + label.text() + ": expected a box within 0:" +
                                std::to_string(map.dims[axis]) + " on axis " + std::to_string(axis) + ", found " +
                                std::to_string(box.first[axis]) + ":" + std::to_string(box.end[axis]));
  }
}

void warn_of_empty_label(const VolumeInfo& map, Label label, MeshReport& report) {
  if (report.triangles > 0) return;
  report.warnings.push_back(map.path + ": label " + label.text() +
                            (report.triangles_extracted > 0 ? " has no triangles left" : " does not occur") +
                            ": its mesh is empty");
}

LabelsSweep::LabelsSweep(SliceSource& part, const std::array<std::int64_t, 3>& first, const Task& task,
                         std::span<const LabelSink> labels, const RunControl& control)
    : numbers_(part),
      first_(first),
      task_(task),
      volume_(task.volume),
      control_(control),
      labels_(labels),
      sweep_(numbers_, task_, control_, *this, report_.total) {
  make_strands();
}

LabelsReport LabelsSweep::run() {
  Stopwatch total;
  sweep_.run();
  finish_labels();
  total.lap(report_.total.seconds_total);
  report_.total.peak_bytes = system::peak_bytes();
  return std::move(report_);
}

// The box, by the places of the part.
Region LabelsSweep::in_part(Region box) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.first[axis] -= first_[axis];
    box.end[axis] -= first_[axis];
  }
  return box;
}

std::unique_ptr<Strand> LabelsSweep::begin(std::size_t n, const SliceWindow& window, const Executor& executor) const {
  const Region box = in_part(boxes_[n]);
  StrandSource source{std::make_unique<LabelBox>(window, box, labels_[n].label), box.first[2],
                      PartOfLattice{volume_.dims, boxes_[n].first}};
  return std::make_unique<Strand>(std::move(source), *labels_[n].sink, task_, control_, executor);
}

// All labels together should have no more triangles than keep all threads busy, and the slices of all boxes should fit
// into the memory for slices. The window keeps the slices before them that a label may not have used yet.
NextSlices LabelsSweep::next(std::int64_t done) const {
  const std::int64_t layers = next_layers(done);
  return {done - slices_kept(task_.surface), layers, layers};
}

void LabelsSweep::make_strands() {
  double all = 0;
  for (const LabelSink& label : labels_) {
    const Region box = label.box.value_or(whole_of(volume_));
    check_box(volume_, label.label, box);
    boxes_.push_back(is_empty(box) ? Region{} : box_to_sweep(box, volume_, task_.surface));
    all += samples_in(boxes_.back());
  }
  for (const Region& box : boxes_) {
    StrandState& state = sweep_.strands().emplace_back();
    if (is_empty(box)) continue;
    state.first = in_part(box).first[2];
    state.end = in_part(box).end[2];
    state.large = samples_in(box) * sweep_.executor().threads() > all;
  }
}

std::int64_t LabelsSweep::next_layers(std::int64_t done) const {
  const std::int64_t left = numbers_.info().dims[2] - done;
  if (control_.slab > 0) return std::min(control_.slab, left);
  const std::int64_t recent = sweep_.recent_layers();
  const SlabGoal& goal = slab_goal(task_.simplify.needed);
  const std::int64_t doubled = recent > 0 ? 2 * recent : 8;
  constexpr double kFloatBytes = sizeof(float);
  constexpr double kSliceBytes = 64 << 20;
  double slice = 2 * static_cast<double>(numbers_.info().slice_bytes());
  std::uint64_t triangles = 0;
  for (std::size_t n = 0; n < boxes_.size(); ++n) {
    const Region box = in_part(boxes_[n]);
    const bool is_on = box.first[2] < done + doubled && done < box.end[2];
    if (is_on) slice += slice_area(box) * (task_.surface.smooth > 0 ? kFloatBytes : 1);
    triangles += sweep_.strands()[n].recent_triangles;
  }
  const double per_layer = static_cast<double>(triangles) / static_cast<double>(std::max<std::int64_t>(recent, 1));
  const double most = std::min({kSliceBytes / slice, goal.triangles / (per_layer + 0.01) + 1, 64.0});
  return std::clamp<std::int64_t>(static_cast<std::int64_t>(most), 1, std::min(doubled, left));
}

void LabelsSweep::finish_labels() {
  sweep_.add_up();
  for (std::size_t n = 0; n < labels_.size(); ++n) {
    MeshReport& label = sweep_.strands()[n].report;
    warn_of_empty_label(volume_, labels_[n].label, label);
    report_.labels.push_back(std::move(label));
  }
  report_.total.min = sweep_.range().min;
  report_.total.max = sweep_.range().max;
}

}  // namespace isoweave
