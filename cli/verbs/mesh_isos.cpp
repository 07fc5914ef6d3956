#include "verbs/mesh_isos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "isoweave/forecast.hpp"
#include "options/files.hpp"
#include "options/input_volume.hpp"
#include "options/parts.hpp"
#include "options/values.hpp"
#include "report/print.hpp"
#include "report/progress.hpp"
#include "report/report.hpp"
#include "verbs/mesh_forecast.hpp"
#include "verbs/mesh_options.hpp"
#include "verbs/mesh_report.hpp"

namespace isoweave::cli {
namespace {

std::vector<double> parse_isos(const std::string& text) {
  std::vector<double> isos;
  for (const std::string_view part : split(text, ',')) {
    isos.push_back(parse_number("--iso", part));
    if (std::ranges::count(isos, isos.back()) > 1) wrong_value("--iso", "each value once", text);
  }
  return isos;
}

OutputOptions iso_output(const OutputOptions& output, double iso) {
  return surface_output(output, fmt::format("iso{}", iso));
}

// Surfaces of other values lie within one another: the innermost is opaque, the others let it be seen, the outermost
// most of all. depth: from 0, outermost, to `count` - 1.
double opacity_at(std::size_t depth, std::size_t count) {
  constexpr double kOutermost = 0.3;
  const double inwards = static_cast<double>(depth) / static_cast<double>(count - 1);
  return kOutermost + (1 - kOutermost) * inwards * inwards;
}

// A value that is meshed.
struct MeshedIso {
  MeshOptions options;
  SurfaceOutput surface;
};

std::vector<MeshedIso> meshed_isos(const MeshArguments& arguments, const MeshOptions& options, const VolumeInfo& info) {
  const std::vector<double> isos = parse_isos(arguments.iso);
  std::vector<MeshedIso> meshes;
  for (const double iso : isos) {
    const auto outside =
        std::ranges::count_if(isos, [&](double other) { return options.inside_above ? other < iso : other > iso; });
    const auto [red, green, blue] = part_color(meshes.size());
    MeshedIso& mesh = meshes.emplace_back();
    mesh.options = options;
    mesh.options.iso = iso;
    mesh.surface.output = iso_output(arguments.output, iso);
    mesh.surface.part = {fmt::format("iso {}", iso),
                         {red, green, blue, opacity_at(static_cast<std::size_t>(outside), isos.size())},
                         file_options(arguments, arguments.stop, mesh.options, info)};
  }
  return meshes;
}

// The forecast of all values, each from an opening of the volume of its own.
Forecast forecast_all(const MeshArguments& arguments, const std::vector<MeshedIso>& meshes, const RunControl& control,
                      std::uint64_t& bytes) {
  Forecast sum;
  for (const MeshedIso& mesh : meshes) {
    const Forecast forecast = forecast_mesh(*open_input(arguments.input), mesh.options, control);
    bytes += output_bytes(mesh.surface.output, forecast.vertices, forecast.triangles, mesh.surface.part.options);
    add_iso_value(sum, forecast);
    add_memory_during(
        sum, output_memory(mesh.surface.output, forecast.vertices, forecast.triangles, mesh.surface.part.options));
  }
  return sum;
}

void tell_forecast(const MeshArguments& arguments, const std::vector<MeshedIso>& meshes, const RunControl& control,
                   Evidence& evidence) {
  std::uint64_t bytes = 0;
  const Forecast sum = forecast_all(arguments, meshes, control, bytes);
  const int threads = control.threads > 0 ? control.threads : static_cast<int>(std::thread::hardware_concurrency());
  print_to_reader(forecast_text(sum, 0, bytes, threads, false));
  evidence.write_forecast({{"version", ISOWEAVE_VERSION}, {"forecast", Json::parse(forecast_json(sum, bytes))}});
}

Json entry_json(const MeshReport& report, const MeshedIso& mesh, const MeshSink& sink) {
  Json json = {{"iso", mesh.options.iso},
               {"output", mesh.surface.output.name()},
               {"name", mesh.surface.part.name},
               {"color", color_text(mesh.surface.part.color)},
               {"opacity", mesh.surface.part.color[3]}};
  json.update(Json::parse(counts_json(report)));
  json["notes"] = sink.notes();
  json.update(Json::parse(surface_json(report)));
  return json;
}

Json report_json(const MeshArguments& arguments, const VolumeInfo& info, const IsoValuesReport& report,
                 const std::vector<MeshedIso>& meshes, const std::vector<std::unique_ptr<MeshSink>>& files) {
  Json input = volume_json(info, arguments.input.path);
  add_range(input, report.total.min, report.total.max, report.total.nan);
  Json json = run_json(report.total, std::move(input));
  const MeshOptions& options = meshes.front().options;
  report_surface_options(json, arguments, options);
  json["quality"] = arguments.quality;
  json["normals"] = arguments.normals;
  json["space"] = space_of_mesh(info.geometry, options.space);
  json["offset"] = meshes.front().surface.part.options.offset;
  json["isos"] = Json::array();
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    json["isos"].push_back(entry_json(report.meshes[n], meshes[n], *files[n]));
  }
  return json;
}

void print_meshes(const MeshArguments& arguments, const VolumeInfo& info, const IsoValuesReport& report,
                  const std::vector<MeshedIso>& meshes, const std::vector<std::unique_ptr<MeshSink>>& files) {
  for (const std::string& warning : report.total.warnings) print_note("warning: " + warning);
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    for (const std::string& warning : report.meshes[n].warnings) print_note("warning: " + warning);
    print_notes(*files[n]);
    print_surface(report.meshes[n], meshes[n].surface.name());
  }
  const double voxels = static_cast<double>(info.slice_samples()) * static_cast<double>(info.dims[2]);
  print_summary(report.total, fmt::format("{}: {} iso-values", arguments.output.name(), meshes.size()), voxels);
}

}  // namespace

