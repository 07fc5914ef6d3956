// isoweave mesh: volume in, simplified surface out.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "components.hpp"
#include "evidence.hpp"
#include "isoweave/error.hpp"
#include "labels.hpp"
#include "lods.hpp"
#include "memory_sink.hpp"
#include "mesh_output.hpp"
#include "options.hpp"
#include "output.hpp"
#include "report.hpp"
#include "signals.hpp"
#include "stop.hpp"
#include "verbs.hpp"
#include "volume/histogram.hpp"
#include "watch.hpp"

namespace isoweave::cli {
namespace {

constexpr const char* kUsualError = "0.2vox";

constexpr const char* kExamples = R"(
Examples:
  isoweave mesh ct.nii.gz -o bone.ply --iso 300
  isoweave mesh foot_256x256x256_uint8.raw -o foot.stl --iso auto --error 0.5vox
  isoweave mesh scan.raw --raw 512x512x300:int16:big --spacing 0.7,0.7,1.5 -o scan.obj --iso 226 --error 0.1mm
  isoweave mesh generate:gyroid:2048x2048x2048:uint8 -o gyroid.ply --iso 127.5 --checkpoint gyroid.run
  isoweave mesh --resume gyroid.run
  isoweave mesh brain.nii.gz -o brain.glb --iso 40 --triangles 200000
  isoweave mesh brain.nii.gz -o brain.ply --iso 40 --lods 0.1vox,0.3vox,1vox
  isoweave mesh ct.nii.gz -o bone.ply --iso 300 --html bone.html
  isoweave mesh ct.nii.gz -o bone.ply --iso 300 --watch
  isoweave mesh segmentation.nii.gz -o seg.ply --labels all --smooth

Without --error, --lods, --max-distance, --triangles and --ratio the error is 0.2vox. The result does not depend on
--threads, --schedule and --slab.)";

std::string absolute_path(const std::string& path) { return std::filesystem::absolute(path).string(); }

struct MeshArguments {
  InputOptions input;
  RunOptions run;
  OutputOptions output;
  StopOptions stop;
  ComponentOptions components;
  PageOptions page;
  WatchOptions watch;
  std::string iso, quality = "normal", slab, inside = "above", normals = "none";
  std::string color_by, space, memory, checkpoint, every, resume, labels, smooth;
  bool open = false, closed = false, dry_run = false, numbered = false;
};

// What a saved state keeps of the command line: the task, with paths that hold wherever it is resumed.
Json task_json(const MeshArguments& arguments, const MeshOptions& options) {
  return {{"volume", generated_input(arguments.input) ? arguments.input.path : absolute_path(arguments.input.path)},
          {"raw", arguments.input.raw},
          {"spacing", arguments.input.spacing},
          {"origin", arguments.input.origin},
          {"series", arguments.input.series},
          {"dataset", arguments.input.dataset},
          {"level", arguments.input.level},
          {"channel", arguments.input.channel},
          {"time", arguments.input.time},
          {"roi", arguments.input.roi},
          {"step", arguments.input.step},
          {"output", absolute_path(arguments.output.path)},
          {"compress", arguments.output.compress},
          {"one_file", arguments.output.one_file},
          {"segment", arguments.output.segment},
          {"report", arguments.run.report.empty() ? "" : absolute_path(arguments.run.report)},
          {"html", arguments.page.given() ? absolute_path(arguments.page.path) : ""},
          {"page_triangles", arguments.page.triangles},
          {"iso", fmt::format("{}", options.iso)},
          {"error", arguments.stop.error},
          {"triangles", options.triangles > 0 ? std::to_string(options.triangles) : ""},
          {"specks", arguments.stop.specks},
          {"min_component", arguments.components.min_component},
          {"largest", arguments.components.largest},
          {"lods", arguments.stop.lods},
          {"max_distance", arguments.stop.max_distance},
          {"quality", arguments.quality},
          {"slab", arguments.slab},
          {"inside", arguments.inside},
          {"smooth", arguments.smooth},
          {"normals", arguments.normals},
          {"color_by", arguments.color_by.empty() ? "" : absolute_path(arguments.color_by)},
          {"space", arguments.space},
          {"open", arguments.open},
          {"memory", arguments.memory},
          {"every", arguments.every}};
}

// The task of a saved state, and how it was to run where nothing else is said now.
void set_task(MeshArguments& arguments, const MeshArguments& now, const Json& task) {
  arguments.input = {task.at("volume"), task.at("raw"),     task.at("spacing"), task.at("origin"),
                     task.at("series"), task.at("dataset"), task.at("level"),   task.at("channel"),
                     task.at("time"),   task.at("roi"),     task.at("step")};
  arguments.output = {task.at("output"), "", task.at("compress"), task.at("segment"), task.at("one_file")};
  if (now.run.report.empty()) arguments.run.report = task.at("report");
  if (!now.page.given()) arguments.page = {task.at("html"), task.at("page_triangles")};
  arguments.iso = task.at("iso");
  arguments.stop = {task.at("error"),  task.at("triangles"), "",
                    task.at("specks"), task.at("lods"),      task.at("max_distance")};
  arguments.components = {task.at("min_component"), task.at("largest")};
  arguments.quality = task.at("quality");
  if (now.slab.empty()) arguments.slab = task.at("slab");
  arguments.inside = task.at("inside");
  arguments.smooth = task.at("smooth");
  arguments.normals = task.at("normals");
  arguments.color_by = task.at("color_by");
  arguments.space = task.at("space");
  arguments.open = task.at("open");
  if (now.memory.empty()) arguments.memory = task.at("memory");
  if (now.every.empty()) arguments.every = task.at("every");
}

[[noreturn]] void refuse_state(const Checkpoint& checkpoint) {
  throw BadInput(checkpoint.path + ": expected a state saved by this isoweave mesh, found another");
}

// The arguments of a run that goes on: the task as it was, and how to run as it is said now.
MeshArguments resumed_arguments(const MeshArguments& now, const Checkpoint& checkpoint) {
  MeshArguments arguments = now;
  try {
    set_task(arguments, now, Json::parse(checkpoint.note));
  } catch (const Json::exception&) {
    refuse_state(checkpoint);
  }
  arguments.checkpoint = now.resume;
  return arguments;
}

// "16layers", "90s", "5min" or "2h".
void parse_every(std::string_view text, CheckpointOptions& checkpoint) {
  constexpr std::array<std::pair<std::string_view, double>, 3> kUnits{{{"s", 1}, {"min", 60}, {"h", 3600}}};
  const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  const std::string_view number = text.substr(0, digits);
  const std::string_view unit = text.substr(digits);
  if (unit == "layers") checkpoint.layers = parse_count("--every", number);
  for (const auto& [name, seconds] : kUnits) {
    if (unit == name) checkpoint.seconds = seconds * parse_number("--every", number);
  }
  const bool known = unit == "layers" || std::ranges::any_of(kUnits, [&](const auto& u) { return u.first == unit; });
  if (!known || !(checkpoint.seconds > 0)) {
    wrong_value("--every", "a number of layers or a time such as 16layers, 90s, 5min or 2h", text);
  }
}

// Makes the folder for the states of a new run. Another run's are never overwritten.
void make_checkpoint_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw CannotWrite(folder + ": cannot be created: " + error.message());
  const std::filesystem::path path(folder);
  if (std::filesystem::exists(path / "state-0") || std::filesystem::exists(path / "state-1")) {
    throw CannotWrite(
        fmt::format("{}: holds an unfinished run: go on with isoweave mesh --resume {}, or remove it", folder, folder));
  }
}

