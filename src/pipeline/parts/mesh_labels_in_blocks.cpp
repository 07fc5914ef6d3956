// Meshes of labels in blocks: of the labels that lie in a box together, and of each that is larger by itself.
#include <algorithm>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/blocks.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/labels_sweep.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/label_boxes.hpp"
#include "pipeline/parts/mesh_box_in_blocks.hpp"
#include "pipeline/run_report.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

class LabelsInBlocks {
 public:
  LabelsInBlocks(const VolumeOpener& open, std::span<const LabelSink> labels, const MeshOptions& options,
                 const BlockOptions& blocks, const RunControl& control)
      : open_(open), labels_(labels), options_(options), blocks_(blocks), control_(control), map_(open()) {
    require_possible(RunKind::kLabels, options, control);
    check_blocks(*map_, blocks);
    task_ = resolve_labels(*map_, labels, options, control);
    for (const LabelSink& label : labels_) {
      const Region box = label.box.value_or(Region{{0, 0, 0}, task_.volume.dims});
      check_box(task_.volume, label, box);
      boxes_.push_back(is_empty(box) ? Region{} : box_to_sweep(box, task_.volume, task_.surface));
    }
  }

  LabelsReport run() {
    Stopwatch total;
    start_report();
    const GroupedLabels grouped = group_labels(boxes_, blocks_.size);
    if (!grouped.large.empty()) require_possible(RunKind::kBlocks, options_, control_);
    const std::size_t steps = grouped.groups.size() + grouped.large.size();
    for (const LabelGroup& group : grouped.groups) {
      mesh_group(group);
      tell(++steps_done_, steps);
    }
    for (const std::size_t n : grouped.large) {
      mesh_large(n);
      tell(++steps_done_, steps);
    }
    finish_report();
    for (const LabelSink& label : labels_) label.sink->finish();
    total.lap(report_.total.seconds_total);
    return std::move(report_);
  }

 private:
  // A run without reports of its own progress.
  RunControl quiet_control() const {
    RunControl control = control_;
    control.progress = nullptr;
    return control;
  }

  // Sweeps the box of a group. Positions and ids are those of the whole map.
  void mesh_group(const LabelGroup& group) {
    std::vector<LabelSink> sinks;
    for (const std::size_t n : group.labels) sinks.push_back(labels_[n]);
    const std::unique_ptr<SliceSource> part = crop_volume(open_(), group.box);
    const RunControl control = quiet_control();
    LabelsReport made = LabelsSweep(*part, group.box.first, task_, sinks, control).run();
    for (std::size_t n = 0; n < group.labels.size(); ++n) keep(group.labels[n], std::move(made.labels[n]));
    report_.total.seconds_read += made.total.seconds_read;
    report_.total.schedule = made.total.schedule;
    report_.total.sweep.insert(report_.total.sweep.end(), made.total.sweep.begin(), made.total.sweep.end());
  }

  // Takes the mask of a label in blocks: those that its box touches.
  void mesh_large(std::size_t n) {
    MeshSink* const sinks[] = {labels_[n].sink};
    const RunControl control = quiet_control();
    const VolumeOpener mask = [&] { return label_volume(open_(), labels_[n].label); };
    MeshReport made = mesh_box_in_blocks(mask, boxes_[n], sinks, mask_options(options_), blocks_, control);
    made.sweep.clear();
    made.blocks.clear();
    keep(n, std::move(made));
  }

  void keep(std::size_t n, MeshReport report) {
    add_to(report_.total, report);
    report_.labels[n] = std::move(report);
  }

  void tell(std::size_t done, std::size_t of) const {
    check_stop(control_);
    if (!control_.progress) return;
    const std::uint64_t bytes = report_.total.sweep.empty() ? 0 : report_.total.sweep.back().bytes;
    control_.progress(
        {static_cast<std::int64_t>(done), static_cast<std::int64_t>(of), 0, 0, report_.total.triangles, bytes});
  }

  void start_report() {
    report_.labels.resize(labels_.size());
    report_.total.threads = Executor(control_.threads).threads();
    report_.total.slab = control_.slab;
    report_.total.error = task_.simplify.error;
    const SampleRange none;
    report_.total.min = none.min;
    report_.total.max = none.max;
    warn_of_floats(map_->info(), labels_, report_.total);
    warn_of_space(task_, report_.total);
    warn_of_rounding(task_, report_.total);
  }

  void finish_report() {
    for (std::size_t n = 0; n < labels_.size(); ++n) {
      report_.labels[n].error = task_.simplify.error;
      warn_of_empty_label(task_.volume, labels_[n].label, report_.labels[n]);
    }
    report_.total.peak_bytes = system::peak_bytes();
  }

  const VolumeOpener& open_;
  const std::span<const LabelSink> labels_;
  const MeshOptions& options_;
  const BlockOptions& blocks_;
  const RunControl& control_;
  const std::unique_ptr<SliceSource> map_;
  Task task_;
  std::vector<Region> boxes_;  // that are swept; empty: the label does not occur
  LabelsReport report_;
  std::size_t steps_done_ = 0;
};

}  // namespace

LabelsReport mesh_labels_in_blocks(const VolumeOpener& open, std::span<const LabelSink> labels,
                                   const MeshOptions& options, const BlockOptions& blocks, const RunControl& control) {
  const StandardFloats floats;
  return LabelsInBlocks(open, labels, options, blocks, control).run();
}

}  // namespace isoweave
