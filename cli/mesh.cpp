// isoweave mesh: volume in, simplified surface out.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "components.hpp"
#include "evidence.hpp"
#include "files/printable.hpp"
#include "isoweave/error.hpp"
#include "labels.hpp"
#include "lods.hpp"
#include "mesh_arguments.hpp"
#include "mesh_forecast.hpp"
#include "mesh_options.hpp"
#include "mesh_output.hpp"
#include "mesh_state.hpp"
#include "options.hpp"
#include "output.hpp"
#include "pipeline/forecast/forecast_reader.hpp"
#include "report.hpp"
#include "signals.hpp"
#include "stop.hpp"
#include "verbs.hpp"
#include "watch.hpp"

namespace isoweave::cli {
namespace {

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
  json["offset"] = file.offset;
  return json;
}

// The contents of the page: the mesh as it is in the file, and the surface before simplification, from a second pass
// over the volume.
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
    MeshOptions full = full_surface(options);
    full.space = options.space;
    const std::unique_ptr<SliceSource> volume = open_input(arguments.input);
    MeshInMemory surface(mesh_offset(volume->info(), options.space));
    mesh_volume(*volume, surface, full, control);
    contents.full = surface.copy();
  }
  return contents;
}

// Refuses options that do not go with --labels, before any file is looked at.
void check_labels(const MeshArguments& arguments) {
  if (arguments.labels.empty()) return;
  parse_labels(arguments.labels);
  if (arguments.input.even_spacing == "resample") {
    wrong_value("--even-spacing", "mean or refuse with --labels, as nothing lies between two labels", "resample");
  }
}

// Makes one mesh for each label.
void mesh_labels(const MeshArguments& arguments, const MeshOptions& options, const VolumeInfo& info,
                 const RunControl& control) {
  Evidence evidence(arguments.run, arguments.page);
  LabelsTask task{arguments.input,
                  arguments.output,
                  arguments.run,
                  options,
                  parse_labels(arguments.labels),
                  arguments.label_names,
                  arguments.numbered,
                  {},
                  {}};
  task.file = [&](const LabelName& label) {
    MeshFileOptions file = file_options(arguments, arguments.stop, options, info);
    file.comments = {"isoweave " ISOWEAVE_VERSION,
                     fmt::format("label {} {} {} quality {}{}", label.label.text(), options.closed ? "closed" : "open",
                                 stop_text(arguments.stop, kUsualError, 0), arguments.quality, smooth_text(options))};
    if (!label.name.empty()) file.comments.push_back("name " + printable(label.name));
    return file;
  };
  task.describe = [&](Json& json) {
    json["closed"] = options.closed;
    json["smooth"] = options.smooth;
    json["quality"] = arguments.quality;
    json["space"] = space_text(info.geometry, options.space);
  };
  mesh_label_files(task, info, control, evidence);
}

// One run, step by step.
class MeshJob {
 public:
  // resume: the saved state to continue from, if there is one. lock: that of its folder, or null.
  MeshJob(const MeshArguments& arguments, std::optional<Checkpoint> resume, std::shared_ptr<const CheckpointLock> lock)
      : arguments_(arguments),
        resume_(std::move(resume)),
        lock_(std::move(lock)),
        rule_(component_rule(arguments.components)),
        outputs_(level_outputs(arguments.output, arguments.stop)),
        options_(mesh_options(arguments)),
        control_(run_control(arguments.run)) {}

  void run() {
    const ProgressMode mode = progress_mode(arguments_.run.progress, quiet());
    check();
    open();
    if (!arguments_.labels.empty()) return mesh_labels(arguments_, options_, info_, control_);
    Evidence evidence(arguments_.run, arguments_.page);
    if (arguments_.iso == "auto") find_iso();
    find_target();
    file_ = file_options(arguments_, arguments_.stop, options_, info_);
    if (!resume_) foresee();
    if (arguments_.dry_run) return tell_forecast(evidence);
    choose();
    prepare_states();
    sweep(mode, evidence);
  }

 private:
  bool quiet() const { return arguments_.run.quiet; }

  // Checks all options that need no file.
  void check() const {
    parse_slab(arguments_.slab, 1);
    check_page(arguments_.page, arguments_.output);
    check_watch(arguments_.watch, control_.device);
    check_together();
    check_labels(arguments_);
    if (!arguments_.checkpoint.empty() && is_read_once(arguments_.input.path)) {
      throw std::invalid_argument("--checkpoint: expected a volume that --resume can read again, found a pipe");
    }
    for (const OutputOptions& output : outputs_) {
      check_different({arguments_.input.path, output.path, arguments_.run.report, arguments_.page.path});
      check_different({arguments_.color_by, output.path});
    }
  }

  // Refuses options that do not go together, before any file is looked at.
  void check_together() const {
    MeshOptions asked = options_;
    RunControl control = control_;
    if (!rule_.keeps_all()) asked.components = std::make_shared<ComponentChoice>();
    if (arguments_.stop.has_number()) asked.triangles = 1;
    if (arguments_.stop.has_levels()) asked.levels = {Length{}};
    if (!arguments_.stop.max_distance.empty()) asked.max_distance = Length::voxels(1);
    control.checkpoint.folder = arguments_.checkpoint;
    control.resume = resume_;
    require_possible(arguments_.labels.empty() ? RunKind::kMesh : RunKind::kLabels, asked, control);
  }

