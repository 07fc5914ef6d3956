// The same simplifier on a mesh that is there as a whole.
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "isoweave/pipeline.hpp"
#include "pipeline/final_output.hpp"
#include "pipeline/mesh_surface.hpp"
#include "pipeline/slab_plan.hpp"
#include "pipeline/sweep.hpp"
#include "simplify/count_target.hpp"

namespace isoweave {
namespace {

SimplifierOptions simplifier_options(const SimplifyOptions& options, const RunControl& control, double error, double a0,
                                     std::span<const double> levels) {
  const double side = std::sqrt(a0);
  SimplifierOptions simplify;
  simplify.zone = {EdgeNumbering{},
                   a0,
                   retire_cost(error, a0, options.triangles),
                   options.drop_specks,
                   most_distance(options.max_distance, side),
                   {side, side, side}};
  simplify.quality = options.quality;
  simplify.schedule = control.schedule;
  simplify.finer = level_costs(levels, a0);
  return simplify;
}

// Where distances are bounded, pieces would have to come in the order of their heights.
MeshSurface::Pieces pieces_of(const TriangleMesh& mesh, const SimplifyOptions& options) {
  if (options.max_distance.value > 0) return {.triangles = mesh.triangles.size(), .exactly = true};
  if (options.piece > 0) return {.triangles = options.piece, .exactly = true};
  return {.triangles = static_cast<std::uint64_t>(kSimplifiedSlab.triangles)};
}

// Triangles wanted of the next piece.
std::uint64_t next_piece(const Simplifier& simplifier) {
  return static_cast<std::uint64_t>(
      beside_zone(kSimplifiedSlab, static_cast<double>(simplifier.live_triangles())).triangles);
}

}  // namespace

MeshReport simplify_mesh(const TriangleMesh& mesh, MeshSink& sink, const SimplifyOptions& options,
                         const RunControl& control) {
  MeshSink* const sinks[] = {&sink};
  return simplify_mesh(mesh, sinks, options, control);
}

MeshReport simplify_mesh(const TriangleMesh& mesh, std::span<MeshSink* const> sinks, const SimplifyOptions& options,
                         const RunControl& control) {
  check_sinks(sinks.size(), options.levels.size());
  if (control.device == Device::kCuda) {
    throw std::invalid_argument("a CUDA device: expected a volume, found a mesh, which takes processors");
  }
  Stopwatch total;
  Stopwatch clock;
  MeshReport report;
  const Executor executor(control.threads);
  const double mean_area = mean_triangle_area(mesh, executor);
  const double a0 = mean_area > 0 ? 2 * mean_area : 1;
  const double side = std::sqrt(a0);
  report.threads = executor.threads();
  report.error = options.error.value * (options.error.voxels ? side : 1);
  report.triangles_extracted = mesh.triangles.size();
  report.vertices_extracted = mesh.vertices.size();
  const std::vector<double> errors = level_errors(options.levels, report.error, side, options.triangles);
  Simplifier simplifier(simplifier_options(options, control, report.error, a0, errors), executor, control.stop);
  report.schedule = simplifier.schedule();
  std::optional<CountTarget> target;
  if (options.triangles > 0) target.emplace(simplifier, executor, options.triangles);
  const World world;
  std::vector<std::unique_ptr<FinalOutput>> outputs;
  for (std::size_t level = 0; level < sinks.size(); ++level) {
    outputs.push_back(std::make_unique<FinalOutput>(world, *sinks[level], executor, control.measure, level));
  }

  MeshSurface surface(mesh, executor, pieces_of(mesh, options));
  SurfacePiece piece;
  do {
    surface.take(next_piece(simplifier), piece);
    simplifier.append(piece);
    for (std::size_t level = 0; level < sinks.size(); ++level) {
      simplifier.decide(level);
      if (target) surface.complete() ? target->finish() : target->thin_out();
      clock.lap(report.seconds_simplify);
      outputs[level]->take(simplifier);
      clock.lap(report.seconds_write);
    }
  } while (!surface.complete());

  if (surface.dropped() > 0) {
    report.warnings.push_back(std::to_string(surface.dropped()) + " triangles that repeat a vertex are left out");
  }
  report.locked_vertices = simplifier.zone().locked;
  if (report.locked_vertices > 0) {
    report.warnings.push_back(std::to_string(report.locked_vertices) +
                              " vertices are not on an oriented manifold and stay where they are");
  }
  report_simplifier(simplifier, report);
  report.levels.resize(errors.size());
  for (std::size_t level = 0; level < sinks.size(); ++level) {
    const bool last = simplifier.is_last(level);
    SurfaceReport& of_level = last ? report : report.levels[level];
    if (!last) of_level.error = errors[level];
    outputs[level]->wait();
    outputs[level]->report(of_level);
    report_defects(simplifier.defects(level), of_level);
    outputs[level]->report_locked(of_level);
  }
  if (target) report_target(*target, options.triangles, side, report);
  for (MeshSink* sink : sinks) sink->finish();
  clock.lap(report.seconds_write);
  total.lap(report.seconds_total);
  report.peak_bytes = peak_process_bytes();
  return report;
}

}  // namespace isoweave
