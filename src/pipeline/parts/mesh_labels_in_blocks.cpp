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
  LabelsInBlocks(const VolumeOpener& open, std::span<const LabelExtent> labels, LabelOutput& output,
                 const MeshOptions& options, const BlockOptions& blocks, const RunControl& control)
      : open_(open),
        labels_(labels),
        output_(output),
        options_(options),
        blocks_(blocks),
        control_(control),
        map_(open()) {
    require_possible(RunKind::kLabels, options, control);
    check_blocks(*map_, blocks);
    task_ = resolve_labels(*map_, output.offset(), options, control);
    for (const LabelExtent& label : labels_) {
      check_box(task_.volume, label.label, label.box);
      boxes_.push_back(is_empty(label.box) ? Region{} : box_to_sweep(label.box, task_.volume, task_.surface));
    }
  }

  MeshReport run() {
    Stopwatch total;
    start_report();
    for (std::size_t n = 0; n < labels_.size(); ++n) {
      if (is_empty(boxes_[n])) end_empty(n);
    }
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
    report_.peak_bytes = system::peak_bytes();
    total.lap(report_.seconds_total);
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
    for (const std::size_t n : group.labels) sinks.push_back({labels_[n].label, &output_.begin(n), labels_[n].box});
    const std::unique_ptr<SliceSource> part = crop_volume(open_(), group.box);
    const RunControl control = quiet_control();
    LabelsReport made = LabelsSweep(*part, group.box.first, task_, sinks, control).run();
    for (std::size_t n = 0; n < group.labels.size(); ++n) end(group.labels[n], std::move(made.labels[n]));
    report_.seconds_read += made.total.seconds_read;
    report_.schedule = made.total.schedule;
    report_.sweep.insert(report_.sweep.end(), made.total.sweep.begin(), made.total.sweep.end());
  }

  // Takes the mask of a label in blocks: those that its box touches.
  void mesh_large(std::size_t n) {
    MeshSink* const sinks[] = {&output_.begin(n)};
    const RunControl control = quiet_control();
    const VolumeOpener mask = [&] { return label_volume(open_(), labels_[n].label); };
    MeshReport made = mesh_box_in_blocks(mask, boxes_[n], sinks, mask_options(options_), blocks_, control);
    made.sweep.clear();
    made.blocks.clear();
    end(n, std::move(made));
  }

  void end_empty(std::size_t n) {
    MeshReport report;
    report_no_triangles(task_.simplify, report);
    end(n, std::move(report));
  }

  void end(std::size_t n, MeshReport report) {
    add_to(report_, report);
    warn_of_empty_label(task_.volume, labels_[n].label, report);
    output_.end(n, std::move(report));
  }

  void tell(std::size_t done, std::size_t of) const {
    check_stop(control_);
    if (!control_.progress) return;
    const std::uint64_t bytes = report_.sweep.empty() ? 0 : report_.sweep.back().bytes;
    control_.progress({static_cast<std::int64_t>(done), static_cast<std::int64_t>(of), 0, 0, report_.triangles, bytes});
  }

  void start_report() {
    report_.threads = Executor(control_.threads).threads();
    report_.slab = control_.slab;
    const SampleRange none;
    report_.min = none.min;
    report_.max = none.max;
    const auto is_rounded = [](const LabelExtent& label) { return may_be_rounded(label.label); };
    warn_of_floats(map_->info(), std::ranges::any_of(labels_, is_rounded), report_);
    warn_of_space(task_, report_);
    warn_of_rounding(task_, report_);
  }

  const VolumeOpener& open_;
  const std::span<const LabelExtent> labels_;
  LabelOutput& output_;
  const MeshOptions& options_;
  const BlockOptions& blocks_;
  const RunControl& control_;
  const std::unique_ptr<SliceSource> map_;
  Task task_;
  std::vector<Region> boxes_;  // that are swept; empty: the label does not occur
  MeshReport report_;
  std::size_t steps_done_ = 0;
};

// Labels with a sink each.
class SinksOfLabels final : public LabelOutput {
 public:
  explicit SinksOfLabels(std::span<const LabelSink> labels) : labels_(labels), reports_(labels.size()) {
    for (const LabelSink& label : labels) sinks_.push_back(label.sink);
    require_different(sinks_);
  }

  std::array<double, 3> offset() const override { return common_offset(sinks_); }
  MeshSink& begin(std::size_t n) override { return *labels_[n].sink; }
  void end(std::size_t n, MeshReport report) override { reports_[n] = std::move(report); }

  std::vector<MeshReport> finish() {
    for (const LabelSink& label : labels_) label.sink->finish();
    return std::move(reports_);
  }

 private:
  std::span<const LabelSink> labels_;
  std::vector<MeshSink*> sinks_;
  std::vector<MeshReport> reports_;
};

}  // namespace

LabelsReport mesh_labels_in_blocks(const VolumeOpener& open, std::span<const LabelSink> labels,
                                   const MeshOptions& options, const BlockOptions& blocks, const RunControl& control) {
  SinksOfLabels sinks(labels);
  std::vector<LabelExtent> extents;
  const Region whole{{0, 0, 0}, open()->info().dims};
  for (const LabelSink& label : labels) extents.push_back({label.label, 0, label.box.value_or(whole)});
  LabelsReport report;
  report.total = mesh_labels_in_blocks(open, extents, sinks, options, blocks, control);
  report.labels = sinks.finish();
  return report;
}

MeshReport mesh_labels_in_blocks(const VolumeOpener& open, std::span<const LabelExtent> labels, LabelOutput& output,
                                 const MeshOptions& options, const BlockOptions& blocks, const RunControl& control) {
  const StandardFloats floats;
  return LabelsInBlocks(open, labels, output, options, blocks, control).run();
}

}  // namespace isoweave