  // The volumes, and the options that depend on their units and sizes.
  void open() {
    volume_ = open_input(arguments_.input);
    info_ = volume_->info();
    options_.values = open_values(arguments_);
    options_.error = stop_error(arguments_.stop, kUsualError, info_.geometry.unit);
    if (std::isinf(options_.error.value)) options_.error = Length::units(most_shape_error(info_));
    options_.max_distance = stop_distance(arguments_.stop, info_.geometry.unit);
    if (!quiet() && info_.geometry.unit.empty() && has_metric_length(arguments_.stop)) {
      print_note(info_.path + ": does not say its unit: lengths are taken for it to be mm");
    }
    options_.levels = finer_levels(arguments_.stop, info_.geometry.unit);
    control_.slab = parse_slab(arguments_.slab, info_.dims[2]);
    if (!arguments_.memory.empty()) control_.memory = parse_bytes("--memory", arguments_.memory);
    control_.stop = borrow(stop_on_signal());
  }

  void find_iso() {
    // Opens the file and discards it: an error that would stop the run after the first pass is found now.
    open_output(outputs_.back(), mesh_file_options(arguments_.output, {}));
    check_reader(*volume_, options_, control_);
    options_.iso = automatic_iso(arguments_.input, *control_.stop);
    if (!quiet()) print_note(fmt::format("--iso {} (Otsu's threshold)", options_.iso));
  }

  // Chooses the components, once, in a pass of its own.
  void choose() {
    if (rule_.keeps_all() || options_.components != nullptr) return;
    options_.components =
        std::make_shared<ComponentChoice>(choose_components(*open_input(arguments_.input), options_, rule_, control_));
  }

  // Finds the number of triangles to stop at. For a share, all triangles are counted first.
  void find_target() {
    if (control_.memory > 0 && !arguments_.stop.ratio.empty()) foresee_share();
    options_.triangles = stop_triangles(arguments_.stop, [&] {
      choose();
      if (options_.components != nullptr) return options_.components->triangles;
      return count_triangles(*open_input(arguments_.input), options_, control_);
    });
  }

  // Refuses a cap that is too small for a share of all triangles, before they are counted.
  void foresee_share() {
    const std::uint64_t all = forecast_mesh(*open_input(arguments_.input), options_, control_).triangles_extracted;
    const MeshFileOptions file = file_options(arguments_, arguments_.stop, options_, info_);
    const auto check_with = [&](std::uint64_t triangles) {
      options_.triangles = stop_triangles(arguments_.stop, [&] { return triangles; });
      checked_forecast(arguments_, options_, file, control_);
    };
    try {
      check_with(all);
    } catch (const OverMemory&) {
      check_with(all + all / 2);  // the cap that is named has to do with more triangles, too
      throw;
    }
    options_.triangles = 0;
  }

  void foresee() {
    const CheckedForecast checked = checked_forecast(arguments_, options_, file_, control_);
    forecast_ = checked.run;
    files_bytes_ = checked.files;
    check_finer(arguments_, options_, file_, control_, *forecast_);
  }

  void tell_forecast(Evidence& evidence) const {
    const std::uint64_t bytes = output_bytes(*forecast_, arguments_, file_);
    const int threads = control_.threads > 0 ? control_.threads : static_cast<int>(std::thread::hardware_concurrency());
    print_to_reader(forecast_text(*forecast_, options_.triangles, bytes, threads));
    if (!rule_.keeps_all()) print_to_reader("components that --largest or --min-component drops are counted in\n");
    evidence.write_forecast({{"version", ISOWEAVE_VERSION}, {"forecast", forecast_json(*forecast_, bytes)}});
  }

  void prepare_states() {
    control_.resume = resume_;
    if (resume_ && resume_->marks.size() != outputs_.size()) refuse_state(*resume_);
    if (arguments_.checkpoint.empty()) return;
    parse_every(arguments_.every, control_.checkpoint);
    if (!resume_) lock_ = std::make_shared<CheckpointLock>(make_checkpoint_folder(arguments_.checkpoint));
    control_.checkpoint.folder = arguments_.checkpoint;
    control_.checkpoint.lock = lock_;
    control_.checkpoint.note = task_json(arguments_, options_).dump();
  }

  // The options of a level's file, with its unfinished parts in a folder if there is one.
  MeshFileOptions level_file(std::size_t level, const std::string& folder) const {
    MeshFileOptions file = file_options(arguments_, stop_levels(arguments_.stop)[level], options_, info_);
    file.parts = folder;
    if (resume_) {
      file.mark = resume_->marks[level];
    } else if (!folder.empty()) {
      make_part_folder(folder);
    }
    return file;
  }

