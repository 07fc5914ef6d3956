// Several iso-values in one sweep: one window of slices, and an extractor and a back end for each value.
#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "files/header_text.hpp"
#include "isoweave/pipeline.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"
#include "pipeline/strands.hpp"
#include "pipeline/surface_field.hpp"
#include "system/process_memory.hpp"
#include "volume/row_source.hpp"
#include "volume/window_volume.hpp"

namespace isoweave {
namespace {

void check_values(std::span<const IsoSink> surfaces) {
  if (surfaces.empty()) throw std::invalid_argument("iso-values: expected one or more, found none");
  for (const IsoSink& surface : surfaces) {
    if (std::ranges::count(surfaces, surface.iso, &IsoSink::iso) <= 1) continue;
    throw std::invalid_argument("iso-values: expected each once, found " + number_text(surface.iso) + " twice");
  }
}

std::vector<Task> tasks_of(const VolumeInfo& volume, std::span<const IsoSink> surfaces, const MeshOptions& options,
                           const RunControl& control) {
  std::vector<MeshSink*> sinks;
  for (const IsoSink& surface : surfaces) sinks.push_back(surface.sink);
  require_different(sinks);
  std::vector<Task> tasks;
  for (const IsoSink& surface : surfaces) {
    MeshOptions of_surface = options;
    of_surface.iso = surface.iso;
    tasks.push_back(resolve(volume, of_surface, control, common_offset(sinks), RunKind::kIsoValues));
  }
  return tasks;
}

class IsoSweep final : public StrandGuide {
 public:
  IsoSweep(SliceSource& volume, std::span<const IsoSink> surfaces, const MeshOptions& options,
           const RunControl& control)
      : tasks_(tasks_of(volume.info(), surfaces, options, control)),
        task_(tasks_.front()),
        control_(control),
        surfaces_(surfaces),
        constant_(constant_sample(volume)),
        field_(SurfaceField::info_of(task_.volume, task_.surface)),
        sweep_(volume, task_, control_, *this, report_.total) {
    for (std::size_t n = 0; n < surfaces_.size(); ++n) {
      StrandState& state = sweep_.strands().emplace_back();
      state.end = task_.volume.dims[2];
      state.large = true;
    }
  }

  IsoValuesReport run() {
    Stopwatch total;
    all_outside() ? sweep_.skip(*constant_) : sweep_.run();
    finish_surfaces();
    total.lap(report_.total.seconds_total);
    report_.total.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

  std::unique_ptr<Strand> begin(std::size_t n, const SliceWindow& window, const Executor& executor) const override {
    StrandSource source{std::make_unique<WindowVolume>(window), 0, {}, &window};
    return std::make_unique<Strand>(std::move(source), *surfaces_[n].sink, tasks_[n], control_, executor);
  }

  // Every surface is worked on by all threads, one after the other, so a slab is as thick as the fullest of them would
  // have it by itself.
  NextSlices next(std::int64_t done) const override {
    const SlabGoal& goal = slab_goal(task_.simplify.needed);
    std::int64_t layers = task_.volume.dims[2] - done;
    for (const StrandState& state : sweep_.strands()) layers = std::min(layers, layers_for(state, goal));
    return {first_kept(done), layers, slices_ahead(field_, goal, layers)};
  }

 private:
  // Whether the volume is known, without reading it, to have no surface: it may declare more samples than anyone can
  // look at.
  bool all_outside() const {
    return constant_ && std::ranges::none_of(tasks_, [&](const Task& task) {
             return is_inside(*constant_, task.volume.type, task.rule);
           });
  }

  std::int64_t layers_for(const StrandState& state, const SlabGoal& goal) const {
    const std::int64_t recent = sweep_.recent_layers();
    const double per_layer =
        static_cast<double>(state.recent_triangles) / static_cast<double>(std::max<std::int64_t>(recent, 1));
    return next_slab(field_, beside_zone(goal, static_cast<double>(state.undecided)), control_.slab, recent, per_layer);
  }

  std::int64_t first_kept(std::int64_t done) const {
    if (task_.surface.smooth > 0) return done - slices_kept(task_.surface);
    std::int64_t first = done;
    for (const StrandState& state : sweep_.strands()) {
      if (state.strand != nullptr) first = std::min(first, state.strand->first_needed());
    }
    return first;
  }

  void finish_surfaces() {
    sweep_.add_up();
    report_samples(task_.volume, sweep_.range(), report_.total);
    for (StrandState& state : sweep_.strands()) {
      const std::size_t n = report_.meshes.size();
      MeshReport& mesh = report_.meshes.emplace_back(std::move(state.report));
      mesh.min = report_.total.min;
      mesh.max = report_.total.max;
      mesh.nan = report_.total.nan;
      warn_of_border(tasks_[n], mesh);
      warn_of_nothing(tasks_[n], control_.allow_empty, mesh);
    }
    for (const IsoSink& surface : surfaces_) surface.sink->finish();
  }

  const std::vector<Task> tasks_;  // of the values, in their order
  const Task& task_;               // the first one, for all that does not depend on the value
  const RunControl& control_;
  const std::span<const IsoSink> surfaces_;
  const std::optional<SampleBytes> constant_;
  const VolumeInfo field_;
  IsoValuesReport report_;
  StrandsSweep sweep_;
};

}  // namespace

IsoValuesReport mesh_iso_values(SliceSource& volume, std::span<const IsoSink> surfaces, const MeshOptions& options,
                                const RunControl& control) {
  const StandardFloats floats;
  check_values(surfaces);
  return IsoSweep(volume, surfaces, options, control).run();
}

}  // namespace isoweave
