// The same simplifier on a mesh that is there as a whole.
#include <algorithm>
#include <cmath>
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

  void append(std::span<const Point> vertices, std::span<const Point> normals,
              std::span<const std::array<std::uint64_t, 3>> triangles) override {
    mesh_.vertices.insert(mesh_.vertices.end(), vertices.begin(), vertices.end());
    for (const auto& t : triangles) {
      mesh_.triangles.push_back(
          {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]), static_cast<std::uint32_t>(t[2])});
    }
    sink_.append(vertices, normals, triangles);
  }

  void finish() override { sink_.finish(); }

  const TriangleMesh& mesh() const { return mesh_; }

 private:
  MeshSink& sink_;
  TriangleMesh mesh_;
};

void report_check(const MeshCheck& check, MeshReport& report) {
  report.open_edges = check.open_edges;
  report.nonmanifold_edges = check.nonmanifold_edges;
  report.nonmanifold_vertices = check.nonmanifold_vertices;
  report.components = check.components;
  report.euler = check.euler;
}

std::uint64_t count_locked(const Zone& zone) {
  return static_cast<std::uint64_t>(std::count(zone.states.begin(), zone.states.end(), VertexState::kLocked));
}

}  // namespace

MeshReport simplify_mesh(const TriangleMesh& mesh, MeshSink& sink, const SimplifyOptions& options,
                         const RunControl& control) {
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
  SimplifierOptions simplifier_options;
  simplifier_options.zone = {EdgeNumbering{}, a0, retire_cost(report.error, a0, options.triangles),
                             options.drop_specks};
  simplifier_options.quality = options.quality;
  simplifier_options.schedule = control.schedule;
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
  simplifier.decide();
  if (target) target->finish();
  clock.lap(report.seconds_simplify);

  // A linked surface is measured as it leaves; around locked vertices only a look at the whole tells.
  const World world;
  Recorder recorder(sink);
  FinalOutput output(world, report.locked_vertices > 0 ? recorder : sink, executor, control.measure);
  output.take(simplifier);
  output.wait();
  report_simplifier(simplifier, report);
  output.report(report);
  if (target) report_target(*target, options.triangles, std::sqrt(a0), report);
  if (report.locked_vertices > 0) report_check(check_mesh(recorder.mesh()), report);
  sink.finish();
  clock.lap(report.seconds_write);
  total.lap(report.seconds_total);
  report.peak_bytes = peak_process_bytes();
  return report;
}

}  // namespace isoweave