// Makes the folder of the parts of a mesh. Without a state there is nothing to go on with: what is there is of a run
// that ended before its first one.
void make_part_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw CannotWrite(folder + ": cannot be created: " + error.message());
  for (const char* part : {"mesh.part", "faces.part", "positions.part", "normals.part", "values.part"})
    std::filesystem::remove(std::filesystem::path(folder) / part, error);
}

// A whole volume is one layer thicker than its slices when it is closed.
std::int64_t parse_slab(std::string_view text, std::int64_t slices) {
  const std::int64_t whole = slices + 2;
  if (text == "auto") return 0;
  if (text == "whole") return whole;
  return std::min(parse_count("--slab", text), whole);
}

Normals parse_normals(std::string_view text) {
  return parse_choice<Normals>(
      "--normals", text,
      {{"none", Normals::kAbsent}, {"gradient", Normals::kGradient}, {"quadric", Normals::kQuadric}});
}

// The volume whose values the vertices get, with what was chosen of the first one; or none.
std::unique_ptr<SliceSource> open_values(const MeshArguments& arguments) {
  if (arguments.color_by.empty()) return nullptr;
  InputOptions input;
  input.path = arguments.color_by;
  input.roi = arguments.input.roi;
  input.step = arguments.input.step;
  return open_input(input);
}

