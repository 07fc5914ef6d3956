// Many labels in one sweep: each slice of the map is read once and handed to every label whose box holds a part of it.
#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"
#include "pipeline/strands.hpp"
#include "system/process_memory.hpp"
#include "volume/label_box.hpp"
#include "volume/labels.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// The options for the mask of a label, which has the values 0 and 1 whatever the iso-value of the volume was to be.
MeshOptions mask_options(const MeshOptions& options) {
  MeshOptions mask = options;
  mask.iso = 0.5;
  mask.inside_above = true;
  return mask;
}

std::vector<MeshSink*> sinks_of(std::span<const LabelSink> labels) {
  std::vector<MeshSink*> sinks;
  for (const LabelSink& label : labels) sinks.push_back(label.sink);
  require_different(sinks);
  return sinks;
}

Region whole_of(const VolumeInfo& volume) { return {{0, 0, 0}, volume.dims}; }

bool is_empty(const Region& box) {
  return box.first[0] >= box.end[0] || box.first[1] >= box.end[1] || box.first[2] >= box.end[2];
}

double slice_area(const Region& box) {
  return static_cast<double>(box.end[0] - box.first[0]) * static_cast<double>(box.end[1] - box.first[1]);
}

double samples_in(const Region& box) { return slice_area(box) * static_cast<double>(box.end[2] - box.first[2]); }

// The box in which the surface around all samples of `box` lies. At its border, extraction and smoothing see the same
// samples as in the whole volume.
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

class LabelsSweep final : public StrandGuide {
 public:
  LabelsSweep(SliceSource& map, std::span<const LabelSink> labels, const MeshOptions& options,
              const RunControl& control)
      : numbers_(map),
        task_(resolve(numbers_.info(), mask_options(options), control, common_offset(sinks_of(labels)),
                      RunKind::kLabels)),
        volume_(task_.volume),
        control_(control),
        labels_(labels),
        sweep_(numbers_, task_, control_, *this, report_.total) {
    warn_of_floats(map.info().type);
    make_strands();
  }

  LabelsReport run() {
    Stopwatch total;
    sweep_.run();
    finish_labels();
    total.lap(report_.total.seconds_total);
    report_.total.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

  std::unique_ptr<Strand> begin(std::size_t n, const SliceWindow& window, const Executor& executor) const override {
    const Region& box = boxes_[n];
    StrandSource source{std::make_unique<LabelBox>(window, box, labels_[n].label), box.first[2],
                        PartOfLattice{volume_.dims, box.first}};
    return std::make_unique<Strand>(std::move(source), *labels_[n].sink, task_, control_, executor);
  }

  // All labels together should have no more triangles than keep all threads busy, and the slices of all boxes should
  // fit into the memory for slices. The window keeps the slices before them that a label may not have used yet.
  NextSlices next(std::int64_t done) const override {
    const std::int64_t layers = next_layers(done);
    return {done - slices_kept(task_.surface), layers, layers};
  }

 private:
  void make_strands() {
    double all = 0;
    for (const LabelSink& label : labels_) {
      const Region box = label.box.value_or(whole_of(volume_));
      check_box(label, box);
      boxes_.push_back(is_empty(box) ? Region{} : box_to_sweep(box, volume_, task_.surface));
      all += samples_in(boxes_.back());
    }
    for (const Region& box : boxes_) {
      StrandState& state = sweep_.strands().emplace_back();
      state.first = box.first[2];
      state.end = box.end[2];
      state.large = samples_in(box) * sweep_.executor().threads() > all;
    }
  }

  void warn_of_floats(SampleType type) {
    constexpr std::uint64_t kLargestWhole = std::uint64_t{1} << 24;  // whole numbers up to it are float32, all of them
    const bool large = std::ranges::any_of(labels_, [](const LabelSink& sink) {
      return (sink.label.is_negative() ? -sink.label.bits() : sink.label.bits()) > kLargestWhole;
    });
    if (type != SampleType::kFloat32 || !large) return;
    report_.total.warnings.push_back(volume_.path +
                                     ": labels beyond 2^24 in float32 may have been rounded: several may be one");
  }

  void check_box(const LabelSink& label, const Region& box) const {
    if (is_empty(box)) return;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (box.first[axis] >= 0 && box.end[axis] <= volume_.dims[axis]) continue;
      throw std::invalid_argument(volume_.path + ": label " + label.label.text() + ": expected a box within 0:" +
                                  std::to_string(volume_.dims[axis]) + " on axis " + std::to_string(axis) + ", found " +
                                  std::to_string(box.first[axis]) + ":" + std::to_string(box.end[axis]));
    }
  }

