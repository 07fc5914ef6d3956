// The one loop: read a slab, extract it, simplify what is safe, write what is final.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <string>

#include "device/cuda_engine.hpp"
#include "isoweave/error.hpp"
#include "isoweave/pipeline.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/checkpoint.hpp"
#include "pipeline/component_slabs.hpp"
#include "pipeline/device_slabs.hpp"
#include "pipeline/host_slabs.hpp"
#include "pipeline/memory_cap.hpp"
#include "pipeline/memory_model.hpp"
#include "pipeline/slab_plan.hpp"
#include "pipeline/surface_field.hpp"
#include "pipeline/sweep.hpp"
#include "system/process_memory.hpp"
#include "volume/row_source.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

class NoSink final : public MeshSink {
 public:
  void append(const MeshPiece&) override {}
  void finish() override {}
};

class VolumeSweep {
 public:
  // finder: gets the surface, if it is not null, instead of the sinks.
  VolumeSweep(SliceSource& source, std::span<MeshSink* const> sinks, const MeshOptions& options,
              const RunControl& control, ComponentFinder* finder = nullptr)
      : volume_(checked_volume(source.info())),
        options_(options),
        control_(control),
        offset_(common_offset(sinks)),
        reader_(held_by_slices(source)),
        executor_(control.threads),
        field_(source, options, executor_, control.measure),
        voxel_(mean_voxel(volume_.geometry)),
        world_(volume_.geometry, options.space, offset_),
        simplifies_(simplifies(volume_, options)),
        level_errors_(level_errors(options.levels, error(), voxel_, options.triangles)),
        sinks_(sinks.begin(), sinks.end()),
        engine_(make_engine(finder)),
        layers_(engine_->layers_left()) {
    find_constant(source);
    if (saves()) open_folder();
    if (control.resume != nullptr) load_state();
    window_.emplace(field_.source(), engine_->slices_for(1).first);
    if (options.values != nullptr) values_window_.emplace(*options.values, engine_->slices_for(1).first);
  }

