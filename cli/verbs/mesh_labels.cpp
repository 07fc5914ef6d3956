#include "verbs/mesh_labels.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "isoweave/blocks.hpp"
#include "isoweave/error.hpp"
#include "isoweave/label_names.hpp"
#include "options/files.hpp"
#include "options/input_volume.hpp"
#include "options/parts.hpp"
#include "options/run.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "report/progress.hpp"
#include "verbs/mesh_label_layers.hpp"
#include "verbs/mesh_label_objects.hpp"

namespace isoweave::cli {
namespace {

// Raises the limit of open files, as hundreds of labels are hundreds of files.
void allow_many_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

// The outputs of labels, in their order: a file each, by the name, or the parts of one.
std::vector<SurfaceOutput> label_surfaces(const LabelsTask& task, std::span<const LabelName> labels) {
  const std::vector<std::string> file_names = label_file_names(labels);
  std::vector<SurfaceOutput> surfaces;
  for (std::size_t n = 0; n < labels.size(); ++n) {
    const auto [red, green, blue] = labels[n].color.value_or(part_color(n));
    MeshPart part{
        labels[n].name.empty() ? labels[n].label.text() : labels[n].name, {red, green, blue, 1}, task.file(labels[n])};
    if (numbers_objects(task)) part.options.segment = labels[n].label.bits();
    surfaces.push_back({surface_output(task.output, file_names[n]), std::move(part)});
  }
  return surfaces;
}

// A sink that passes on everything but the end, which comes when all layers are done.
class UnfinishedSink final : public MeshSink {
 public:
  explicit UnfinishedSink(MeshSink& sink) : sink_(sink) {}

  void append(const MeshPiece& piece) override { sink_.append(piece); }
  void finish() override {}
  std::array<double, 3> offset() const override { return sink_.offset(); }

 private:
  MeshSink& sink_;
};

// The files of all labels, open.
struct LabelFiles {
  std::vector<SurfaceOutput> surfaces;
  std::vector<std::unique_ptr<MeshSink>> files;
  std::vector<UnfinishedSink> sinks;

  LabelFiles(const LabelsTask& task, std::span<const LabelLayer> layers) {
    std::vector<LabelName> names;
    for (const LabelLayer& layer : layers) {
      for (const MeshedLabel& label : layer.labels) names.push_back(label.name);
    }
    surfaces = label_surfaces(task, names);
    for (const SurfaceOutput& surface : surfaces) {
      check_different({task.input.path, surface.output.path, task.run.report, task.names});
      check_absent(task.run.no_clobber, {surface.output.path});
    }
    files = open_surfaces(surfaces);
    for (const auto& file : files) sinks.emplace_back(*file);
  }

  // Finishes the files, and gives the report the digests of the meshes as they are in them.
  void finish(LabelsReport& report) {
    for (const auto& file : files) file->finish();
    tell_digests(files, report.labels, report.total);
  }
};

LabelsReport mesh_layer(const LabelsTask& task, const LabelLayer& layer, std::span<const LabelSink> sinks,
                        const RunControl& control) {
  if (!task.blocks) return mesh_labels(*open_input(layer.input), sinks, task.options, control);
  const VolumeOpener open = [&] { return open_input(layer.input); };
  return mesh_labels_in_blocks(open, sinks, task.options, {*task.blocks}, control);
}

LabelsReport mesh_layers(const LabelsTask& task, std::span<const LabelLayer> layers, LabelFiles& files,
                         const RunControl& control) {
  LabelsReport report;
  std::size_t first = 0;
  for (const LabelLayer& layer : layers) {
    std::vector<LabelSink> sinks;
    for (const MeshedLabel& label : layer.labels) {
      sinks.push_back({label.name.label, &files.sinks[first + sinks.size()], label.extent.box});
    }
    LabelsReport of_layer = mesh_layer(task, layer, sinks, control);
    if (first == 0) {
      report = std::move(of_layer);
    } else {
      add_layer(report, std::move(of_layer));
    }
    first += sinks.size();
  }
  return report;
}

Json entry_json(const MeshedLabel& label, const MeshReport& report, const SurfaceOutput& surface) {
  const bool colored = label.name.color || surface.output.one_file;
  Json json = {{"label", label_json(label.name.label)},
               {"name", label.name.name},
               {"color", colored ? Json(color_text(surface.part.color)) : Json(nullptr)},
               {"layer", label.name.layer},
               {"samples", label.extent.samples},
               {"output", surface.output.name()}};
  json.update(Json::parse(counts_json(report)));
  json.update(Json::parse(surface_json(report)));
  return json;
}

Json report_json(const LabelsTask& task, const VolumeInfo& info, const LabelsReport& report,
                 std::span<const LabelLayer> layers, const LabelFiles& files) {
  Json input = volume_json(info, task.input.path);
  add_range(input, report.total.min, report.total.max, report.total.nan);
  Json json = run_json(report.total, std::move(input));
  task.describe(json);
  Json labels = Json::array();
  for (const LabelLayer& layer : layers) {
    for (const MeshedLabel& label : layer.labels) {
      const std::size_t n = labels.size();
      labels.push_back(entry_json(label, report.labels[n], files.surfaces[n]));
      labels.back()["notes"] = files.files[n]->notes();
    }
  }
  json["labels"] = std::move(labels);
  return json;
}

void print_labels(const LabelsTask& task, const VolumeInfo& info, const LabelsReport& report, const LabelFiles& files,
                  std::size_t layers) {
  for (const std::string& warning : report.total.warnings) print_note("warning: " + warning);
  for (std::size_t n = 0; n < report.labels.size(); ++n) {
    for (const std::string& warning : report.labels[n].warnings) print_note("warning: " + warning);
    print_notes(*files.files[n]);
    print_surface(report.labels[n], files.surfaces[n].name());
  }
  const auto voxels = static_cast<double>(info.slice_samples()) * static_cast<double>(info.dims[2]);
  print_summary(report.total,
                fmt::format("{}: {} {}", task.output.name(), report.labels.size(),
                            report.labels.size() == 1 ? "label" : "labels"),
                voxels * static_cast<double>(layers));
}

}  // namespace

void mesh_label_files(const LabelsTask& task, const VolumeInfo& info, RunControl control, Evidence& evidence) {
  if (is_container(task)) return mesh_label_objects(task, info, std::move(control), evidence);
  const RunOptions& run = task.run;
  allow_many_files();
  const LabelBook book(task.names, info, task.input.channel);
  const std::vector<LabelName> chosen = book.chosen(task.choice);
  check_numbers(task, chosen);
  const LabelName any = chosen.empty() ? LabelName{1, {}, {}, 0} : chosen.front();
  // Opens the file and discards it: an error that would stop the run after the first pass is found now.
  std::vector<std::unique_ptr<MeshSink>> any_file = open_surfaces(label_surfaces(task, std::span(&any, 1)));
  const std::vector<LabelLayer> layers = find_layers(task, book, chosen, control.stop.get());
  any_file.clear();
  LabelFiles files(task, layers);
  if (!run.quiet) {
    const std::unique_ptr<SliceSource> first = open_input(layers.front().input);
    print_volume_notes(first->info());
  }
  ProgressPrinter printer(progress_mode(run.progress, run.quiet));
  control.progress = [&](const Progress& progress) { printer.show(progress); };
  LabelsReport report = mesh_layers(task, layers, files, control);
  files.finish(report);
  printer.finish();
  evidence.write(report_json(task, info, report, layers, files), control, {});
  if (!run.quiet) print_labels(task, info, report, files, layers.size());
}

}  // namespace isoweave::cli