OutputSpace parse_space(std::string_view text) {
  if (text.empty()) return OutputSpace::kAsVolume;
  return parse_choice<OutputSpace>(
      "--space", text, {{"lps", OutputSpace::kLps}, {"ras", OutputSpace::kRas}, {"index", OutputSpace::kIndex}});
}

// All that needs no volume.
MeshOptions mesh_options(const MeshArguments& arguments) {
  MeshOptions options;
  const bool known = arguments.iso != "auto" && arguments.labels.empty();
  if (known) options.iso = parse_number("--iso", arguments.iso);
  options.inside_above = parse_choice<bool>("--inside", arguments.inside, {{"above", true}, {"below", false}});
  options.closed = !arguments.open;
  options.smooth = parse_smooth(arguments.smooth);
  options.quality = parse_quality(arguments.quality);
  options.normals = parse_normals(arguments.normals);
  options.drop_specks = drops_specks(arguments.stop);
  options.space = parse_space(arguments.space);
  return options;
}

// Reads the volume once more, by itself, as slices cannot be read twice.
double automatic_iso(const InputOptions& input, const std::atomic<bool>& stop) {
  const std::optional<double> iso = otsu_threshold(read_histogram(*open_input(input), &stop));
  if (!iso) throw BadInput(input.path + ": --iso auto expects at least two different values, found one or none");
  return *iso;
}

std::string smooth_text(const MeshOptions& options) {
  return options.smooth > 0 ? fmt::format(" smooth {}", options.smooth) : "";
}

std::vector<std::string> comments(const MeshArguments& arguments, const StopOptions& stop, const MeshOptions& options) {
  return {"isoweave " ISOWEAVE_VERSION,
          fmt::format("iso {} inside {} {} {} quality {}{}", options.iso, arguments.inside,
                      options.closed ? "closed" : "open", stop_text(stop, kUsualError, options.triangles),
                      arguments.quality, smooth_text(options) + component_text(component_rule(arguments.components)))};
}

// How the mesh of a level is to be written.
MeshFileOptions file_options(const MeshArguments& arguments, const StopOptions& stop, const MeshOptions& options,
                             const Geometry& geometry) {
  MeshFileOptions file;
  file.normals = options.normals != Normals::kAbsent;
  file.values = !arguments.color_by.empty();
  file.comments = comments(arguments, stop, options);
  file.unit = geometry.unit;
  file.space = space_text(geometry, options.space);
  return mesh_file_options(arguments.output, std::move(file));
}

std::uint64_t output_bytes(const Forecast& forecast, const MeshArguments& arguments, const MeshFileOptions& file) {
  return output_bytes(arguments.output, forecast.vertices, forecast.triangles, file);
}

std::string forecast_text(const Forecast& forecast, std::uint64_t bytes, int threads) {
  return fmt::format(
      "triangles  about {}, {} of them left\noutput     about {}\nmemory     about {}, with --memory at least {}\n"
      "time       about {:.2g} s on {} thread{}\n",
      short_count(static_cast<double>(forecast.triangles_extracted)),
      short_count(static_cast<double>(forecast.triangles)), byte_text(bytes), byte_text(forecast.peak_bytes),
      byte_text(forecast.least_bytes), forecast.seconds, threads, threads == 1 ? "" : "s");
}