  MeshReport run() {
    Stopwatch total;
    start_report();
    check_values();
    if (saves()) save_state();
    while (!all_outside_ && engine_->layers_left() > 0) {
      stop_if_asked();
      sweep_slab();
      if (state_is_due()) save_state();
    }
    finish_report();
    require_unchanged(volume_, options_, identity_);
    Stopwatch finishing;
    engine_->wait_for_sink();
    for (MeshSink* sink : sinks_) sink->finish();
    if (saves()) folder_->clear();
    for (MeshSink* sink : sinks_) sink->forget_marks();
    finishing.lap(report_.seconds_write);
    total.lap(report_.seconds_total);
    report_.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

 private:
  // A volume of values has a sample wherever the other one has.
  void check_values() {
    if (options_.values == nullptr) return;
    const VolumeInfo& values = options_.values->info();
    const auto size = [](const VolumeInfo& volume) {
      return std::to_string(volume.dims[0]) + " x " + std::to_string(volume.dims[1]) + " x " +
             std::to_string(volume.dims[2]);
    };
    if (values.dims != volume_.dims) {
      throw BadInput(values.path + ": expected " + size(volume_) + " samples as in " + volume_.path + ", found " +
                     size(values));
    }
    const Geometry& a = values.geometry;
    const Geometry& b = volume_.geometry;
    if (a.spacing == b.spacing && a.origin == b.origin && a.direction == b.direction) return;
    report_.warnings.push_back(values.path + ": lies elsewhere than " + volume_.path +
                               " by its spacing, origin or axes; sample by sample it is taken for the same place");
  }

  // A volume of one value that is outside has no surface, and may declare more samples than anyone can look at.
  void find_constant(const SliceSource& source) {
    const std::optional<SampleBytes> sample = constant_sample(source);
    if (!sample || is_inside(*sample, volume_.type, stored_rule(volume_, options_))) return;
    all_outside_ = true;
    range_ = sample_range(sample->data(), volume_.type, 1);
    range_.nan *= static_cast<std::uint64_t>(volume_.slice_samples() * volume_.dims[2]);
  }

  bool normals() const { return options_.normals != Normals::kAbsent; }

  double error() const { return length_in(volume_, options_.error); }

  std::unique_ptr<SlabEngine> make_engine(ComponentFinder* finder) const {
    check_components();
    if (finder != nullptr) {
      return std::make_unique<ComponentSlabs>(field_.info(), field_.rule(), *finder, executor_);
    }
    if (control_.device == Device::kCuda) {
      check_device_options();
      return std::make_unique<DeviceSlabs>(
          make_cuda_engine({field_.info(), field_.rule(), normals(), zone_options(volume_, options_)}), normals(),
          world_, *sinks_.back(), executor_, control_.measure);
    }
    const HostSlabs::Options host = host_options(volume_, field_.rule(), options_, control_);
    // A zone that has been left in the middle cannot be saved.
    return std::make_unique<HostSlabs>(field_.info(), host, world_, sinks_, executor_,
                                       saves() ? nullptr : control_.stop);
  }

  void check_components() const {
    if (options_.components == nullptr) return;
    const std::string expected = surface_text(volume_, options_);
    const std::string& found = options_.components->surface;
    if (found != expected)
      throw std::invalid_argument("components: expected those of " + expected + ", found those of " + found);
  }

  // What there is on processors only.
  void check_device_options() const {
    const auto refuse = [](const std::string& what) {
      throw std::invalid_argument("a CUDA device: expected a run without " + what + ", which takes processors");
    };
    if (options_.triangles > 0) refuse("a number of triangles to stop at");
    if (!options_.levels.empty()) refuse("levels");
    if (options_.max_distance.value > 0) refuse("a guaranteed distance");
    if (options_.components != nullptr) refuse("components to be dropped");
    if (options_.normals == Normals::kQuadric) refuse("normals by quadrics");
    if (options_.values != nullptr) refuse("values of another volume");
    const SampleType type = field_.info().type;
    if (type == SampleType::kUint64 || type == SampleType::kInt64) refuse("integers of 64 bits");
    if (saves() || control_.resume != nullptr) refuse("states to be saved or resumed");
    if (control_.observer != nullptr) refuse("an observer");
    if (control_.schedule != Schedule::kAutomatic && control_.schedule != Schedule::kRounds) {
      refuse("a schedule other than rounds");
    }
  }

  void start_report() {
    report_.threads = executor_.threads();
    report_.slab = options_.slab;
    report_.device = control_.device == Device::kCuda ? Device::kCuda : Device::kCpu;
    report_.error = error();
    report_.levels.resize(level_errors_.size());
    for (std::size_t n = 0; n < level_errors_.size(); ++n) report_.levels[n].error = level_errors_[n];
    warn_of_space(volume_, options_, report_);
    warn_of_rounding(volume_, options_, offset_, report_);
  }

  // What the next slab may be: layers, going by the one before and by the memory there is, slices to be read ahead, and
  // vertices that it may turn out to hold.
  struct SlabPlan {
    std::int64_t layers = 0;
    std::int64_t ahead = 0;
    std::uint64_t most_vertices = 0;
  };

  SlabPlan next_slab() {
    const auto recent = static_cast<double>(std::max<std::int64_t>(recent_layers_, 1));
    const double per_layer = static_cast<double>(recent_triangles_) / recent;
    const auto held = static_cast<double>(engine_->held_triangles());
    const SlabGoal goal = beside_zone(slab_goal(simplifies_, report_.device == Device::kCuda), held);
    SlabPlan plan;
    plan.layers = std::min(isoweave::next_slab(field_.info(), goal, options_.slab, recent_layers_, per_layer),
                           engine_->most_layers());
    plan.ahead = slices_ahead(field_.info(), goal, plan.layers);
    plan.most_vertices = options_.slab > 0 ? ~std::uint64_t{0} : goal.most_vertices;
    plan.most_vertices = std::min(plan.most_vertices, engine_->room_for_vertices(control_.memory));
    if (control_.memory > 0) fit_into_cap(plan, per_layer);
    return plan;
  }

  MemoryModel memory_model(double heavier) const {
    return {resident_ + control_.memory_elsewhere + reader_ + SurfaceField::memory(volume_, options_) +
                engine_->other_bytes(),
            field_.info().slice_bytes(),
            static_cast<std::uint64_t>(volume_.slice_samples()),
            executor_.threads(),
            simplifies_,
            vertex_extras(options_),
            level_errors_.size(),
            options_.max_distance.value > 0,
            heavier};
  }

  // The formula is a fit: surfaces with more vertices, or more of what is kept beside triangles, take more.
  void weigh_zone(const SlabRecord& record) {
    constexpr std::uint64_t kEnough = 20'000;  // triangles; what does not grow hardly counts then
    if (control_.memory == 0 || record.live_triangles < kEnough) return;
    const double expected = memory_model(1).zone(static_cast<double>(record.live_triangles));
    if (expected > 0) heavier_ = std::max(heavier_, static_cast<double>(engine_->zone_bytes()) / expected);
  }

  // Thinner slabs, and fewer slices read ahead. Throws OverMemory when there is no room for one layer.
  void fit_into_cap(SlabPlan& plan, double per_layer) {
    const MemoryModel model = memory_model(heavier_);
    const auto undecided = static_cast<double>(engine_->held_triangles());
    const auto cap = static_cast<double>(control_.memory);
    const auto room = [&](double part) {
      const auto layers = static_cast<double>(plan.layers);
      const double ring = MemoryModel::ring_for(layers, static_cast<double>(plan.ahead), normals());
      return model.triangles_within(part * cap, layers, std::max(ring, static_cast<double>(window_->room())),
                                    undecided);
    };
    // The ring never shrinks: what thick slabs of few triangles would make of it is missing where there are more.
    const auto thick = [&] {
      const auto more = static_cast<double>(plan.layers + plan.ahead - 2);  // slices
      return more * static_cast<double>(field_.info().slice_bytes()) > kRingPart * cap;
    };
    while (plan.layers > 1 && (thick() || room(kUsedPart) < per_layer * static_cast<double>(plan.layers))) {
      plan.layers = (plan.layers + 1) / 2;
      plan.ahead = std::min(plan.ahead, plan.layers);
    }
    // A single layer may take more of the cap than slabs are planned for, unless a number of triangles holds much.
    const double left = room(plan.layers > 1 || options_.triangles > 0 ? kUsedPart : kLastPart);
    if (left < per_layer || left <= 0) refuse_layer(model, per_layer, undecided);
    plan.most_vertices = std::min(plan.most_vertices, static_cast<std::uint64_t>(left / 2));
  }

  [[noreturn]] void refuse_layer(const MemoryModel& model, double per_layer, double undecided) {
    const auto needed = static_cast<std::uint64_t>(
        model.peak(1, static_cast<double>(window_->room()), per_layer, undecided) / kUsedPart * kNamedMargin);
    const std::string where = volume_.path + ": layer " + std::to_string(layers_ - engine_->layers_left() + 1) +
                              " of " + std::to_string(layers_);
    if (!saves()) refuse_cap(where, needed, control_.memory);
    save_state();
    refuse_cap(where, needed, control_.memory, "; the run can be resumed from " + control_.checkpoint.folder);
  }

  void read_slab(const SlabPlan& plan) {
    const auto [first, end] = engine_->slices_for(plan.layers);
    std::int64_t read = 0;
    try {
      read = window_->advance(first, end, plan.ahead);
      if (values_window_) values_window_->advance(first, end, plan.ahead);
    } catch (const BadInput&) {
      if (saves()) save_state();
      throw;
    }
    if (resumed_crc_) check_resumed_slice();
    voxels_ += static_cast<std::uint64_t>(read * volume_.slice_samples());
    if (control_.measure) measure_samples(read);
    clock_.lap(report_.seconds_read);
  }

  void sweep_slab() {
    if (plan_.layers == 0) plan_and_read();
    const std::uint64_t before = report_.triangles_extracted;
    recent_layers_ = engine_->extract(*window_, plan_.layers, plan_.most_vertices, report_);
    recent_triangles_ = report_.triangles_extracted - before;
    if (values_window_) engine_->take_values(*values_window_);
    plan_ = {};
    clock_.lap(report_.seconds_extract);
    SlabRecord record;
    record.layer = layers_ - engine_->layers_left();
    record.bytes = window_->bytes() + (values_window_ ? values_window_->bytes() : 0);
    if (engine_->takes_slices_early() && engine_->layers_left() > 0) {
      plan_and_read();
      engine_->take_slices(*window_, plan_.layers);
    }
    engine_->simplify(record);
    weigh_zone(record);
    clock_.lap(report_.seconds_simplify);
    engine_->write(record, report_);
    clock_.lap(report_.seconds_write);
    record.final_triangles = report_.triangles;
    report_.sweep.push_back(record);
    tell(record);
  }

  void tell(const SlabRecord& record) {
    const Progress progress{record.layer,           layers_,     voxels_, record.live_triangles,
                            record.final_triangles, record.bytes};
    if (control_.progress) control_.progress(progress);
    if (control_.observer == nullptr) return;
    control_.observer->end_slab(progress, record,
                                [&](const SweepObserver::Visitor& visitor) { engine_->view_undecided(visitor); });
  }

  void plan_and_read() {
    plan_ = next_slab();
    read_slab(plan_);
  }

  // Range of the slices just read, the last ones in the window.
  void measure_samples(std::int64_t slices) {
    std::vector<SampleRange> ranges(static_cast<std::size_t>(slices));
    executor_.for_each(slices, 1, [&](std::int64_t n) {
      const std::int64_t k = window_->end() - slices + n;
      const SampleRange* const known = field_.range(k);
      ranges[static_cast<std::size_t>(n)] =
          known != nullptr ? *known : sample_range(window_->slice(k), volume_.type, volume_.slice_samples());
    });
    for (const SampleRange& range : ranges) range_.merge(range);
  }

  void finish_report() {
    engine_->finish(report_);
    finish_components();
    const double low = volume_.slope * range_.min + volume_.intercept;
    const double high = volume_.slope * range_.max + volume_.intercept;
    report_.min = volume_.slope > 0 || range_.empty() ? low : high;
    report_.max = volume_.slope > 0 || range_.empty() ? high : low;
    report_.nan = range_.nan;
    if (range_.nan > 0) {
      report_.warnings.push_back(volume_.path + ": " + std::to_string(range_.nan) +
                                 " samples are NaN and count as outside");
    }
    if (report_.triangles > 0) return;
    if (report_.components_dropped > 0) {
      report_.warnings.push_back(volume_.path + ": nothing is left: each of " +
                                 std::to_string(report_.components_dropped) + " components has fewer than " +
                                 std::to_string(options_.components->rule.min_triangles) + " triangles");
      return;
    }
    report_.warnings.push_back(
        volume_.path + ": the surface is empty: iso " + std::to_string(options_.iso) +
        (range_.empty() ? ", no samples are numbers"
                        : ", samples from " + std::to_string(report_.min) + " to " + std::to_string(report_.max)));
  }

  // A volume that is another one than when components were chosen may have the same name, size and time.
  void finish_components() {
    if (options_.components == nullptr) return;
    const ComponentChoice& choice = *options_.components;
    report_.components_dropped = choice.components_dropped;
    const bool same = report_.triangles_dropped == choice.triangles_dropped &&
                      report_.triangles_extracted == choice.triangles + choice.triangles_dropped;
    if (!same) refuse_components(volume_.path);
  }

  bool saves() const { return !control_.checkpoint.folder.empty(); }

  void open_folder() {
    const CheckpointOptions& options = control_.checkpoint;
    if (options.lock == nullptr) lock_.emplace(options.folder);
    folder_.emplace(options.folder);
  }

  void stop_if_asked() {
    if (!saves()) return check_stop(control_);
    if (control_.stop == nullptr || !control_.stop->load()) return;
    save_state();
    throw Interrupted("interrupted; the run can be resumed from " + control_.checkpoint.folder);
  }

  bool state_is_due() const {
    if (!saves() || engine_->layers_left() == 0) return false;
    const CheckpointOptions& options = control_.checkpoint;
    if (options.layers > 0) return layers_ - engine_->layers_left() - saved_layer_ >= options.layers;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - saved_time_).count() >= options.seconds;
  }

