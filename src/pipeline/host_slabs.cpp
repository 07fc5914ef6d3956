#include "pipeline/host_slabs.hpp"

#include "extract/values.hpp"
#include "output/sweep_view.hpp"
#include "pipeline/sweep.hpp"

namespace isoweave {

HostSlabs::HostSlabs(const VolumeInfo& volume, const Options& options, const World& world,
                     std::span<MeshSink* const> sinks, const Executor& executor, const std::atomic<bool>* stop)
    : path_(volume.path),
      options_(options),
      world_(world),
      executor_(executor),
      lattice_{volume.dims},
      spacing_(volume.geometry.spacing),
      extractor_(volume, options.extract, executor),
      simplifier_(options.simplify, executor, stop),
      full_output_(world, *sinks.back(), executor, options.measure, options.observer) {
  for (std::size_t level = 0; level < simplifier_.levels(); ++level) {
    SweepObserver* const observer = simplifier_.is_last(level) ? options.observer : nullptr;
    outputs_.push_back(std::make_unique<FinalOutput>(world, *sinks[level], executor, options.measure, level, observer));
  }
  if (options.components != nullptr) filter_.emplace(*options.components, Lattice{volume.dims}, executor);
  if (options.triangles > 0) target_.emplace(simplifier_, executor, options.triangles);
}

std::int64_t HostSlabs::extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                                MeshReport& report) {
  const std::int64_t extracted = extractor_.extract(window, layers, piece_, most_vertices);
  report.cells_crossed += piece_.cells_crossed;
  report.triangles_extracted += piece_.triangles.size();
  report.vertices_extracted += piece_.positions.size();
  if (filter_ && !filter_->apply(piece_)) refuse_components(path_);
  return extracted;
}

void HostSlabs::take_values(const SliceWindow& window) { sample_values(window, lattice_, spacing_, executor_, piece_); }

void HostSlabs::simplify(SlabRecord& record) {
  record.live_triangles = piece_.triangles.size();
  if (!options_.simplifies) return;
  simplifier_.append(piece_);
  record.live_triangles = simplifier_.live_triangles();
  zone_bytes_ = simplifier_.zone().bytes();
  record.bytes += zone_bytes_;
  for (std::size_t level = 0; !simplifier_.is_last(level); ++level) {
    simplifier_.decide(level);
    outputs_[level]->take(simplifier_);
  }
  simplifier_.decide(simplifier_.levels() - 1);
  if (target_) layers_left() > 0 ? target_->thin_out() : target_->finish();
}

void HostSlabs::write(SlabRecord& record, MeshReport& report) {
  if (options_.simplifies) {
    outputs_.back()->take(simplifier_);
    outputs_.back()->report(report);
    record.undecided_triangles = simplifier_.live_triangles();
  } else {
    full_output_.take(piece_);
    full_output_.report(report);
  }
}

void HostSlabs::view_undecided(const SweepObserver::Visitor& visitor) const {
  if (options_.simplifies) view_zone(simplifier_.zone(), world_, executor_, visitor);
}

void HostSlabs::wait_for_sink() {
  for (const auto& output : outputs_) output->wait();
  full_output_.wait();
}

void HostSlabs::finish(MeshReport& report) const {
  report.schedule = simplifier_.schedule();
  if (filter_) report.triangles_dropped = report.triangles_extracted - filter_->triangles();
  report_simplifier(simplifier_, report);
  for (std::size_t level = 0; !simplifier_.is_last(level); ++level) {
    outputs_[level]->report(report.levels[level]);
    report_defects(simplifier_.defects(level), report.levels[level]);
  }
  if (target_) report_target(simplifier_, options_.triangles, options_.voxel, options_.unit, report);
}

HostSlabs::Options host_options(const VolumeInfo& volume, const IsoRule& rule, const MeshOptions& options,
                                const RunControl& control) {
  const double voxel = mean_voxel(volume.geometry);
  const std::vector<double> levels =
      level_errors(options.levels, length_in(volume, options.error), voxel, options.triangles);
  HostSlabs::Options host;
  host.extract = {rule, options.normals != Normals::kAbsent};
  host.simplify = {zone_options(volume, options), control.schedule, level_costs(levels, voxel * voxel),
                   control.measure};
  host.simplifies = simplifies(volume, options);
  host.triangles = options.triangles;
  host.voxel = voxel;
  host.unit = volume.geometry.unit;
  host.components = options.components;
  host.measure = control.measure;
  host.observer = control.observer;
  return host;
}

}  // namespace isoweave