// What the run will take; refuses what is known to fail. A volume can be read once: this is another opening of it.
Forecast checked_forecast(const MeshArguments& arguments, const MeshOptions& options, const MeshFileOptions& file,
                          const RunControl& control) {
  Forecast forecast = forecast_mesh(*open_input(arguments.input), options, control);
  output_bytes(forecast, arguments, file);
  const std::uint64_t beside =
      output_memory(arguments.output, forecast.vertices, forecast.triangles, file) + watch_memory(arguments.watch);
  forecast.peak_bytes += beside;
  forecast.least_bytes += beside;
  if (control.memory > 0 && forecast.least_bytes > control.memory) {
    throw OverMemory(fmt::format("{}: expected --memory {:.0f}M or more, found {}", arguments.input.path,
                                 std::ceil(static_cast<double>(forecast.least_bytes) * 1e-6), arguments.memory));
  }
  return forecast;
}

Json report_json(const MeshReport& report, const VolumeInfo& info, const MeshArguments& arguments,
                 const MeshOptions& options, const MeshFileOptions& file, const std::optional<Forecast>& forecast) {
  const std::vector<OutputOptions> outputs = level_outputs(arguments.output, arguments.stop);
  Json input = volume_json(info, arguments.input.path);
  add_range(input, report.min, report.max, report.nan);
  Json json = run_json(report, std::move(input));
  if (forecast) {
    json["memory"]["predicted_bytes"] = forecast->peak_bytes;
    json["forecast"] = forecast_json(*forecast, output_bytes(*forecast, arguments, file));
  }
  json["iso"] = options.iso;
  json["inside"] = arguments.inside;
  json["closed"] = options.closed;
  json["smooth"] = options.smooth;
  if (options.triangles > 0) json["target"] = {{"triangles", options.triangles}};
  json["quality"] = arguments.quality;
  json["normals"] = arguments.normals;
  if (!arguments.color_by.empty()) json["color_by"] = arguments.color_by;
  json["output"] = outputs.back().name();
  if (!report.levels.empty()) json["levels"] = levels_json(report, outputs);
  json["space"] = space_text(info.geometry, options.space);
  return json;
}

void check_page_memory(const MeshArguments& arguments, std::uint64_t cap, std::uint64_t triangles) {
  if (!arguments.page.given() || cap == 0 || page_memory(triangles) <= cap) return;
  throw OverMemory(fmt::format("{}: expected --memory {:.0f}M or more for --html, found {}", arguments.input.path,
                               std::ceil(static_cast<double>(page_memory(triangles)) * 1e-6), arguments.memory));
}

// What the finest level will take in its file, or all levels in one; refuses what its format cannot hold. `last`: of
// the coarsest level.
void check_finer(const MeshArguments& arguments, const MeshOptions& options, const MeshFileOptions& file,
                 const RunControl& control, const Forecast& last) {
  Forecast sum;
  if (arguments.output.one_file) sum = last;
  for (const Length& error : options.levels) {
    MeshOptions level = options;
    level.error = error;
    level.levels.clear();
    const Forecast forecast = forecast_mesh(*open_input(arguments.input), level, control);
    sum.vertices += forecast.vertices;
    sum.triangles += forecast.triangles;
    output_bytes(sum, arguments, file);
    if (!arguments.output.one_file) return;
  }
}

// What of a cap is left for the run.
std::uint64_t memory_beside_watch(const MeshArguments& arguments, std::uint64_t cap) {
  const std::uint64_t held = watch_memory(arguments.watch);
  if (held < cap) return cap - held;
  throw OverMemory(fmt::format("{}: expected more than --memory {:.0f}M for --watch, found {}", arguments.input.path,
                               static_cast<double>(held) * 1e-6, arguments.memory));
}

// The mesh as it is in the file, and the surface before it was simplified, from a second pass over the volume.
PageContents page_contents(const MeshArguments& arguments, const MeshOptions& options, const MeshReport& report,
                           const RunControl& control) {
  const std::vector<OutputOptions> outputs = level_outputs(arguments.output, arguments.stop);
  PageContents contents{read_mesh(outputs.back().path)};
  contents.finer = read_finer(outputs);
  if (report.collapses == 0) {
    contents.full_note = "Nothing was simplified: there is no before and after, and no error to show.";
  } else if (report.triangles_extracted - report.triangles_dropped > kMostFullTriangles) {
    contents.full_note = too_full_note(report.triangles_extracted - report.triangles_dropped);
  } else {
    MeshOptions full = options;
    full.error = {0, false};
    full.triangles = 0;
    full.levels.clear();
    full.normals = Normals::kAbsent;
    full.values = nullptr;
    MemorySink sink;
    mesh_volume(*open_input(arguments.input), sink, full, control);
    contents.full = sink.take();
  }
  return contents;
}