  // What the sink has is made durable first: the state must not know more than the mesh has.
  void save_state() {
    Checkpoint checkpoint;
    checkpoint.layers = layers_;
    checkpoint.layer = layers_ - engine_->layers_left();
    if (checkpoint.layer == saved_layer_) return;
    checkpoint.note = control_.checkpoint.note;
    engine_->wait_for_sink();
    for (MeshSink* sink : sinks_) checkpoint.marks.push_back(sink->mark());
    const std::unique_ptr<StateWriter> writer = folder_->begin_state(checkpoint, identity_);
    exchange(*writer);
    const std::optional<std::uint32_t> crc = crc_of_next_slice();
    writer->value(crc.has_value());
    writer->value(crc.value_or(0));
    writer->commit();
    saved_layer_ = checkpoint.layer;
    saved_time_ = std::chrono::steady_clock::now();
  }

  void load_state() {
    StateReader reader = open_state(*control_.resume, identity_);
    exchange(reader);
    bool has_crc = false;
    std::uint32_t crc = 0;
    reader.value(has_crc);
    reader.value(crc);
    if (has_crc) resumed_crc_ = crc;
    saved_layer_ = control_.resume->layer;
    report_.resumed_at = control_.resume->layer;
  }

  template <class Archive>
  void exchange(Archive& archive) {
    engine_->exchange(archive);
    archive.value(range_);
    archive.value(recent_layers_);
    archive.value(recent_triangles_);
    archive.value(voxels_);
    archive.value(report_.cells_crossed);
    archive.value(report_.triangles_extracted);
    archive.value(report_.vertices_extracted);
    archive.value(report_.triangles);
    archive.list(report_.sweep);
  }

