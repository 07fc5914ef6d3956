#include "verbs/mesh_label_objects.hpp"

#include <fmt/format.h>

#include <memory>
#include <span>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

#include "isoweave/blocks.hpp"
#include "isoweave/error.hpp"
#include "options/files.hpp"
#include "options/input_volume.hpp"
#include "options/run.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "report/progress.hpp"
#include "verbs/mesh_label_layers.hpp"

namespace isoweave::cli {
namespace {

constexpr std::int64_t kUsualBoxes = 256;         // samples along each side
constexpr std::size_t kMostPrinted = 20;          // warnings of labels
constexpr std::size_t kMostListed = kMostLabels;  // labels with an entry of their own in the report

// Keeps the objects of labels, and what is told of them.
class LabelObjects final : public LabelOutput {
 public:
  LabelObjects(MeshObjects& objects, std::span<const MeshedLabel> labels, const std::array<double, 3>& offset)
      : objects_(objects), labels_(labels), offset_(offset) {
    if (labels.size() <= kMostListed) listed_.resize(labels.size());
  }

  std::array<double, 3> offset() const override { return offset_; }

  MeshSink& begin(std::size_t n) override {
    const MeshedLabel& label = labels_[n];
    return *(open_[n] = objects_.begin({label.name.label.bits(), label.name.name, label.extent.samples}));
  }

  void end(std::size_t n, MeshReport report) override {
    if (const auto sink = open_.find(n); sink != open_.end()) {
      sink->second->finish();
      open_.erase(sink);
    }
    keep(n, std::move(report));
  }

  // Sinks for all labels at once. mesh_labels finishes them.
  std::vector<LabelSink> sinks() {
    std::vector<LabelSink> sinks;
    for (std::size_t n = 0; n < labels_.size(); ++n) {
      sinks.push_back({labels_[n].name.label, &begin(n), labels_[n].extent.box});
    }
    return sinks;
  }

  void keep(std::size_t n, MeshReport report) {
    for (std::string& warning : report.warnings) {
      if (++warnings_ <= kMostPrinted) printed_.push_back(std::move(warning));
    }
    if (!listed_.empty()) listed_[n] = std::move(report);
  }

  void close() { open_.clear(); }

  std::vector<std::string> warnings() const {
    std::vector<std::string> lines = printed_;
    if (warnings_ > kMostPrinted)
      lines.push_back(fmt::format("{} labels more have a warning", warnings_ - kMostPrinted));
    return lines;
  }

  // An entry for each label, where they are few enough to be read.
  Json entries() const {
    Json list = Json::array();
    for (std::size_t n = 0; n < listed_.size(); ++n) {
      Json& entry = list.emplace_back(Json{{"label", label_json(labels_[n].name.label)},
                                           {"name", labels_[n].name.name},
                                           {"samples", labels_[n].extent.samples}});
      entry.update(Json::parse(counts_json(listed_[n])));
      entry.update(Json::parse(surface_json(listed_[n])));
    }
    return list;
  }