// Refuses what is known to be wrong with --labels before any file is looked at.
void check_labels(const MeshArguments& arguments, const RunControl& control) {
  if (arguments.labels.empty()) return;
  parse_labels(arguments.labels);
  if (control.device == Device::kCuda) wrong_value("--labels", "a run on processors", "--device cuda");
}

// One mesh for each label.
void mesh_labels(const MeshArguments& arguments, const MeshOptions& options, SliceSource& volume,
                 const RunControl& control) {
  const VolumeInfo& info = volume.info();
  Evidence evidence(arguments.run, arguments.page);
  LabelsTask task{arguments.input,
                  arguments.output,
                  arguments.run,
                  options,
                  parse_labels(arguments.labels),
                  arguments.numbered,
                  {},
                  {}};
  task.file = [&](std::int64_t label) {
    MeshFileOptions file = file_options(arguments, arguments.stop, options, info.geometry);
    file.comments = {"isoweave " ISOWEAVE_VERSION,
                     fmt::format("label {} {} {} quality {}{}", label, options.closed ? "closed" : "open",
                                 stop_text(arguments.stop, kUsualError, 0), arguments.quality, smooth_text(options))};
    return file;
  };
  task.describe = [&](Json& json) {
    json["closed"] = options.closed;
    json["smooth"] = options.smooth;
    json["quality"] = arguments.quality;
    json["space"] = space_text(info.geometry, options.space);
  };
  mesh_label_files(task, volume, control, evidence);
}