  // The first slice that the next slab needs, if the window holds it: its checksum, or nothing.
  std::optional<std::uint32_t> crc_of_next_slice() const {
    const std::int64_t k = std::max<std::int64_t>(engine_->slices_for(1).first, 0);
    if (!window_ || k >= window_->end()) return std::nullopt;
    return add_to_crc(0, {window_->slice(k), field_.info().slice_bytes()});
  }

  // The slice where the sweep was cut off must be the same as then.
  void check_resumed_slice() {
    const bool same = !resumed_crc_ || resumed_crc_ == crc_of_next_slice();
    resumed_crc_.reset();
    if (same) return;
    throw BadInput(volume_.path + ": the volume has changed: expected the samples that " + control_.resume->path +
                   " was saved with, found others");
  }

  const VolumeInfo volume_;
  const MeshOptions& options_;
  const RunControl& control_;
  const std::array<double, 3> offset_;  // of the sinks
  const RunIdentity identity_ =
      identity_of(volume_, options_, offset_, control_.measure);  // when the run begins: a file may change meanwhile
  const std::uint64_t resident_ = control_.memory > 0 ? system::resident_bytes() : 0;
  const std::uint64_t reader_;  // bytes that the source may hold
  const Executor executor_;
  SurfaceField field_;
  double voxel_;  // mean side of a voxel
  World world_;
  bool simplifies_;
  const std::vector<double> level_errors_;
  const std::vector<MeshSink*> sinks_;
  std::unique_ptr<SlabEngine> engine_;
  std::optional<SliceWindow> window_;
  std::optional<SliceWindow> values_window_;
  double heavier_ = 1;  // MemoryModel's
  SlabPlan plan_;       // of the slices that have been read; no layers: of none
  SampleRange range_;
  bool all_outside_ = false;  // as is known without reading a sample
  MeshReport report_;
  Stopwatch clock_;
  std::int64_t layers_;
  std::int64_t recent_layers_ = 0;
  std::uint64_t recent_triangles_ = 0;
  std::uint64_t voxels_ = 0;