 private:
  MeshObjects& objects_;
  std::span<const MeshedLabel> labels_;
  std::array<double, 3> offset_;
  std::unordered_map<std::size_t, std::unique_ptr<MeshSink>> open_;
  std::vector<MeshReport> listed_;
  std::vector<std::string> printed_;
  std::size_t warnings_ = 0;
};

// Labels of one map: two objects cannot have one number.
LabelLayer find_layer(const LabelsTask& task, const VolumeInfo& info, const std::atomic<bool>* stop) {
  const LabelBook book(task.names, info, task.input.channel);
  const std::vector<LabelName> chosen = book.chosen(task.choice);
  check_numbers(task, chosen);
  std::vector<LabelLayer> layers = find_layers(task, book, chosen, stop);
  if (layers.size() == 1) return std::move(layers.front());
  throw BadInput(
      fmt::format("{}: --one-file expects labels that do not overlap, found {} layers (--channel N takes one)",
                  task.input.path, layers.size()));
}

// The size of the boxes: more labels than a sweep takes are taken in boxes, unless there is none but a sweep.
std::optional<std::int64_t> boxes_for(const LabelsTask& task, const LabelLayer& layer) {
  if (task.blocks || layer.labels.size() <= kMostLabels) return task.blocks;
  if (open_input(layer.input)->skips()) return kUsualBoxes;
  throw BadInput(
      fmt::format("{}: expected at most {} labels in a volume that has to be read from its beginning, found {} "
                  "(--min-label N leaves small ones out)",
                  task.input.path, kMostLabels, layer.labels.size()));
}

MeshReport mesh_layer(const LabelsTask& task, const LabelLayer& layer, LabelObjects& objects,
                      const RunControl& control) {
  if (const std::optional<std::int64_t> size = boxes_for(task, layer)) {
    std::vector<LabelExtent> labels;
    for (const MeshedLabel& label : layer.labels) labels.push_back(label.extent);
    const VolumeOpener open = [&] { return open_input(layer.input); };
    return mesh_labels_in_blocks(open, labels, objects, task.options, {*size}, control);
  }
  LabelsReport report = mesh_labels(*open_input(layer.input), objects.sinks(), task.options, control);
  for (std::size_t n = 0; n < report.labels.size(); ++n) objects.keep(n, std::move(report.labels[n]));
  return std::move(report.total);
}

Json report_json(const LabelsTask& task, const VolumeInfo& info, const MeshReport& report, const LabelLayer& layer,
                 const LabelObjects& labels, const MeshObjects& objects) {
  Json input = volume_json(info, task.input.path);
  add_range(input, report.min, report.max, report.nan);
  Json json = run_json(report, std::move(input));
  task.describe(json);
  json["output"] = task.output.path;
  json["label_count"] = layer.labels.size();
  json["labels"] = labels.entries();
  json["notes"] = objects.notes();
  return json;
}

void print_objects(const LabelsTask& task, const VolumeInfo& info, const MeshReport& report, const LabelObjects& labels,
                   const MeshObjects& objects, std::size_t count) {
  for (const std::string& warning : report.warnings) print_note("warning: " + warning);
  for (const std::string& warning : labels.warnings()) print_note("warning: " + warning);
  for (const std::string& note : objects.notes()) print_note(note);
  print_summary(report, fmt::format("{}: {} {}", task.output.name(), count, count == 1 ? "label" : "labels"),
                static_cast<double>(info.slice_samples()) * static_cast<double>(info.dims[2]));
}

}  // namespace

void mesh_label_objects(const LabelsTask& task, const VolumeInfo& info, RunControl control, Evidence& evidence) {
  const RunOptions& run = task.run;
  if (task.numbered) {
    throw std::invalid_argument(
        "--segment: expected one label in a folder, as objects of one folder have the numbers of their labels");
  }
  check_different({task.input.path, task.output.path, run.report, task.names});
  check_absent(run.no_clobber, {task.output.path});
  const MeshFileOptions file = task.file({});
  // Before the labels are looked for: an error that would stop the run after a pass is found now.
  const std::unique_ptr<MeshObjects> objects = open_mesh_objects(task.output.path, file);
  const LabelLayer layer = find_layer(task, info, control.stop.get());
  if (!run.quiet) print_volume_notes(open_input(layer.input)->info());
  ProgressPrinter printer(progress_mode(run.progress, run.quiet));
  control.progress = [&](const Progress& progress) { printer.show(progress); };
  LabelObjects labels(*objects, layer.labels, file.offset);
  const MeshReport report = mesh_layer(task, layer, labels, control);
  labels.close();
  objects->finish();
  printer.finish();
  evidence.write(report_json(task, info, report, layer, labels, *objects), control, {});
  if (!run.quiet) print_objects(task, info, report, labels, *objects, layer.labels.size());
}

}  // namespace isoweave::cli
