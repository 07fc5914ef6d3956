#include "labels.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <span>

#include "isoweave/error.hpp"
#include "output.hpp"
#include "progress.hpp"

namespace isoweave::cli {
namespace {

// Hundreds of labels are hundreds of open files.
void allow_many_files() {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

std::int64_t parse_label(std::string_view text, std::string_view all) {
  std::int64_t label = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), label);
  if (error != std::errc{} || end != text.data() + text.size()) {
    wrong_value("--labels", "all, or whole numbers such as 1,2,5", all);
  }
  return label;
}

// Whether labels are the numbers of objects.
bool numbers_objects(const LabelsTask& task) {
  return !task.numbered && std::filesystem::path(task.output.path).extension() == ".precomputed";
}

// The files of all labels, open.
struct LabelFiles {
  std::vector<OutputOptions> outputs;
  std::vector<std::unique_ptr<MeshSink>> files;
  std::vector<LabelSink> sinks;

  LabelFiles(const LabelsTask& task, std::span<const LabelExtent> extents) {
    for (const LabelExtent& extent : extents) {
      OutputOptions output = label_output(task.output, extent.label);
      check_different({task.input.path, output.path, task.run.report});
      MeshFileOptions options = task.file(extent.label);
      if (numbers_objects(task)) options.segment = static_cast<std::uint64_t>(extent.label);
      files.push_back(open_output(output, options));
      sinks.push_back({extent.label, files.back().get(), extent.box});
      outputs.push_back(std::move(output));
    }
  }
};

void check_numbers(const LabelsTask& task, std::span<const LabelExtent> extents) {
  if (!numbers_objects(task)) return;
  for (const LabelExtent& extent : extents) {
    if (extent.label < 0) {
      wrong_value("--labels", "labels of 0 or more as numbers of objects in .precomputed",
                  fmt::format("{}", extent.label));
    }
  }
}

Json label_json(const LabelExtent& extent, const MeshReport& report, const std::string& output) {
  Json json = {{"label", extent.label},
               {"samples", extent.samples},
               {"output", output},
               {"cells_crossed", report.cells_crossed},
               {"triangles_extracted", report.triangles_extracted},
               {"vertices_extracted", report.vertices_extracted},
               {"collapses", report.collapses},
               {"postponed", report.postponed},
               {"rekeyed", report.rekeyed},
               {"specks", report.specks},
               {"warnings", report.warnings}};
  json.update(surface_json(report));
  return json;
}

Json report_json(const LabelsTask& task, const VolumeInfo& info, const LabelsReport& report,
                 std::span<const LabelExtent> extents, const LabelFiles& files) {
  Json input = volume_json(info, task.input.path);
  add_range(input, report.total.min, report.total.max, report.total.nan);
  Json json = run_json(report.total, std::move(input));
  task.describe(json);
  Json labels = Json::array();
  for (std::size_t n = 0; n < extents.size(); ++n) {
    labels.push_back(label_json(extents[n], report.labels[n], files.outputs[n].name()));
    labels.back()["notes"] = files.files[n]->notes();
  }
  json["labels"] = std::move(labels);
  return json;
}

void print_labels(const LabelsTask& task, const VolumeInfo& info, const LabelsReport& report, const LabelFiles& files) {
  for (const std::string& warning : report.total.warnings) print_note("warning: " + warning);
  for (std::size_t n = 0; n < report.labels.size(); ++n) {
    for (const std::string& warning : report.labels[n].warnings) print_note("warning: " + warning);
    print_notes(*files.files[n]);
    print_surface(report.labels[n], files.outputs[n].name());
  }
  const auto voxels = static_cast<double>(info.slice_samples()) * static_cast<double>(info.dims[2]);
  print_summary(report.total, fmt::format("{}: {} labels", task.output.name(), report.labels.size()), voxels);
}

}  // namespace

std::vector<std::int64_t> parse_labels(std::string_view text) {
  std::vector<std::int64_t> labels;
  if (text == "all") return labels;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    labels.push_back(parse_label(text.substr(begin, end - begin), text));
    begin = end + 1;
  }
  std::vector<std::int64_t> sorted = labels;
  std::ranges::sort(sorted);
  if (std::ranges::adjacent_find(sorted) != sorted.end()) wrong_value("--labels", "each label once", text);
  if (labels.size() > kMostLabels) {
    wrong_value("--labels", fmt::format("at most {} labels", kMostLabels), std::to_string(labels.size()));
  }
  return labels;
}

int parse_smooth(std::string_view text) {
  if (text.empty()) return 0;
  const std::int64_t passes = parse_count("--smooth", text);
  if (passes > kMostSmoothing) wrong_value("--smooth", fmt::format("at most {} passes", kMostSmoothing), text);
  return static_cast<int>(passes);
}

OutputOptions label_output(const OutputOptions& output, std::int64_t label) {
  const std::filesystem::path path(output.path);
  OutputOptions of_label = output;
  of_label.path =
      (path.parent_path() / fmt::format("{}_label{}{}", path.stem().string(), label, path.extension().string()))
          .string();
  return of_label;
}

void mesh_label_files(const LabelsTask& task, SliceSource& volume, RunControl control, Evidence& evidence) {
  const RunOptions& run = task.run;
  const VolumeInfo info = volume.info();
  allow_many_files();
  const std::int64_t any = task.labels.empty() ? 1 : task.labels.front();
  // Finds out now what would stop the run after the first pass.
  std::unique_ptr<MeshSink> any_file = open_output(label_output(task.output, any), task.file(any));
  const std::vector<LabelExtent> extents = find_labels(*open_input(task.input), task.labels, control.stop);
  any_file.reset();
  if (extents.empty()) throw BadInput(task.input.path + ": --labels all expects a label other than 0, found none");
  check_numbers(task, extents);
  const LabelFiles files(task, extents);
  if (!run.quiet) {
    for (const std::string& note : info.notes) print_note("warning: " + note);
  }
  ProgressPrinter printer(progress_mode(run.progress, run.quiet));
  control.progress = [&](const Progress& progress) { printer.show(progress); };
  const LabelsReport report = mesh_labels(volume, files.sinks, task.options, control);
  printer.finish();
  evidence.write(report_json(task, info, report, extents, files), control, {});
  if (!run.quiet) print_labels(task, info, report, files);
}

}  // namespace isoweave::cli