  void sweep(ProgressMode mode, Evidence& evidence) {
    control_.memory_elsewhere = watch_memory(arguments_.watch) + files_bytes_;
    const std::vector<std::string> folders = level_folders(arguments_.checkpoint, outputs_.size());
    const LevelSinks sinks(outputs_, [&](std::size_t level) { return level_file(level, folders[level]); });
    print_volume_notes();
    const std::shared_ptr<Watch> watch =
        start_watch(arguments_.watch,
                    {info_, options_, arguments_.input.path, outputs_.back().name(), !resume_ ? 0 : resume_->layer});
    ProgressPrinter printer(mode);
    control_.progress = [&](const Progress& progress) { printer.show(progress); };
    control_.observer = watch;
    const MeshReport report = mesh_volume(*volume_, sinks.pointers(), options_, control_);
    remove_level_folders(folders);
    if (watch) watch->complete(report);
    printer.finish();
    write_evidence(report, sinks, evidence);
    if (quiet()) return;
    print_result(report, sinks);
    if (watch) watch->deliver(*control_.stop);
  }

  void print_volume_notes() const {
    if (quiet()) return;
    for (const std::string& note : info_.notes) print_note("warning: " + note);
    if (options_.values == nullptr) return;
    for (const std::string& note : options_.values->info().notes) print_note("warning: " + note);
  }

  void write_evidence(const MeshReport& report, const LevelSinks& sinks, Evidence& evidence) const {
    Json json = report_json(report, info_, arguments_, options_, file_, forecast_);
    json["notes"] = sinks.last().notes();
    evidence.write(std::move(json), control_, [&](const RunControl& control) {
      std::uint64_t triangles = report.triangles;
      for (const SurfaceReport& level : report.levels) triangles += level.triangles;
      check_page_memory(arguments_, control_.memory, triangles);
      return page_contents(arguments_, options_, report, control);
    });
  }

  void print_result(const MeshReport& report, const LevelSinks& sinks) const {
    for (const std::string& warning : report.warnings) print_note("warning: " + warning);
    print_notes(sinks.last());
    print_dropped(report);
    print_levels(report, outputs_);
    print_target(report, options_.triangles, options_.error, info_.geometry.unit);
    const double voxels = static_cast<double>(info_.slice_samples()) * static_cast<double>(info_.dims[2]);
    print_summary(report, outputs_.back().name(), voxels, forecast_ ? &*forecast_ : nullptr);
  }

  const MeshArguments& arguments_;
  const std::optional<Checkpoint> resume_;
  std::shared_ptr<const CheckpointLock> lock_;
  const ComponentRule rule_;
  const std::vector<OutputOptions> outputs_;
  MeshOptions options_;
  RunControl control_;
  std::unique_ptr<SliceSource> volume_;
  VolumeInfo info_;
  MeshFileOptions file_;
  std::optional<Forecast> forecast_;  // of a run that is not resumed
  std::uint64_t files_bytes_ = 0;     // that writing is forecast to hold
};

void run_mesh(MeshArguments arguments) {
  if (arguments.resume.empty()) {
    if (arguments.input.path.empty()) throw CLI::RequiredError("VOLUME");
    if (!arguments.output.given()) throw CLI::RequiredError("--output");
    if (arguments.iso.empty() && arguments.labels.empty()) throw CLI::RequiredError("--iso");
    if (arguments.slab.empty()) arguments.slab = "auto";
    if (arguments.every.empty()) arguments.every = "5min";
    // Labels are not resampled, as a value between two labels is no label.
    const bool labels = !arguments.labels.empty() && !generated_input(arguments.input);
    if (labels && arguments.input.even_spacing.empty()) arguments.input.even_spacing = "refuse";
    return MeshJob(arguments, std::nullopt, nullptr).run();
  }
  // A path that is no folder cannot be locked and holds no state.
  std::shared_ptr<const CheckpointLock> lock;
  if (std::filesystem::is_directory(arguments.resume)) lock = std::make_shared<CheckpointLock>(arguments.resume);
  const Checkpoint checkpoint = read_checkpoint(arguments.resume);
  arguments = resumed_arguments(arguments, checkpoint);
  if (!arguments.run.quiet) print_note(fmt::format("resumed at layer {} of {}", checkpoint.layer, checkpoint.layers));
  MeshJob(arguments, checkpoint, std::move(lock)).run();
}

// Refuses options of the task with --resume: the state has the task, and only the way to run may change.
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
  // --smooth is a flag, as a value that stands apart would be taken for the volume.
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
          "Labels of a label map by number or name, such as 1,2,5, or all: one surface each, in a file of its own")
      ->excludes("--iso", "--inside", "--lods", "--triangles", "--ratio", "--step", "--to-stdout", "--memory",
                 "--dry-run", "--checkpoint", "--every", "--color-by", "--min-component", "--largest", "--one-file",
                 "--html", "--page-triangles", "--watch");
  verb->add_option("--label-names", arguments->label_names,
                   "Names of labels for files and reports: a FreeSurfer, ITK-SNAP or BIDS table")
      ->needs("--labels");
  exclude_task_options(*verb, *resume);
  verb->footer(kExamples);
  verb->callback([arguments, verb] {
    arguments->numbered = verb->count("--segment") > 0;
    run_mesh(*arguments);
  });
}

}  // namespace isoweave::cli
