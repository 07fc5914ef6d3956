// isoweave mesh: volume in, simplified surface out.
#include <algorithm>
#include <memory>
#include <optional>

#include "isoweave/error.hpp"
#include "options.hpp"
#include "output.hpp"
#include "report.hpp"
#include "signals.hpp"
#include "verbs.hpp"
#include "volume/histogram.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kExamples = R"(
Examples:
  isoweave mesh ct.nii.gz -o bone.ply --iso 300
  isoweave mesh foot_256x256x256_uint8.raw -o foot.stl --iso auto --error 0.5vox
  isoweave mesh scan.raw --raw 512x512x300:int16:big --spacing 0.7,0.7,1.5 -o scan.obj --iso 226 --error 0.1mm
  isoweave mesh generate:gyroid:2048x2048x2048:uint8 -o gyroid.ply --iso 127.5 --report gyroid.json

The result does not depend on --threads, --schedule and --slab.)";

struct MeshArguments {
  InputOptions input;
  RunOptions run;
  std::string output, iso, error = "0.2vox", quality = "normal", slab = "auto", inside = "above", normals = "none";
  std::string space;
  bool open = false, closed = false;
};

// A whole volume is one layer thicker than its slices when it is closed.
std::int64_t parse_slab(std::string_view text, std::int64_t slices) {
  const std::int64_t whole = slices + 2;
  if (text == "auto") return 0;
  if (text == "whole") return whole;
  return std::min(parse_count("--slab", text), whole);
}

bool parse_normals(std::string_view text) {
  if (text == "quadric") not_available("--normals quadric");
  return parse_choice<bool>("--normals", text, {{"none", false}, {"gradient", true}});
}

OutputSpace parse_space(std::string_view text) {
  if (text.empty()) return OutputSpace::kAsVolume;
  return parse_choice<OutputSpace>(
      "--space", text, {{"lps", OutputSpace::kLps}, {"ras", OutputSpace::kRas}, {"index", OutputSpace::kIndex}});
}

// All that needs no volume.
MeshOptions mesh_options(const MeshArguments& arguments) {
  MeshOptions options;
  if (arguments.iso != "auto") options.iso = parse_number("--iso", arguments.iso);
  options.inside_above = parse_choice<bool>("--inside", arguments.inside, {{"above", true}, {"below", false}});
  options.closed = !arguments.open;
  options.quality = parse_quality(arguments.quality);
  options.normals = parse_normals(arguments.normals);
  options.space = parse_space(arguments.space);
  return options;
}

// Reads the volume once more, by itself, as slices cannot be read twice.
double automatic_iso(const InputOptions& input, const std::atomic<bool>& stop) {
  const std::optional<double> iso = otsu_threshold(read_histogram(*open_input(input), &stop));
  if (!iso) throw BadInput(input.path + ": --iso auto expects at least two different values, found one or none");
  return *iso;
}

std::vector<std::string> comments(const MeshArguments& arguments, const MeshOptions& options) {
  return {"isoweave " ISOWEAVE_VERSION,
          fmt::format("iso {} inside {} {} error {} quality {}", options.iso, arguments.inside,
                      options.closed ? "closed" : "open", arguments.error, arguments.quality)};
}

Json report_json(const MeshReport& report, const VolumeInfo& info, const MeshArguments& arguments,
                 const MeshOptions& options) {
  Json input = volume_json(info, arguments.input.path);
  add_range(input, report.min, report.max, report.nan);
  Json json = run_json(report, std::move(input));
  json["iso"] = options.iso;
  json["inside"] = arguments.inside;
  json["closed"] = options.closed;
  json["quality"] = arguments.quality;
  json["output"] = arguments.output;
  return json;
}

void run_mesh(const MeshArguments& arguments) {
  const RunOptions& run = arguments.run;
  MeshOptions options = mesh_options(arguments);
  RunControl control = run_control(run);
  const ProgressMode mode = progress_mode(run.progress, run.quiet);
  parse_slab(arguments.slab, 1);
  check_different({arguments.input.path, arguments.output, run.report});

  const std::unique_ptr<SliceSource> volume = open_input(arguments.input);
  const VolumeInfo info = volume->info();
  options.error = parse_error_length("--error", arguments.error, info.geometry.unit);
  options.slab = parse_slab(arguments.slab, info.dims[2]);

  control.stop = &stop_on_signal();
  std::optional<AtomicFile> report_file;
  if (!run.report.empty()) report_file.emplace(run.report);
  if (arguments.iso == "auto") {
    open_mesh_file(arguments.output);  // finds out now what would stop the run after the first pass
    options.iso = automatic_iso(arguments.input, *control.stop);
    if (!run.quiet) print_note(fmt::format("--iso {} (Otsu's threshold)", options.iso));
  }
  const std::unique_ptr<MeshSink> sink =
      open_mesh_file(arguments.output, {options.normals, comments(arguments, options)});
  if (!run.quiet) {
    for (const std::string& note : info.notes) print_note("warning: " + note);
  }
  ProgressPrinter printer(mode);
  control.progress = [&](const Progress& progress) { printer.show(progress); };
  const MeshReport report = mesh_volume(*volume, *sink, options, control);
  printer.finish();
  if (report_file) write_report(*report_file, report_json(report, info, arguments, options));
  if (run.quiet) return;
  for (const std::string& warning : report.warnings) print_note("warning: " + warning);
  const auto slices = static_cast<double>(info.dims[2]);
  print_summary(report, arguments.output, static_cast<double>(info.slice_samples()) * slices);
}

}  // namespace

void add_mesh_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("mesh", "Volume to simplified surface");
  const auto arguments = std::make_shared<MeshArguments>();
  add_input_options(*verb, arguments->input);
  verb->add_option("-o,--output", arguments->output, "Mesh to write: .ply, .stl or .obj")->required();
  verb->add_option("--iso", arguments->iso, "Value of the surface, or auto (Otsu's threshold)")->required();
  verb->add_option("--error", arguments->error,
                   "Simplification error: a length in vox, mm, um, nm or the volume's unit; 0: none")
      ->capture_default_str();
  verb->add_option("--quality", arguments->quality, "fast, normal or fine")->capture_default_str();
  verb->add_option("--slab", arguments->slab, "Layers per slab: a number, auto or whole; never changes the result")
      ->capture_default_str();
  CLI::Option* open = verb->add_flag("--open", arguments->open, "Let the surface end at the volume's border");
  verb->add_flag("--closed", arguments->closed, "Close the surface at the volume's border (default)")->excludes(open);
  verb->add_option("--inside", arguments->inside, "Side of --iso that is inside: above or below")
      ->capture_default_str();
  verb->add_option("--normals", arguments->normals, "none or gradient")->capture_default_str();
  verb->add_option("--space", arguments->space, "Coordinates of the output: lps, ras or index (default: the volume's)");
  add_run_options(*verb, arguments->run);
  verb->footer(kExamples);
  verb->callback([arguments] { run_mesh(*arguments); });
}

}  // namespace isoweave::cli
