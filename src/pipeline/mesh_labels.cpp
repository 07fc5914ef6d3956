// Many labels in one sweep: each slice of the map is read once and handed to every label whose box holds a part of it.
#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "isoweave/pipeline.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/label_sweep.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/run_identity.hpp"
#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"
#include "system/process_memory.hpp"
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

// A label on its way through the sweep.
struct Lane {
  const LabelSink* label = nullptr;
  Region box;          // that is swept; empty: the label does not occur
  bool large = false;  // worth all threads
  bool done = false;
  std::unique_ptr<LabelSweep> sweep;  // from the first slab of the box to the last one
  MeshReport report;
};

// Adds the counts and times of a label to those of all labels.
void add_to(MeshReport& total, const MeshReport& label) {
  total.triangles += label.triangles;
  total.vertices += label.vertices;
  total.open_edges += label.open_edges;
  total.nonmanifold_edges += label.nonmanifold_edges;
  total.nonmanifold_vertices += label.nonmanifold_vertices;
  total.components += label.components;
  total.euler += label.euler;
  total.digest += label.digest;
  total.cells_crossed += label.cells_crossed;
  total.triangles_extracted += label.triangles_extracted;
  total.vertices_extracted += label.vertices_extracted;
  total.collapses += label.collapses;
  total.postponed += label.postponed;
  total.rekeyed += label.rekeyed;
  total.rounds += label.rounds;
  total.specks += label.specks;
  total.seconds_extract += label.seconds_extract + label.seconds_read;
  total.seconds_simplify += label.seconds_simplify;
  total.seconds_write += label.seconds_write;
}

class LabelsSweep {
 public:
  LabelsSweep(SliceSource& map, std::span<const LabelSink> labels, const MeshOptions& options,
              const RunControl& control)
      : numbers_(map),
        task_(resolve(numbers_.info(), mask_options(options), control, common_offset(sinks_of(labels)),
                      RunKind::kLabels)),
        volume_(task_.volume),
        control_(control),
        executor_(control.threads),
        window_(numbers_, 0, SliceWindow::reading_with(executor_.threads())) {
    warn_of_floats(map.info().type, labels);
    make_lanes(labels);
  }

