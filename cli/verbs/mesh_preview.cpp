#include "verbs/mesh_preview.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "options/preview.hpp"
#include "report/print.hpp"
#include "report/progress.hpp"
#include "report/report.hpp"
#include "verbs/mesh_options.hpp"
#include "verbs/mesh_report.hpp"

namespace isoweave::cli {
namespace {

MeshFileOptions preview_file(const MeshArguments& arguments, const MeshOptions& options, const VolumeInfo& info) {
  MeshFileOptions file = file_options(arguments, arguments.stop, options, info);
  file.comments = {
      "isoweave " ISOWEAVE_VERSION,
      fmt::format("iso {} inside {} {} {}{}", options.iso, arguments.inside, options.closed ? "closed" : "open",
                  preview_text(arguments.preview), extractor_text(arguments) + smooth_text(options))};
  return file;
}

Json report_json(const MeshReport& report, const MeshArguments& arguments, const MeshOptions& options,
                 const VolumeInfo& info, const MeshSink& sink) {
  Json input = volume_json(info, arguments.input.path);
  add_range(input, report.min, report.max, report.nan);
  Json json = run_json(report, std::move(input));
  json["iso"] = options.iso;
  report_surface_options(json, arguments, options);
  json["output"] = arguments.output.name();
  json["space"] = space_of_mesh(info.geometry, options.space);
  json["offset"] = sink.offset();
  json["notes"] = sink.notes();
  return json;
}

}  // namespace

void mesh_preview(const MeshArguments& arguments, const MeshOptions& options, SliceSource& volume, RunControl control,
                  Evidence& evidence) {
  const VolumeInfo info = volume.info();
  PreviewOptions asked;
  static_cast<SurfaceOptions&>(asked) = static_cast<const SurfaceOptions&>(options);
  asked.cell = preview_cell(arguments.preview, length_basis(info));
  asked.space = options.space;
  const std::unique_ptr<MeshSink> sink = open_output(arguments.output, preview_file(arguments, options, info));
  const bool quiet = arguments.run.quiet;
  if (!quiet) print_volume_notes(info);
  ProgressPrinter printer(progress_mode(arguments.run.progress, quiet));
  control.progress = [&](const Progress& progress) { printer.show(progress); };
  MeshReport report = preview_volume(volume, *sink, asked, control);
  report.digest = file_digest(*sink, report.digest);
  printer.finish();
  evidence.write(report_json(report, arguments, options, info, *sink), control, {});
  if (quiet) return;
  for (const std::string& warning : report.warnings) print_note("warning: " + warning);
  print_notes(*sink);
  print_caps(report, arguments);
  print_preview(report, info.geometry.unit);
  print_summary(report, arguments.output.name(),
                static_cast<double>(info.slice_samples()) * static_cast<double>(info.dims[2]));
}

}  // namespace isoweave::cli