void mesh(const MeshArguments& arguments, const Checkpoint* resume) {
  const RunOptions& run = arguments.run;
  MeshOptions options = mesh_options(arguments);
  RunControl control = run_control(run);
  const ProgressMode mode = progress_mode(run.progress, run.quiet);
  parse_slab(arguments.slab, 1);
  check_page(arguments.page, arguments.output);
  check_watch(arguments.watch, control.device);
  const ComponentRule rule = component_rule(arguments.components);
  check_components(rule, control.device);
  check_labels(arguments, control);
  if (control.device == Device::kCuda && !arguments.checkpoint.empty()) {
    throw std::invalid_argument("--device cuda: expected a run without --checkpoint, which takes processors");
  }
  const std::vector<OutputOptions> outputs = level_outputs(arguments.output, arguments.stop);
  for (const OutputOptions& output : outputs) {
    check_different({arguments.input.path, output.path, run.report, arguments.page.path});
    check_different({arguments.color_by, output.path});
  }

  const std::unique_ptr<SliceSource> volume = open_input(arguments.input);
  const VolumeInfo info = volume->info();
  const std::unique_ptr<SliceSource> values = open_values(arguments);
  options.values = values.get();
  options.error = stop_error(arguments.stop, kUsualError, info.geometry.unit);
  options.max_distance = stop_distance(arguments.stop, info.geometry.unit);
  options.levels = finer_levels(arguments.stop, info.geometry.unit);
  options.slab = parse_slab(arguments.slab, info.dims[2]);

  if (!arguments.memory.empty()) control.memory = parse_bytes("--memory", arguments.memory);

  control.stop = &stop_on_signal();
  if (!arguments.labels.empty()) return mesh_labels(arguments, options, *volume, control);
  Evidence evidence(run, arguments.page);
  if (arguments.iso == "auto") {
    open_output(outputs.back(),
                mesh_file_options(arguments.output, {}));  // finds out now what would stop the run after the first pass
    options.iso = automatic_iso(arguments.input, *control.stop);
    if (!run.quiet) print_note(fmt::format("--iso {} (Otsu's threshold)", options.iso));
  }
  std::optional<ComponentChoice> components;
  const auto choose = [&] {
    if (rule.keeps_all() || components) return;
    components = choose_components(*open_input(arguments.input), options, rule, control);
    options.components = &*components;
  };
  options.triangles = stop_triangles(arguments.stop, [&] {
    choose();
    return components ? components->triangles : count_triangles(*open_input(arguments.input), options, control);
  });
  const MeshFileOptions file = file_options(arguments, arguments.stop, options, info.geometry);
  std::optional<Forecast> forecast;
  if (resume == nullptr) {
    forecast = checked_forecast(arguments, options, file, control);
    check_finer(arguments, options, file, control, *forecast);
  }
  if (forecast) check_page_memory(arguments, control.memory, forecast->triangles);
  if (arguments.dry_run) {
    const std::uint64_t bytes = output_bytes(*forecast, arguments, file);
    const int threads = control.threads > 0 ? control.threads : static_cast<int>(std::thread::hardware_concurrency());
    print_out(forecast_text(*forecast, bytes, threads));
    if (!rule.keeps_all()) print_out("components that --largest or --min-component drops are counted in\n");
    evidence.write_forecast({{"version", ISOWEAVE_VERSION}, {"forecast", forecast_json(*forecast, bytes)}});
    return;
  }
  choose();
  if (!arguments.checkpoint.empty()) {
    parse_every(arguments.every, control.checkpoint);
    if (resume == nullptr) make_checkpoint_folder(arguments.checkpoint);
    control.checkpoint.folder = arguments.checkpoint;
    control.checkpoint.note = task_json(arguments, options).dump();
  }
  control.resume = resume;
  if (control.memory > 0) control.memory = memory_beside_watch(arguments, control.memory);
  const std::vector<std::string> folders = level_folders(arguments.checkpoint, outputs.size());
  if (resume != nullptr && resume->marks.size() != outputs.size()) refuse_state(*resume);
  const LevelSinks sinks(outputs, [&](std::size_t level) {
    MeshFileOptions level_file = file_options(arguments, stop_levels(arguments.stop)[level], options, info.geometry);
    level_file.parts = folders[level];
    if (resume != nullptr) {
      level_file.mark = resume->marks[level];
    } else if (!level_file.parts.empty()) {
      make_part_folder(level_file.parts);
    }
    return level_file;
  });
  if (!run.quiet) {
    for (const std::string& note : info.notes) print_note("warning: " + note);
  }
  const std::unique_ptr<Watch> watch =
      start_watch(arguments.watch,
                  {info, options, arguments.input.path, outputs.back().name(), resume == nullptr ? 0 : resume->layer});
  ProgressPrinter printer(mode);
  control.progress = [&](const Progress& progress) { printer.show(progress); };
  control.observer = watch.get();
  const MeshReport report = mesh_volume(*volume, sinks.pointers(), options, control);
  remove_level_folders(folders);
  if (watch) watch->complete(report);
  printer.finish();
  Json json = report_json(report, info, arguments, options, file, forecast);
  json["notes"] = sinks.last().notes();
  evidence.write(std::move(json), control, [&](const RunControl& quiet) {
    std::uint64_t triangles = report.triangles;
    for (const SurfaceReport& level : report.levels) triangles += level.triangles;
    check_page_memory(arguments, control.memory, triangles);
    return page_contents(arguments, options, report, quiet);
  });
  if (run.quiet) return;
  for (const std::string& warning : report.warnings) print_note("warning: " + warning);
  print_notes(sinks.last());
  print_dropped(report);
  print_levels(report, outputs);
  if (options.triangles > 0)
    print_note(fmt::format("error reached: {:.4g}{}{}", report.error, info.geometry.unit.empty() ? "" : " ",
                           info.geometry.unit));
  const auto slices = static_cast<double>(info.dims[2]);
  print_summary(report, outputs.back().name(), static_cast<double>(info.slice_samples()) * slices,
                forecast ? &*forecast : nullptr);
  if (watch) watch->deliver(*control.stop);
}

void run_mesh(MeshArguments arguments) {
  if (arguments.resume.empty()) {
    if (arguments.input.path.empty()) throw CLI::RequiredError("VOLUME");
    if (!arguments.output.given()) throw CLI::RequiredError("--output");
    if (arguments.iso.empty() && arguments.labels.empty()) throw CLI::RequiredError("--iso");
    if (arguments.slab.empty()) arguments.slab = "auto";
    if (arguments.every.empty()) arguments.every = "5min";
    return mesh(arguments, nullptr);
  }
  const Checkpoint checkpoint = read_checkpoint(arguments.resume);
  arguments = resumed_arguments(arguments, checkpoint);
  if (!arguments.run.quiet) print_note(fmt::format("resumed at layer {} of {}", checkpoint.layer, checkpoint.layers));
  mesh(arguments, &checkpoint);
}

