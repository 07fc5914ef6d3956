#include "verbs/mesh_job.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "isoweave/checkpoint_folder.hpp"
#include "isoweave/error.hpp"
#include "isoweave/forecast.hpp"
#include "isoweave/printable.hpp"
#include "isoweave/remote.hpp"
#include "options/files.hpp"
#include "options/levels.hpp"
#include "options/parts.hpp"
#include "options/values.hpp"
#include "report/evidence.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "signals.hpp"
#include "verbs/mesh_blocks.hpp"
#include "verbs/mesh_forecast.hpp"
#include "verbs/mesh_isos.hpp"
#include "verbs/mesh_labels.hpp"
#include "verbs/mesh_options.hpp"
#include "verbs/mesh_possible.hpp"
#include "verbs/mesh_preview.hpp"
#include "verbs/mesh_report.hpp"
#include "verbs/mesh_state.hpp"

namespace isoweave::cli {
namespace {

// A pass over the volume that makes its surface.
void make_surface(const MeshArguments& arguments, const MeshOptions& options, const RunControl& control,
                  MeshSink& sink) {
  const std::unique_ptr<SliceSource> volume = open_input(arguments.input);
  mesh_volume(*volume, sink, options, control);
}

// Adds the surface before simplification. One that is too large for a page is handed over in pieces, and a simplified
// one stands in for it.
void add_full_surface(PageContents& contents, const MeshArguments& arguments, const MeshOptions& options,
                      std::uint64_t triangles, const RunControl& control) {
  MeshOptions full = full_surface(options);
  full.space = options.space;
  const VolumeInfo info = open_input(arguments.input)->info();
  const bool too_large = triangles > kMostFullTriangles;
  if (too_large) {
    contents.full_triangles = triangles;
    contents.full_pass = [=, &arguments](MeshSink& sink) { make_surface(arguments, full, control, sink); };
  }
  MeshInMemory surface(mesh_offset(info, options.space));
  make_surface(arguments, too_large ? stand_in_options(options, info) : full, control, surface);
  contents.full = surface.copy();
}

// The contents of the page: the mesh as it is in the file, and the surface before simplification, from further passes
// over the volume.
PageContents page_contents(const MeshArguments& arguments, const MeshOptions& options, const MeshReport& report,
                           const RunControl& control) {
  const std::vector<OutputOptions> outputs = level_outputs(arguments.output, arguments.stop);
  PageContents contents;
  if (report.collapses == 0) {
    contents.full_note = "Nothing was simplified: there is no before and after, and no error to show.";
  } else {
    add_full_surface(contents, arguments, options, report.triangles_extracted - report.triangles_dropped, control);
  }
  contents.mesh = read_mesh(outputs.back().path);
  contents.finer = read_finer(outputs);
  return contents;
}

// The fewest samples of a label that is meshed.
std::uint64_t min_samples(const MeshArguments& arguments) {
  if (arguments.min_label.empty()) return 0;
  return static_cast<std::uint64_t>(parse_count("--min-label", arguments.min_label));
}

// Refuses options that do not go with --labels, before any file is looked at.
void check_labels(const MeshArguments& arguments) {
  if (arguments.labels.empty()) return;
  const LabelChoice choice = parse_labels(arguments.labels);
  if (min_samples(arguments) > 0 && !choice.all) {
    wrong_value("--min-label", "--labels all, as labels that are named are always taken", arguments.labels);
  }
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
                  asked_blocks(arguments),
                  arguments.label_names,
                  min_samples(arguments),
                  arguments.numbered,
                  {},
                  {}};
  task.file = [&](const LabelName& label) {
    MeshFileOptions file = file_options(arguments, arguments.stop, options, info);
    file.comments = {"isoweave " ISOWEAVE_VERSION,
                     fmt::format("label {} {} {} quality {}{}", label.label.text(), options.closed ? "closed" : "open",
                                 stop_text(arguments.stop, kUsualError), arguments.quality,
                                 extractor_text(arguments) + smooth_text(options))};
    if (!label.name.empty()) file.comments.push_back("name " + printable(label.name));
    return file;
  };
  task.describe = [&](Json& json) {
    json["closed"] = options.closed;
    json["smooth"] = options.smooth;
    json["extractor"] = arguments.extractor;
    json["quality"] = arguments.quality;
    json["space"] = space_of_mesh(info.geometry, options.space);
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
        outputs_(one_surface() ? level_outputs(arguments.output, arguments.stop) : std::vector{arguments.output}),
        options_(mesh_options(arguments)),
        control_(run_control(arguments.run)) {
    if (!arguments.memory.empty()) control_.memory = parse_bytes("--memory", arguments.memory);
    set_number(arguments.stop, options_);
  }

  void run() {
    const ProgressMode mode = progress_mode(arguments_.run.progress, quiet());
    check();
    open();
    if (!arguments_.labels.empty()) {
      mesh_labels(arguments_, options_, info_, control_);
      return tell_lengths();
    }
    Evidence evidence(arguments_.run, arguments_.page);
    if (has_several_isos(arguments_)) return mesh_isos(evidence);
    if (!arguments_.dry_run) try_levels(outputs_);
    if (arguments_.iso == "auto") find_iso();
    if (arguments_.preview.given()) return preview(evidence);
    block_size_ = asked_blocks(arguments_);
    file_ = file_options(arguments_, arguments_.stop, options_, info_);
    if (!resume_ && needs_forecast()) slabs_or_blocks();
    if (arguments_.dry_run) return tell_forecast(evidence);
    choose();
    prepare_states();
    sweep(mode, evidence);
  }

 private:
  // Whether there is one surface, of levels or not.
  bool one_surface() const { return arguments_.labels.empty() && !has_several_isos(arguments_); }

  bool quiet() const { return arguments_.run.quiet; }
  bool no_clobber() const { return arguments_.run.no_clobber; }

  // Checks all options that need no file.
  void check() const {
    parse_slab(arguments_.slab, 1);
    check_watch(arguments_.watch);
    check_possible(arguments_, options_, control_, resume_);
    check_labels(arguments_);
    check_isos(arguments_);
    if (asked_blocks(arguments_) && (arguments_.dry_run || is_read_once(arguments_.input.path))) {
      throw std::invalid_argument(arguments_.dry_run
                                      ? "--blocks: expected a run without --dry-run, which foresees slabs"
                                      : "--blocks: expected a volume that can be read again, found a pipe");
    }
    if (!arguments_.checkpoint.empty() && is_read_once(arguments_.input.path)) {
      throw std::invalid_argument("--checkpoint: expected a volume that --resume can read again, found a pipe");
    }
    if (!arguments_.checkpoint.empty()) refuse_secrets(arguments_, "saved state");
    for (const OutputOptions& output : outputs_) {
      check_different({arguments_.input.path, output.path, arguments_.run.report, arguments_.page.path});
      check_different({shown_url(arguments_.color_by), output.path});
      if (one_surface()) check_absent(no_clobber(), {output.path});
    }
    check_absent(no_clobber(), {arguments_.run.report, arguments_.page.path});
    check_page(arguments_.page, arguments_.output);
    check_placing(arguments_.output, outputs_.size() > 1 || !one_surface());
    if (!one_surface()) check_parts(arguments_.output, !arguments_.labels.empty());
  }

  // The volumes, and the options that depend on their units and sizes.
  void open() {
    exit_on_signal();
    volume_ = open_input(arguments_.input);
    info_ = volume_->info();
    if (one_surface()) index_ = open_index(arguments_.index, arguments_.input, info_, quiet());
    control_.index = index_.index;
    control_.reopen = [this] { return open_input(arguments_.input); };
    options_.values = open_values(arguments_);
    set_automatic_normals(arguments_, options_);
    set_lengths(arguments_, info_, options_);
    control_.slab = parse_slab(arguments_.slab, info_.dims[2]);
    control_.stop = borrow(stop_on_signal());
  }

  // Makes a mesh for each iso-value.
  void mesh_isos(Evidence& evidence) {
    mesh_iso_files(arguments_, options_, *volume_, control_, evidence);
    tell_lengths();
  }

  void preview(Evidence& evidence) {
    mesh_preview(arguments_, options_, *volume_, control_, evidence);
    tell_lengths();
  }

  void tell_lengths() const {
    if (!quiet()) cli::tell_lengths(arguments_, info_);
  }

  void find_iso() {
    require_memory_to_read(*volume_, options_, control_);
    const AutomaticIso found = automatic_iso(arguments_.input, *control_.stop);
    options_.iso = found.iso;
    if (quiet()) return;
    print_note(fmt::format("--iso {} (Otsu's threshold)", options_.iso));
    if (!found.others.empty()) print_note(found.others);
  }

  // Chooses the components, once, in a pass of its own.
  void choose() {
    if (rule_.keeps_all() || options_.components != nullptr) return;
    options_.components =
        std::make_shared<ComponentChoice>(choose_components(*open_input(arguments_.input), options_, rule_, control_));
  }

  // Foresees a run in slabs. Where they do not fit into the cap, it takes blocks instead.
  void slabs_or_blocks() {
    if (block_size_) return;
    try {
      foresee_slabs();
    } catch (const OverMemory&) {
      if (arguments_.dry_run || !may_take_blocks(arguments_, options_, control_, *volume_)) throw;
      choose_blocks();
      if (!block_size_) throw;
    }
  }

  // Chooses blocks that are expected to fit into the cap, if there are any. Where not even empty ones do, nothing is
  // read.
  void choose_blocks() {
    const auto size_for = [this](std::uint64_t triangles, std::uint64_t wanted) {
      return block_size_for([this] { return open_input(arguments_.input); }, triangles, control_.memory, wanted);
    };
    if (!size_for(0, options_.triangles)) return;
    RunControl uncapped = control_;
    uncapped.memory = 0;
    const Forecast forecast = forecast_mesh(*open_input(arguments_.input), options_, uncapped);
    if (rule_.keeps_all()) control_.head_start = forecast.head_start;
    block_size_ = size_for(forecast.triangles_extracted, arguments_.stop.has_number() ? forecast.triangles : 0);
    if (quiet() || !block_size_) return;
    print_note(fmt::format("--memory {}: too little for slabs, so blocks of {} are taken (--blocks off: they are not)",
                           arguments_.memory, *block_size_));
  }

  // Whether anything goes by a forecast, which takes up to a third of the time of a small run.
  bool needs_forecast() const {
    const bool is_told = arguments_.dry_run || !arguments_.run.report.empty() || arguments_.page.given();
    return is_told || control_.memory > 0 || arguments_.stop.has_number() ||
           !holds_any_surface(arguments_, file_, info_);
  }

  void foresee_slabs() {
    const CheckedForecast checked = checked_forecast(arguments_, options_, file_, control_);
    forecast_ = checked.run;
    // A forecast does not know how many triangles dropped components have: then the run makes one that does.
    if (rule_.keeps_all()) control_.head_start = forecast_->head_start;
    control_.count_first = control_.memory > 0 && control_.memory < forecast_->least_bytes_at_once;
    if (control_.count_first && !quiet()) {
      print_note(
          fmt::format("--memory {}: too little for one sweep to a number of triangles, so a first one counts them",
                      arguments_.memory));
    }
    files_bytes_ = checked.files;
    check_finer(arguments_, options_, file_, control_, *forecast_);
  }

  void tell_forecast(Evidence& evidence) const {
    const std::uint64_t bytes = output_bytes(*forecast_, arguments_, file_);
    const int threads = control_.threads > 0 ? control_.threads : static_cast<int>(std::thread::hardware_concurrency());
    print_to_reader(forecast_text(*forecast_, options_.triangles, bytes, threads));
    if (!rule_.keeps_all()) print_to_reader("components that --largest or --min-component drops are counted in\n");
    tell_lengths();
    evidence.write_forecast(
        {{"version", ISOWEAVE_VERSION}, {"forecast", Json::parse(forecast_json(*forecast_, bytes))}});
  }

  void prepare_states() {
    control_.resume = resume_;
    if (resume_ && resume_->marks.size() != outputs_.size()) refuse_state(*resume_);
    if (arguments_.checkpoint.empty()) return;
    parse_every(arguments_.every, control_.checkpoint);
    if (!resume_) lock_ = begin_checkpoints(arguments_.checkpoint);
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
    const std::vector<std::string> folders = part_folders(arguments_.checkpoint, outputs_.size());
    const LevelSinks sinks(outputs_, [&](std::size_t level) { return level_file(level, folders[level]); });
    print_volume_notes();
    const std::shared_ptr<Watch> watch =
        start_watch(arguments_.watch,
                    {info_, options_, arguments_.input.path, outputs_.back().name(), !resume_ ? 0 : resume_->layer});
    ProgressPrinter printer(mode);
    control_.progress = [&](const Progress& progress) { printer.show(progress); };
    control_.observer = watch;
    MeshReport report = mesh(sinks);
    sinks.tell_digests(report);
    const std::string preset = preset_note(arguments_.iso, report.min, report.max);
    if (!preset.empty()) report.warnings.push_back(preset);
    if (watch) watch->complete(report);
    printer.finish();
    write_evidence(report, sinks, evidence);
    if (quiet()) return;
    print_result(report, sinks);
    if (watch) watch->deliver(*control_.stop);
  }

  // Says what to try where nothing is at the iso-value.
  MeshReport mesh(const LevelSinks& sinks) {
    try {
      if (!block_size_) return mesh_volume(*volume_, sinks.pointers(), options_, control_);
      return mesh_input_in_blocks(arguments_, *block_size_, sinks.pointers(), options_, control_);
    } catch (const EmptySurface& empty) {
      const bool misses = arguments_.iso != "auto" && rule_.keeps_all();
      throw EmptySurface(std::string(empty.what()) + (misses ? ": try --iso auto" : ""));
    }
  }

  void print_volume_notes() const {
    if (quiet()) return;
    cli::print_volume_notes(info_);
    if (options_.values != nullptr) cli::print_volume_notes(options_.values->info());
  }

  void write_evidence(const MeshReport& report, const LevelSinks& sinks, Evidence& evidence) const {
    Json json = mesh_report_json(report, info_, arguments_, options_, file_, forecast_);
    json["notes"] = sinks.last().notes();
    if (report.left_out) json["index"] = left_out_json(*report.left_out, index_.path);
    evidence.write(std::move(json), control_, [&](const RunControl& control) {
      std::uint64_t triangles = report.triangles;
      for (const SurfaceReport& level : report.levels) triangles += level.triangles;
      check_page_memory(arguments_, control_.memory, triangles, report.triangles_extracted);
      RunControl capped = control;
      capped.memory = control_.memory;
      return page_contents(arguments_, options_, report, capped);
    });
  }

  void print_result(const MeshReport& report, const LevelSinks& sinks) const {
    tell_lengths();
    for (const std::string& warning : report.warnings) print_note("warning: " + warning);
    print_notes(sinks.last());
    print_caps(report, arguments_);
    print_dropped(report);
    print_levels(report, outputs_);
    print_target(arguments_.stop, report, options_.error, info_.geometry.unit);
    const double voxels = static_cast<double>(info_.slice_samples()) * static_cast<double>(info_.dims[2]);
    print_left_out(report, index_.path);
    print_summary(report, outputs_.back().name(), voxels);
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
  FoundIndex index_;
  MeshFileOptions file_;
  std::optional<Forecast> forecast_;        // of a run in slabs that is not resumed
  std::optional<std::int64_t> block_size_;  // of a run in blocks
  std::uint64_t files_bytes_ = 0;           // that writing is forecast to hold
};

}  // namespace

void run_mesh_job(const MeshArguments& arguments, std::optional<Checkpoint> resume,
                  std::shared_ptr<const CheckpointLock> lock) {
  MeshJob(arguments, std::move(resume), std::move(lock)).run();
}

}  // namespace isoweave::cli
