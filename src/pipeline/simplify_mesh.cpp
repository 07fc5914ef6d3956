// The same simplifier on a mesh that is there as a whole.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "isoweave/pipeline.hpp"
#include "output/final_output.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/mesh_surface.hpp"
#include "pipeline/slab_plan.hpp"
#include "pipeline/sweep.hpp"
#include "simplify/count_target.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

// What takes the place of the mean voxel face.
double mean_face(const TriangleMesh& mesh, const Executor& executor) {
  const double area = mean_triangle_area(mesh, executor);
  return area > 0 ? 2 * area : 1;
}

// Lengths of a box that no triangle of the mesh exceeds.
Vec3 largest_triangle(const TriangleMesh& mesh) {
  std::array<double, 3> largest{};
  for (const auto& t : mesh.triangles) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto at = [&](std::size_t corner) { return mesh.vertices[t[corner]][axis]; };
      const auto [low, high] = std::minmax({at(0), at(1), at(2)});
      largest[axis] = std::max(largest[axis], double{high} - double{low});
    }
  }
  return {largest[0], largest[1], largest[2]};
}

SimplifierOptions simplifier_options(const SimplifyOptions& options, const RunControl& control, double error, double a0,
                                     std::span<const double> levels, const Vec3& largest) {
  const double side = std::sqrt(a0);
  SimplifierOptions simplify;
  simplify.zone = {EdgeNumbering{},
                   a0,
                   retire_cost(error, a0, options.triangles),
                   options.drop_specks,
                   most_distance(options.max_distance, side),
                   {side, side, side},
                   largest,
                   false,
                   options.quality};
  simplify.schedule = control.schedule;
  simplify.finer = level_costs(levels, a0);
  simplify.inspect = control.measure;
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

class MeshRun {
 public:
  MeshRun(const TriangleMesh& mesh, std::span<MeshSink* const> sinks, const SimplifyOptions& options,
          const RunControl& control)
      : mesh_(mesh),
        sinks_(sinks),
        options_(options),
        executor_(control.threads),
        a0_(mean_face(mesh, executor_)),
        world_(mesh.offset, common_offset(sinks)),
        error_(options.error.value * (options.error.voxels ? std::sqrt(a0_) : 1)),
        level_errors_(level_errors(options.levels, error_, std::sqrt(a0_), options.triangles)),
        simplifier_(simplifier_options(options, control, error_, a0_, level_errors_,
                                       options.max_distance.value > 0 ? largest_triangle(mesh) : Vec3{}),
                    executor_, control.stop),
        surface_(mesh, executor_, pieces_of(mesh, options)) {
    if (options.triangles > 0) target_.emplace(simplifier_, executor_, options.triangles);
    for (std::size_t level = 0; level < sinks.size(); ++level) {
      outputs_.push_back(std::make_unique<FinalOutput>(world_, *sinks[level], executor_, control.measure, level));
    }
  }

  MeshReport run() {
    do {
      take_piece();
    } while (!surface_.complete());
    for (const auto& output : outputs_) output->wait();
    report_run();
    for (std::size_t level = 0; level < sinks_.size(); ++level) report_level(level);
    if (target_) report_target(simplifier_, options_.triangles, std::sqrt(a0_), mesh_.unit, report_);
    for (MeshSink* sink : sinks_) sink->finish();
    clock_.lap(report_.seconds_write);
    total_.lap(report_.seconds_total);
    report_.peak_bytes = system::peak_bytes();
    return report_;
  }

 private:
  void take_piece() {
    surface_.take(next_piece(simplifier_), piece_);
    simplifier_.append(piece_);
    for (std::size_t level = 0; level < sinks_.size(); ++level) {
      simplifier_.decide(level);
      if (target_) surface_.complete() ? target_->finish() : target_->thin_out();
      clock_.lap(report_.seconds_simplify);
      outputs_[level]->take(simplifier_);
      clock_.lap(report_.seconds_write);
    }
  }

  void report_run() {
    report_.threads = executor_.threads();
    report_.schedule = simplifier_.schedule();
    report_.error = error_;
    report_.triangles_extracted = mesh_.triangles.size();
    report_.vertices_extracted = mesh_.vertices.size();
    report_.locked_vertices = simplifier_.zone().locked;
    report_simplifier(simplifier_, report_);
    if (world_.offset() != mesh_.offset) {
      report_.warnings.push_back(
          "coordinates were rounded to 32 bits anew, as the sink was opened with another offset than the mesh has");
    }
    if (surface_.dropped() > 0) {
      report_.warnings.push_back(std::to_string(surface_.dropped()) + " triangles that repeat a vertex are left out");
    }
    if (!mesh_.normals.empty()) report_.warnings.push_back("the normals of the mesh are not kept");
    if (report_.locked_vertices > 0) {
      report_.warnings.push_back(std::to_string(report_.locked_vertices) +
                                 " vertices are not on an oriented manifold and stay where they are");
    }
    report_.levels.resize(level_errors_.size());
    for (std::size_t level = 0; level < level_errors_.size(); ++level) {
      report_.levels[level].error = level_errors_[level];
    }
  }

  void report_level(std::size_t level) {
    SurfaceReport& report = simplifier_.is_last(level) ? report_ : report_.levels[level];
    outputs_[level]->report(report);
    report_defects(simplifier_.defects(level), report);
    outputs_[level]->report_locked(report);
  }

  Stopwatch total_;
  Stopwatch clock_;
  const TriangleMesh& mesh_;
  const std::span<MeshSink* const> sinks_;
  const SimplifyOptions& options_;
  const Executor executor_;
  const double a0_;
  const World world_;
  const double error_;
  const std::vector<double> level_errors_;
  Simplifier simplifier_;
  std::optional<CountTarget> target_;
  std::vector<std::unique_ptr<FinalOutput>> outputs_;  // per level
  MeshSurface surface_;
  SurfacePiece piece_;
  MeshReport report_;
};

}  // namespace

MeshReport simplify_mesh(const TriangleMesh& mesh, MeshSink& sink, const SimplifyOptions& options,
                         const RunControl& control) {
  MeshSink* const sinks[] = {&sink};
  return simplify_mesh(mesh, sinks, options, control);
}

MeshReport simplify_mesh(const TriangleMesh& mesh, std::span<MeshSink* const> sinks, const SimplifyOptions& options,
                         const RunControl& control) {
  const StandardFloats floats;
  check_sinks(sinks, options.levels.size());
  if (!mesh.values.empty() && mesh.values.size() != mesh.vertices.size()) {
    throw std::invalid_argument("values of a mesh: expected one for each of " + std::to_string(mesh.vertices.size()) +
                                " vertices, found " + std::to_string(mesh.values.size()));
  }
  if (control.device == Device::kCuda) {
    throw std::invalid_argument("a CUDA device: expected a volume, found a mesh, which takes processors");
  }
  return MeshRun(mesh, sinks, options, control).run();
}

}  // namespace isoweave
