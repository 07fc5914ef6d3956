// The main job: the loop over a volume, its states, and its report.
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "device/cuda_engine.hpp"
#include "files/input_file.hpp"
#include "isoweave/error.hpp"
#include "isoweave/forecast.hpp"
#include "isoweave/pipeline.hpp"
#include "output/world.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/device_back_end.hpp"
#include "pipeline/host_back_end.hpp"
#include "pipeline/run_report.hpp"
#include "pipeline/saved_run.hpp"
#include "pipeline/volume_sweep.hpp"
#include "select/component_filter.hpp"
#include "system/process_memory.hpp"
#include "volume/axes.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kLargeVolume = 1 << 22;  // samples: a forecast takes a small part of the time of the run

class VolumeRun final : public SavedRun::State {
 public:
  VolumeRun(SliceSource& source, std::span<MeshSink* const> sinks, const MeshOptions& options,
            const RunControl& control, const HeadStart& head_start)
      : task_(resolve(source.info(), options, control, common_offset(sinks))),
        control_(control),
        identity_(identity_of(task_)),
        sinks_(sinks.begin(), sinks.end()),
        sweep_(source, task_, control_, report_),
        world_(task_.volume.geometry, task_.space, task_.offset),
        counted_(head_start.of) {
    make_back_end(head_start);
    std::vector<PieceStage*> stages;
    if (const auto& components = task_.surface.components) {
      check_components(*components);
      filter_.emplace(*components, extractor_->numbering(), task_.volume.path, sweep_.executor());
      stages.push_back(&*filter_);
    }
    sweep_.begin(*extractor_, std::move(stages), back_end_.get());
    saved_.emplace(control_, identity_, sweep_.layers(), sinks_, *this);
    saved_->load();
    sweep_.open();
  }

