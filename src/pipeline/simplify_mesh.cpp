// The same simplifier on a mesh that is there as a whole.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "isoweave/pipeline.hpp"
#include "pipeline/final_output.hpp"
#include "pipeline/mesh_surface.hpp"
#include "pipeline/sweep.hpp"
#include "simplify/count_target.hpp"

namespace isoweave {
namespace {

// Keeps what passes on to a sink, to be checked as a whole.
class Recorder : public MeshSink {
 public:
  explicit Recorder(MeshSink& sink) : sink_(sink) {}

  void append(const MeshPiece& piece) override {
    mesh_.vertices.insert(mesh_.vertices.end(), piece.vertices.begin(), piece.vertices.end());
    for (const auto& t : piece.triangles) {
      mesh_.triangles.push_back(
          {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]), static_cast<std::uint32_t>(t[2])});
    }
    sink_.append(piece);
  }

  void finish() override { sink_.finish(); }

  const TriangleMesh& mesh() const { return mesh_; }

 private:
  MeshSink& sink_;
  TriangleMesh mesh_;
};

void report_check(const MeshCheck& check, SurfaceReport& report) {
  report.open_edges = check.open_edges;
  report.nonmanifold_edges = check.nonmanifold_edges;
  report.nonmanifold_vertices = check.nonmanifold_vertices;
  report.components = check.components;
  report.euler = check.euler;
}

// The mesh of one level on its way out. A linked surface is measured as it leaves; around locked vertices only a look
// at the whole tells.
class LevelOutput {
 public:
  LevelOutput(const World& world, MeshSink& sink, const Executor& executor, bool measure, std::size_t level,
              bool has_locked)
      : level_(level),
        has_locked_(has_locked),
        recorder_(sink),
        output_(world, has_locked ? recorder_ : sink, executor, measure, level) {}

  void take(Simplifier& simplifier) { output_.take(simplifier); }

  void report(const Simplifier& simplifier, SurfaceReport& report) {
    output_.wait();
    output_.report(report);
    report_defects(simplifier.defects(level_), report);
    if (has_locked_) report_check(check_mesh(recorder_.mesh()), report);
  }

 private:
  std::size_t level_;
  bool has_locked_;
  Recorder recorder_;
  FinalOutput output_;
};

std::uint64_t count_locked(const Zone& zone) {
  return static_cast<std::uint64_t>(std::count(zone.states.begin(), zone.states.end(), VertexState::kLocked));
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
  report.threads = executor.threads();
  report.error = options.error.value * (options.error.voxels ? std::sqrt(a0) : 1);
  const std::vector<double> errors = level_errors(options.levels, report.error, std::sqrt(a0), options.triangles);
  SimplifierOptions simplifier_options;
  const double side = std::sqrt(a0);
  simplifier_options.zone = {EdgeNumbering{},
                             a0,
                             retire_cost(report.error, a0, options.triangles),
                             options.drop_specks,
                             most_distance(options.max_distance, side),
                             {side, side, side}};
  simplifier_options.quality = options.quality;
  simplifier_options.schedule = control.schedule;
  simplifier_options.finer = level_costs(errors, a0);
  Simplifier simplifier(simplifier_options, executor, control.stop);
  report.schedule = simplifier.schedule();

  std::optional<CountTarget> target;
  if (options.triangles > 0) target.emplace(simplifier, executor, options.triangles);

  SurfacePiece piece;
  std::uint64_t dropped = 0;
  make_piece(mesh, executor, piece, dropped);
  report.triangles_extracted = mesh.triangles.size();
  report.vertices_extracted = mesh.vertices.size();
  if (dropped > 0) {
    report.warnings.push_back(std::to_string(dropped) + " triangles that repeat a vertex are left out");
  }
  simplifier.append(piece);
  piece = {};
  report.locked_vertices = count_locked(simplifier.zone());
  if (report.locked_vertices > 0) {
    report.warnings.push_back(std::to_string(report.locked_vertices) +
                              " vertices are not on an oriented manifold and stay where they are");
  }
  const World world;
  std::vector<std::unique_ptr<LevelOutput>> outputs;
  for (std::size_t level = 0; level < sinks.size(); ++level) {
    outputs.push_back(std::make_unique<LevelOutput>(world, *sinks[level], executor, control.measure, level,
                                                    report.locked_vertices > 0));
    simplifier.decide(level);
    if (target) target->finish();
    clock.lap(report.seconds_simplify);
    outputs.back()->take(simplifier);
    clock.lap(report.seconds_write);
  }
  report_simplifier(simplifier, report);
  report.levels.resize(errors.size());
  for (std::size_t level = 0; level < errors.size(); ++level) {
    report.levels[level].error = errors[level];
    outputs[level]->report(simplifier, report.levels[level]);
  }
  outputs.back()->report(simplifier, report);
  if (target) report_target(*target, options.triangles, std::sqrt(a0), report);
  for (MeshSink* sink : sinks) sink->finish();
  clock.lap(report.seconds_write);
  total.lap(report.seconds_total);
  report.peak_bytes = peak_process_bytes();
  return report;
}

}  // namespace isoweave