  std::int64_t next_layers(std::int64_t done) const {
    const std::int64_t left = volume_.dims[2] - done;
    if (control_.slab > 0) return std::min(control_.slab, left);
    const std::int64_t recent = sweep_.recent_layers();
    const SlabGoal& goal = slab_goal(task_.simplify.needed);
    const std::int64_t doubled = recent > 0 ? 2 * recent : 8;
    constexpr double kFloatBytes = sizeof(float);
    constexpr double kSliceBytes = 64 << 20;
    double slice = 2 * static_cast<double>(volume_.slice_bytes());
    std::uint64_t triangles = 0;
    for (std::size_t n = 0; n < boxes_.size(); ++n) {
      const Region& box = boxes_[n];
      const bool is_on = box.first[2] < done + doubled && done < box.end[2];
      if (is_on) slice += slice_area(box) * (task_.surface.smooth > 0 ? kFloatBytes : 1);
      triangles += sweep_.strands()[n].recent_triangles;
    }
    const double per_layer = static_cast<double>(triangles) / static_cast<double>(std::max<std::int64_t>(recent, 1));
    const double most = std::min({kSliceBytes / slice, goal.triangles / (per_layer + 0.01) + 1, 64.0});
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(most), 1, std::min(doubled, left));
  }

  void finish_labels() {
    sweep_.add_up();
    for (std::size_t n = 0; n < labels_.size(); ++n) {
      MeshReport& label = sweep_.strands()[n].report;
      if (label.triangles == 0) {
        label.warnings.push_back(volume_.path + ": label " + labels_[n].label.text() +
                                 (label.triangles_extracted > 0 ? " has no triangles left" : " does not occur") +
                                 ": its mesh is empty");
      }
      report_.labels.push_back(std::move(label));
    }
    for (const LabelSink& label : labels_) label.sink->finish();
    report_.total.min = sweep_.range().min;
    report_.total.max = sweep_.range().max;
  }

  LabelNumbers numbers_;
  const Task task_;
  const VolumeInfo& volume_;
  const RunControl& control_;
  const std::span<const LabelSink> labels_;
  std::vector<Region> boxes_;  // that are swept; empty: the label does not occur
  LabelsReport report_;
  StrandsSweep sweep_;
};

}  // namespace

void add_layer(LabelsReport& report, LabelsReport&& layer) {
  MeshReport& total = report.total;
  SampleRange range{total.min, total.max, total.nan};
  range.merge({layer.total.min, layer.total.max, layer.total.nan});
  total.min = range.min;
  total.max = range.max;
  total.seconds_read += std::exchange(layer.total.seconds_read, 0);
  add_to(total, layer.total);
  total.seconds_total += layer.total.seconds_total;
  total.peak_bytes = std::max(total.peak_bytes, layer.total.peak_bytes);
  total.sweep.insert(total.sweep.end(), layer.total.sweep.begin(), layer.total.sweep.end());
  for (MeshReport& label : layer.labels) report.labels.push_back(std::move(label));
}

LabelsReport mesh_labels(SliceSource& volume, std::span<const LabelSink> labels, const MeshOptions& options,
                         const RunControl& control) {
  const StandardFloats floats;
  checked_volume(volume.info(), options.extractor);
  return LabelsSweep(volume, labels, options, control).run();
}

}  // namespace isoweave