bool has_several_isos(const MeshArguments& arguments) { return arguments.iso.find(',') != std::string::npos; }

void check_isos(const MeshArguments& arguments) {
  if (!has_several_isos(arguments)) return;
  const std::vector<double> isos = parse_isos(arguments.iso);
  const auto refuse = [](bool given, std::string_view option) {
    if (!given) return;
    throw std::invalid_argument(
        fmt::format("--iso with several values: expected a run without {}, which takes one surface", option));
  };
  refuse(!arguments.output.to_stdout.empty(), "--to-stdout");
  for (const double iso : isos) {
    const std::string path = iso_output(arguments.output, iso).path;
    check_different({arguments.input.path, path, arguments.run.report, arguments.page.path});
    check_absent(arguments.run.no_clobber, {path});
  }
}

void mesh_iso_files(const MeshArguments& arguments, const MeshOptions& options, SliceSource& volume, RunControl control,
                    Evidence& evidence) {
  const VolumeInfo info = volume.info();
  const std::vector<MeshedIso> meshes = meshed_isos(arguments, options, info);
  if (arguments.dry_run) return tell_forecast(arguments, meshes, control, evidence);
  std::vector<SurfaceOutput> surfaces;
  surfaces.reserve(meshes.size());
  for (const MeshedIso& mesh : meshes) surfaces.push_back(mesh.surface);
  const std::vector<std::unique_ptr<MeshSink>> files = open_surfaces(surfaces);
  std::vector<IsoSink> sinks;
  for (std::size_t n = 0; n < meshes.size(); ++n) sinks.push_back({meshes[n].options.iso, files[n].get()});
  const bool quiet = arguments.run.quiet;
  if (!quiet) print_volume_notes(info);
  ProgressPrinter printer(progress_mode(arguments.run.progress, quiet));
  control.progress = [&](const Progress& progress) { printer.show(progress); };
  IsoValuesReport report = mesh_iso_values(volume, sinks, options, control);
  tell_digests(files, report.meshes, report.total);
  printer.finish();
  evidence.write(report_json(arguments, info, report, meshes, files), control, [&](const RunControl&) {
    PageContents contents;
    for (const SurfaceOutput& surface : surfaces) contents.isos.push_back(read_mesh(surface.output.path));
    return contents;
  });
  if (!quiet) print_meshes(arguments, info, report, meshes, files);
}

}  // namespace isoweave::cli