// The task of a run that goes on is known; how it runs may be said anew.
void exclude_task_options(CLI::App& verb, CLI::Option& resume) {
  constexpr std::array<std::string_view, 13> kRunning{
      "--help", "--slab",     "--memory",   "--every", "--threads",        "--device", "--report",
      "--html", "--schedule", "--progress", "--quiet", "--page-triangles", "--watch"};
  for (CLI::Option* option : verb.get_options()) {
    const std::string name = option->get_name();
    if (option != &resume && std::ranges::find(kRunning, name) == kRunning.end()) resume.excludes(option);
  }
}

}  // namespace

void add_mesh_verb(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("mesh", "Volume to simplified surface");
  const auto arguments = std::make_shared<MeshArguments>();
  add_input_options(*verb, arguments->input);
  add_output_options(*verb, arguments->output);
  verb->add_option("--iso", arguments->iso, "Value of the surface, or auto (Otsu's threshold)");
  add_stop_options(*verb, arguments->stop);
  add_component_options(*verb, arguments->components, "full surface; a volume is read twice");
  verb->add_option("--quality", arguments->quality, "fast, normal or fine")->capture_default_str();
  verb->add_option("--slab", arguments->slab, "Layers per slab: a number, auto or whole; never changes the result")
      ->default_str("auto");
  CLI::Option* open = verb->add_flag("--open", arguments->open, "Let the surface end at the volume's border");
  verb->add_flag("--closed", arguments->closed, "Close the surface at the volume's border (default)")->excludes(open);
  verb->add_option("--inside", arguments->inside, "Side of --iso that is inside: above or below")
      ->capture_default_str();
  // A flag, as a value that stands apart would be taken for the volume.
  verb->add_flag(fmt::format("--smooth{{{}}}", kUsualSmoothing), arguments->smooth,
                 "Smooth the mask of what is inside, each vertex within its edge of the lattice; --smooth=N: passes");
  verb->add_option("--normals", arguments->normals,
                   "none, gradient, or quadric: gradients that the simplification keeps as well as the places")
      ->capture_default_str();
  verb->add_option("--color-by", arguments->color_by,
                   "Volume of the same size whose values the vertices get: 'quality' in PLY, 'value' in VTP");
  verb->add_option("--space", arguments->space, "Coordinates of the output: lps, ras or index (default: the volume's)");
  verb->add_option("--memory", arguments->memory, "Cap on the memory of the process, such as 800M or 2G");
  verb->add_flag("--dry-run", arguments->dry_run, "Say what the run would take, from a sample of the volume");
  verb->add_option("--checkpoint", arguments->checkpoint,
                   "Save the state of the run in this folder, to go on with after whatever ends it")
      ->excludes("--to-stdout");
  verb->add_option("--every", arguments->every, "How often: a number of layers or a time: 16layers, 90s, 5min, 2h")
      ->default_str("5min");
  add_run_options(*verb, arguments->run);
  add_page_options(*verb, arguments->page);
  add_watch_option(*verb, arguments->watch);
  CLI::Option* resume =
      verb->add_option("--resume", arguments->resume, "Go on with the run whose state is saved in this folder");
  verb->add_option(
          "--labels", arguments->labels,
          "Labels 1,2,5 of a label map, or all: one surface each from one sweep, -o a.ply makes a_label1.ply, ...")
      ->excludes("--iso", "--inside", "--lods", "--triangles", "--ratio", "--step", "--to-stdout", "--memory",
                 "--dry-run", "--checkpoint", "--every", "--color-by", "--min-component", "--largest", "--one-file",
                 "--html", "--page-triangles", "--watch");
  exclude_task_options(*verb, *resume);
  verb->footer(kExamples);
  verb->callback([arguments, verb] {
    arguments->numbered = verb->count("--segment") > 0;
    run_mesh(*arguments);
  });
}

}  // namespace isoweave::cli