  // The report; or the head start of the run that has to take the place of this one.
  std::variant<MeshReport, HeadStart> run() {
    start_report();
    if (saved_->saves()) saved_->save();
    while (!sweep_.complete()) {
      saved_->stop_if_asked();
      step();
      if (!sweep_.complete()) saved_->save_if_due();
    }
    if (std::optional<HeadStart> next = back_end_->overshot()) {
      next->of = report_.triangles_extracted;
      return *next;
    }
    require_counted();
    finish_report();
    require_unchanged(task_, identity_);
    finish_sinks();
    report_.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

 private:
  void make_back_end(const HeadStart& head_start) {
    const Executor& executor = sweep_.executor();
    if (control_.device == Device::kCuda) {
      engine_ =
          make_cuda_engine({sweep_.field().info(), sweep_.field().rule(), task_.has_normals(), task_.simplify.zone});
      extractor_ = std::make_unique<DeviceExtractor>(*engine_);
      back_end_ =
          std::make_unique<DeviceBackEnd>(*engine_, task_.simplify, world_, *sinks_.back(), executor, control_.measure);
      return;
    }
    extractor_ = sweep_.make_extractor();
    // A zone that was left in the middle of a decision cannot be saved.
    const bool saves = !control_.checkpoint.folder.empty();
    back_end_ = std::make_unique<HostBackEnd>(task_.simplify, world_, sinks_, executor, control_,
                                              saves ? nullptr : control_.stop.get(), head_start);
  }

  void check_components(const ComponentChoice& components) const {
    const std::string expected = surface_text(task_.volume, task_.surface);
    if (components.surface == expected) return;
    throw std::invalid_argument("components: expected those of " + expected + ", found those of " + components.surface);
  }

  // Takes a step. A state is saved where reading fails between two slabs.
  void step() {
    try {
      sweep_.step();
    } catch (const Error&) {
      if (saved_->saves() && sweep_.pieces().failed_reading()) saved_->save();
      throw;
    }
  }

  void start_report() {
    report_.threads = sweep_.executor().threads();
    report_.slab = control_.slab;
    report_.device = control_.device == Device::kCuda ? Device::kCuda : Device::kCpu;
    if (control_.resume) report_.resumed_at = control_.resume->layer;
    report_errors(task_.simplify, report_);
    warn_of_space(task_, report_);
    warn_of_rounding(task_, report_);
    warn_of_values(task_, report_);
  }

  // Refuses a volume that has changed since its triangles were counted.
  void require_counted() const {
    if (counted_ == 0 || counted_ == report_.triangles_extracted) return;
    bad_input(task_.volume.path, std::to_string(counted_) + " triangles, as when they were counted",
              std::to_string(report_.triangles_extracted));
  }

  void finish_report() {
    sweep_.loop().wait_for_sinks();
    require_decided();
    sweep_.finish();
    finish_components();
    warn_of_border(task_, report_);
    judge_emptiness();
  }

  // A run that refuses its mesh is finished as well: there is nothing to be resumed.
  void judge_emptiness() {
    try {
      warn_of_nothing(task_, control_.allow_empty, report_);
    } catch (const EmptySurface&) {
      saved_->clear();
      for (MeshSink* sink : sinks_) sink->forget_marks();
      throw;
    }
  }

  // Refuses a state that leaves a surface which cannot be decided: no other run does.
  void require_decided() const {
    if (!control_.resume || sweep_.loop().undecided() == 0) return;
    bad_input(control_.resume->path, "a saved state of a surface that can be decided",
              std::to_string(sweep_.loop().undecided()) + " triangles that are left");
  }

  // Refuses components that were chosen in another surface: the volume may have changed, with the same name, size and
  // time.
  void finish_components() {
    if (!filter_) return;
    const ComponentChoice& choice = *task_.surface.components;
    report_.components_dropped = choice.components_dropped;
    report_.triangles_dropped = report_.triangles_extracted - filter_->triangles();
    const bool same = report_.triangles_dropped == choice.triangles_dropped &&
                      report_.triangles_extracted == choice.triangles + choice.triangles_dropped;
    if (!same) filter_->refuse();
  }

  void finish_sinks() {
    Stopwatch finishing;
    for (MeshSink* sink : sinks_) sink->finish();
    saved_->clear();
    for (MeshSink* sink : sinks_) sink->forget_marks();
    finishing.lap(report_.seconds_write);
  }

  std::int64_t layers_done() const override { return sweep_.layers_done(); }
  void wait_for_sinks() override { back_end_->wait_for_sinks(); }

  void write(StateWriter& writer) override {
    serialize(writer);
    const std::optional<std::uint32_t> crc = sweep_.pieces().crc_of_next_slice();
    writer.value(static_cast<std::uint32_t>(crc.has_value()));
    writer.value(crc.value_or(0));
  }

  void read(StateReader& reader) override {
    serialize(reader);
    std::uint32_t has_crc = 0;
    std::uint32_t crc = 0;
    reader.value(has_crc);
    reader.value(crc);
    reader.require_end();
    if (has_crc != 0) sweep_.pieces().expect_next_slice(crc, reader.path());
  }

  template <class Archive>
  void serialize(Archive& archive) {
    sweep_.pieces().serialize(archive);
    sweep_.loop().serialize(archive);
    archive.value(report_.cells_crossed);
    archive.value(report_.triangles_extracted);
    archive.value(report_.vertices_extracted);
    archive.value(report_.triangles);
    archive.list(report_.sweep);
  }

  const Task task_;
  const RunControl& control_;
  const RunIdentity identity_;  // when the run begins: a file may change meanwhile
  const std::vector<MeshSink*> sinks_;
  MeshReport report_;
  VolumeSweep sweep_;
  const World world_;
  const std::uint64_t counted_;  // triangles of the surface, where a run before has counted them; else 0
  std::unique_ptr<DeviceEngine> engine_;
  std::unique_ptr<Extractor> extractor_;
  std::optional<ComponentFilter> filter_;
  std::unique_ptr<BackEnd> back_end_;
  std::optional<SavedRun> saved_;
};

std::unique_ptr<SliceSource> open_again(const SliceSource& volume, const RunControl& control) {
  if (control.reopen) return control.reopen();
  return volume_in_memory(volume.info(), volume.held());
}

// Whether a run to a number has to count first: otherwise it would hold more than the cap allows.
bool has_to_count(const Forecast& forecast, const RunControl& control) {
  return forecast.least_bytes_at_once > 0 && control.memory < forecast.least_bytes_at_once + control.memory_elsewhere;
}

// The number of triangles that a share of all is, counted in a pass over the volume.
std::uint64_t count_number(const SliceSource& volume, const MeshOptions& options, const RunControl& control) {
  const TriangleGoal goal = goal_of(options);
  if (options.components != nullptr) return goal.of(options.components->triangles);
  RunControl silent;
  silent.threads = control.threads;
  silent.stop = control.stop;
  silent.index = control.index;
  return goal.of(count_triangles(*open_again(volume, control), options, silent));
}

// The head start of a run in one sweep. Without a cost that is decided at once, a run to a share would hold the whole
// surface until it knows the number: then this is counted before.
HeadStart at_once(HeadStart head_start, const SliceSource& volume, const MeshOptions& options,
                  const RunControl& control) {
  if (options.share > 0 && head_start.cost == kUnknownCost) head_start.number = count_number(volume, options, control);
  return head_start;
}

// The head start of a run to a number, by an error that is known or by a forecast.
HeadStart head_start_of(const SliceSource& volume, const MeshOptions& options, const RunControl& control) {
  if (control.resume || !can_repeat(volume, options, control)) return {};
  const VolumeInfo& info = volume.info();
  bool counts = control.count_first;
  std::optional<double> error = control.head_start;
  const bool is_large = options.share > 0 || info.slice_samples() * info.dims[2] >= kLargeVolume;
  if (!error && (control.memory > 0 || is_large)) {
    const Forecast forecast = forecast_mesh(*open_again(volume, control), options, control);
    error = forecast.head_start;
    counts = counts || (control.memory > 0 && has_to_count(forecast, control));
  }
  if (!counts) return at_once({head_start_cost(error.value_or(0), info)}, volume, options, control);
  // Counted is up to an error that is expected to leave fewer triangles. If it does not, the next one is larger.
  const double beyond = error.value_or(0) > 0 ? 2 * *error : mean_voxel(info.geometry) / 4;
  return HeadStart::counting(head_start_cost(beyond, info));
}

// Makes a run, again if need be. The sinks have got nothing yet.
std::variant<MeshReport, HeadStart> repeat(const SliceSource& volume, std::span<MeshSink* const> sinks,
                                           const MeshOptions& options, const RunControl& control,
                                           const HeadStart& head_start) {
  if (!can_repeat(volume, options, control)) {
    throw std::invalid_argument("resume: expected RunControl::reopen, as the saved run has a head start");
  }
  RunControl again = control;
  again.resume.reset();
  return VolumeRun(*open_again(volume, control), sinks, options, again, head_start).run();
}

// Counts, up to the cost of a head start, what a run to a number removes at each cost. No mesh is kept, so whatever
// does not change it is left out, unless the state of the run is saved.
std::variant<MeshReport, HeadStart> count(SliceSource& volume, std::span<MeshSink* const> sinks,
                                          const MeshOptions& options, const RunControl& control,
                                          const HeadStart& head_start) {
  MeshOptions bare = options;
  if (bare.normals == Normals::kGradient) bare.normals = Normals::kAbsent;
  bare.values.reset();
  RunControl unseen = control;
  unseen.measure = false;
  unseen.observer.reset();
  unseen.resume.reset();
  return VolumeRun(volume, sinks, bare, unseen, head_start).run();
}

}  // namespace

MeshReport mesh_volume(SliceSource& volume, MeshSink& sink, const MeshOptions& options, const RunControl& control) {
  MeshSink* const sinks[] = {&sink};
  return mesh_volume(volume, sinks, options, control);
}

MeshReport mesh_volume(SliceSource& volume, std::span<MeshSink* const> sinks, const MeshOptions& options,
                       const RunControl& control) {
  const StandardFloats floats;
  check_sinks(sinks, options.levels.size());
  Stopwatch total;
  const HeadStart head_start = head_start_of(volume, options, control);
  const bool counts_apart = control.checkpoint.folder.empty();
  std::variant<MeshReport, HeadStart> made = head_start.counts > 0 && counts_apart
                                                 ? count(volume, sinks, options, control, head_start)
                                                 : VolumeRun(volume, sinks, options, control, head_start).run();
  while (const HeadStart* const next = std::get_if<HeadStart>(&made)) {
    made = next->counts > 0 && counts_apart ? count(*open_again(volume, control), sinks, options, control, *next)
                                            : repeat(volume, sinks, options, control, *next);
  }
  MeshReport& report = std::get<MeshReport>(made);
  total.lap(report.seconds_total);
  return std::move(report);
}

}  // namespace isoweave
