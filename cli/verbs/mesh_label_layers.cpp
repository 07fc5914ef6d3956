#include "verbs/mesh_label_layers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "isoweave/error.hpp"
#include "isoweave/label_names.hpp"
#include "options/values.hpp"

namespace isoweave::cli {
namespace {

// Refuses a map whose labels look like the values of a grey image.
void check_is_label_map(const LabelsTask& task, std::span<const LabelExtent> labels) {
  if (task.choice.insists || look_like_labels(labels)) return;
  throw BadInput(
      fmt::format("{}: --labels all expects a label map, found {} values of which {} are scattered like those "
                  "of a grey image (--iso meshes one; --labels all! takes them for labels)",
                  task.input.path, labels.size(), count_scattered(labels)));
}

std::vector<LabelExtent> find_in(const LabelsTask& task, const InputOptions& input, std::span<const Label> wanted,
                                 const std::atomic<bool>* stop) {
  if (!task.blocks) return find_labels(*open_input(input), wanted, stop, kMostObjects);
  return find_labels_in_blocks([&] { return open_input(input); }, *task.blocks, wanted, stop, kMostObjects);
}

// Refuses more labels than there are to be files.
void check_count(const LabelsTask& task, std::size_t labels) {
  if (is_container(task) || labels <= kMostLabels) return;
  throw BadInput(
      fmt::format("{}: --labels all expects at most {} labels for a file each, found {} (--one-file --compress -o "
                  "NAME.precomputed takes any number, --min-label N leaves small ones out)",
                  task.input.path, kMostLabels, labels));
}

// Leaves out labels of few samples, whose meshes nobody wants.
void leave_out_small(const LabelsTask& task, std::vector<LabelExtent>& labels) {
  const std::size_t found = labels.size();
  std::erase_if(labels, [&](const LabelExtent& label) { return label.samples < task.min_samples; });
  if (!labels.empty() || found == 0) return;
  throw EmptySurface(fmt::format("{}: expected a label of {} samples or more (--min-label), found {} smaller ones",
                                 task.input.path, task.min_samples, found));
}

// All labels that occur, and the segments that do not.
std::vector<MeshedLabel> all_labels(const LabelsTask& task, const LabelBook& book, const InputOptions& input,
                                    std::int64_t layer, const std::atomic<bool>* stop) {
  std::vector<LabelExtent> extents = find_in(task, input, {}, stop);
  if (book.segments(layer).empty()) check_is_label_map(task, extents);
  leave_out_small(task, extents);
  check_count(task, extents.size());
  std::vector<MeshedLabel> labels;
  labels.reserve(extents.size());
  for (const LabelExtent& extent : extents) labels.push_back({book.entry(extent.label, layer), extent});
  for (LabelName& segment : book.segments(layer)) {
    const bool occurs = std::ranges::find(extents, segment.label, &LabelExtent::label) != extents.end();
    if (!occurs && task.min_samples == 0) labels.push_back({segment, LabelExtent{segment.label, 0, {}}});
  }
  return labels;
}

// The labels that are named. One that does not occur is refused, unless --allow-empty lets its mesh be empty.
std::vector<MeshedLabel> chosen_labels(const LabelsTask& task, std::span<const LabelName> chosen,
                                       const InputOptions& input, std::int64_t layer, const std::atomic<bool>* stop) {
  std::vector<LabelName> here;
  std::vector<Label> wanted;
  for (const LabelName& name : chosen) {
    if (name.layer != layer) continue;
    here.push_back(name);
    wanted.push_back(name.label);
  }
  if (here.empty()) return {};
  const std::vector<LabelExtent> extents = find_in(task, input, wanted, stop);
  std::vector<MeshedLabel> labels;
  for (std::size_t n = 0; n < here.size(); ++n) {
    if (extents[n].samples == 0 && !task.run.allow_empty) {
      throw EmptySurface(fmt::format("{}: label {} does not occur", task.input.path, here[n].label.text()));
    }
    labels.push_back({std::move(here[n]), extents[n]});
  }
  return labels;
}

}  // namespace

bool is_container(const LabelsTask& task) {
  return task.output.one_file && output_format(task.output) == MeshFormat::kPrecomputed;
}

bool numbers_objects(const LabelsTask& task) {
  return !task.numbered && output_format(task.output) == MeshFormat::kPrecomputed;
}

void check_numbers(const LabelsTask& task, std::span<const LabelName> labels) {
  if (!numbers_objects(task)) return;
  for (const LabelName& label : labels) {
    if (!label.label.is_negative()) continue;
    wrong_value("--labels", "labels of 0 or more as numbers of objects in .precomputed", label.label.text());
  }
}

std::vector<LabelLayer> find_layers(const LabelsTask& task, const LabelBook& book, std::span<const LabelName> chosen,
                                    const std::atomic<bool>* stop) {
  std::vector<LabelLayer> layers;
  for (const std::int64_t number : book.layers()) {
    LabelLayer layer{task.input, {}};
    if (number > 0 || book.layers().size() > 1) layer.input.channel = std::to_string(number);
    layer.labels = task.choice.all ? all_labels(task, book, layer.input, number, stop)
                                   : chosen_labels(task, chosen, layer.input, number, stop);
    if (!layer.labels.empty()) layers.push_back(std::move(layer));
  }
  if (layers.empty()) throw BadInput(task.input.path + ": --labels all expects a label other than 0, found none");
  for (const LabelLayer& layer : layers) {
    for (const MeshedLabel& label : layer.labels) check_numbers(task, std::span(&label.name, 1));
  }
  return layers;
}

}  // namespace isoweave::cli