  LabelsReport run() {
    Stopwatch total;
    start_report();
    while (done_ < volume_.dims[2]) {
      check_stop(control_);
      read_slab();
      sweep_slab();
      record_slab();
    }
    require_unchanged(task_, identity_);
    finish_labels();
    total.lap(report_.total.seconds_total);
    report_.total.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

 private:
  void make_lanes(std::span<const LabelSink> labels) {
    double all = 0;
    for (const LabelSink& label : labels) {
      const Region box = label.box.value_or(whole_of(volume_));
      check_box(label, box);
      Lane& lane = lanes_.emplace_back();
      lane.label = &label;
      if (!is_empty(box)) lane.box = box_to_sweep(box, volume_, task_.surface);
      all += samples_in(lane.box);
    }
    for (Lane& lane : lanes_) lane.large = samples_in(lane.box) * executor_.threads() > all;
  }

  void warn_of_floats(SampleType type, std::span<const LabelSink> labels) {
    constexpr std::uint64_t kLargestWhole = std::uint64_t{1} << 24;  // whole numbers up to it are float32, all of them
    const bool large = std::ranges::any_of(labels, [](const LabelSink& sink) {
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

  void start_report() {
    MeshReport& total = report_.total;
    total.threads = executor_.threads();
    total.slab = control_.slab;
    total.schedule = control_.schedule == Schedule::kAutomatic ? Schedule::kLocal : control_.schedule;
    total.error = task_.simplify.error;
    warn_of_space(task_, total);
    warn_of_rounding(task_, total);
  }

  // The layers of the next slab. All labels together should have no more triangles than keep all threads busy, and the
  // slices of all boxes should fit into the memory for slices.
  std::int64_t next_layers() const {
    if (control_.slab > 0) return std::min(control_.slab, volume_.dims[2] - done_);
    const SlabGoal& goal = slab_goal(task_.simplify.needed);
    const std::int64_t doubled = recent_layers_ > 0 ? 2 * recent_layers_ : 8;
    constexpr double kFloatBytes = sizeof(float);
    constexpr double kSliceBytes = 64 << 20;
    double slice = 2 * static_cast<double>(volume_.slice_bytes());
    for (const Lane& lane : lanes_) {
      const bool is_on = lane.box.first[2] < done_ + doubled && done_ < lane.box.end[2];
      if (is_on) slice += slice_area(lane.box) * (task_.surface.smooth > 0 ? kFloatBytes : 1);
    }
    const double recent = static_cast<double>(std::max<std::int64_t>(recent_layers_, 1));
    const double per_layer = static_cast<double>(recent_triangles_) / recent;
    const double most = std::min({kSliceBytes / slice, goal.triangles / (per_layer + 0.01) + 1, 64.0});
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(most), 1, std::min(doubled, volume_.dims[2] - done_));
  }

  // Reads the slices of the next slab. The window keeps the slices before them that a label may not have used yet.
  void read_slab() {
    Stopwatch clock;
    const std::int64_t layers = next_layers();
    window_.advance(done_ - slices_kept(task_.surface), done_ + layers, layers);
    if (control_.measure) {
      for (std::int64_t k = done_; k < done_ + layers; ++k) {
        range_.merge(sample_range(window_.slice(k), volume_.type, volume_.slice_samples()));
      }
    }
    recent_layers_ = layers;
    done_ += layers;
    clock.lap(report_.total.seconds_read);
  }

  // Sweeps the slab in every label: large labels one after the other by all threads, then small ones side by side by
  // one thread each.
  void sweep_slab() {
    std::vector<Lane*> small;
    for (Lane& lane : lanes_) {
      const bool is_on = !is_empty(lane.box) && lane.box.first[2] < done_ && !lane.done;
      if (is_on) lane.large ? sweep(lane, executor_) : small.push_back(&lane);
    }
    const Executor alone(1);
    executor_.for_each(static_cast<std::int64_t>(small.size()), 1,
                       [&](std::int64_t n) { sweep(*small[static_cast<std::size_t>(n)], alone); });
  }

  void sweep(Lane& lane, const Executor& executor) const {
    if (lane.sweep == nullptr) {
      lane.sweep = std::make_unique<LabelSweep>(window_, lane.box, *lane.label, task_, control_, executor);
    }
    lane.sweep->sweep_below(done_);
  }

  // Adds up what the labels hold and have written. A label that is done gives its memory back.
  void record_slab() {
    SlabRecord record;
    record.layer = done_;
    record.bytes = window_.bytes();
    std::uint64_t extracted = 0;
    for (Lane& lane : lanes_) {
      if (lane.sweep != nullptr) {
        const SlabRecord& label = lane.sweep->record();
        record.live_triangles += label.live_triangles;
        record.undecided_triangles += label.undecided_triangles;
        record.bytes += label.bytes;
        lane.report = lane.sweep->report();
      }
      record.final_triangles += lane.report.triangles;
      extracted += lane.report.triangles_extracted;
      if (lane.sweep == nullptr || !lane.sweep->is_done()) continue;
      lane.done = true;
      lane.report = lane.sweep->finish();
      lane.sweep.reset();
    }
    recent_triangles_ = extracted - extracted_;
    extracted_ = extracted;
    report_.total.sweep.push_back(record);
    if (!control_.progress) return;
    const auto voxels = static_cast<std::uint64_t>(done_ * volume_.slice_samples());
    control_.progress({done_, volume_.dims[2], voxels, record.live_triangles, record.final_triangles, record.bytes});
  }

  void finish_labels() {
    for (Lane& lane : lanes_) {
      if (lane.report.triangles == 0) {
        lane.report.warnings.push_back(
            volume_.path + ": label " + lane.label->label.text() +
            (lane.report.triangles_extracted > 0 ? " has no triangles left" : " does not occur") +
            ": its mesh is empty");
      }
      lane.report.error = report_.total.error;
      add_to(report_.total, lane.report);
      report_.labels.push_back(std::move(lane.report));
    }
    for (const Lane& lane : lanes_) lane.label->sink->finish();
    report_.total.min = range_.min;
    report_.total.max = range_.max;
  }

  LabelNumbers numbers_;
  const Task task_;
  const VolumeInfo& volume_;
  const RunControl& control_;
  const RunIdentity identity_ = identity_of(task_);
  const Executor executor_;
  SliceWindow window_;
  std::vector<Lane> lanes_;
  LabelsReport report_;
  SampleRange range_;
  std::int64_t done_ = 0;  // slices that all labels have taken
  std::int64_t recent_layers_ = 0;
  std::uint64_t recent_triangles_ = 0, extracted_ = 0;
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