  std::optional<CheckpointLock> lock_;  // where the caller holds none
  std::optional<CheckpointFolder> folder_;
  std::int64_t saved_layer_ = -1;
  std::chrono::steady_clock::time_point saved_time_ = std::chrono::steady_clock::now();
  std::optional<std::uint32_t> resumed_crc_;  // of the next slice when the state was saved
};

}  // namespace

ComponentChoice choose_components(SliceSource& volume, const MeshOptions& options, const ComponentRule& rule,
                                  const RunControl& control) {
  const StandardFloats floats;
  if (control.device == Device::kCuda) {
    throw std::invalid_argument(
        "a CUDA device: expected a run without components to be dropped, which takes processors");
  }
  MeshOptions full;
  full.iso = options.iso;
  full.inside_above = options.inside_above;
  full.closed = options.closed;
  full.slab = options.slab;
  full.error = {0, false};
  RunControl finding = control;
  finding.measure = false;
  finding.checkpoint = {};
  finding.resume = nullptr;
  finding.observer = nullptr;
  const Executor executor(control.threads);
  ComponentFinder finder(Lattice{volume.info().dims}, executor);
  NoSink sink;
  MeshSink* const sinks[] = {&sink};
  VolumeSweep(volume, sinks, full, finding, &finder).run();
  ComponentChoice choice = finder.choose(rule);
  choice.surface = surface_text(volume.info(), full);
  return choice;
}

std::uint64_t count_triangles(SliceSource& volume, const MeshOptions& options, const RunControl& control) {
  MeshOptions full = options;
  full.error = {0, false};
  full.triangles = 0;
  full.levels.clear();
  full.normals = Normals::kAbsent;
  full.values = nullptr;
  full.smooth = 0;  // it has as many
  RunControl counting = control;
  counting.measure = false;
  counting.checkpoint = {};
  counting.resume = nullptr;
  counting.observer = nullptr;
  NoSink sink;
  return mesh_volume(volume, sink, full, counting).triangles;
}

MeshReport mesh_volume(SliceSource& volume, MeshSink& sink, const MeshOptions& options, const RunControl& control) {
  MeshSink* const sinks[] = {&sink};
  return mesh_volume(volume, sinks, options, control);
}

MeshReport mesh_volume(SliceSource& volume, std::span<MeshSink* const> sinks, const MeshOptions& options,
                       const RunControl& control) {
  const StandardFloats floats;
  check_sinks(sinks, options.levels.size());
  return VolumeSweep(volume, sinks, options, control).run();
}

}  // namespace isoweave
