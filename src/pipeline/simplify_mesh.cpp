// The loop over a mesh in memory.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

#include "isoweave/pipeline.hpp"
#include "output/world.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/forecast/mesh_head_start.hpp"
#include "pipeline/host_back_end.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/mesh_surface.hpp"
#include "pipeline/run_report.hpp"
#include "pipeline/slab_plan.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

// The area that takes the place of the mean voxel face.
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

SurfaceMeasure measure_of(const TriangleMesh& mesh, const SimplifyOptions& options, const Executor& executor) {
  const double a0 = mean_face(mesh, executor);
  const double side = std::sqrt(a0);
  const Vec3 largest = options.max_distance.value > 0 ? largest_triangle(mesh) : Vec3{};
  return {a0, side, VertexNumbering::of_file(), {side, side, side}, largest, mesh.unit};
}

// The pieces of a mesh. Where distances are bounded the mesh is one piece, as pieces would have to come in the order of
// their heights.
MeshSurface::Pieces pieces_of(const TriangleMesh& mesh, const SimplifyOptions& options, std::uint64_t piece) {
  if (options.max_distance.value > 0) return {.triangles = mesh.triangles.size(), .exactly = true};
  if (piece > 0) return {.triangles = piece, .exactly = true};
  return {.triangles = static_cast<std::uint64_t>(kSimplifiedSlab.triangles)};
}

class MeshRun {
 public:
  MeshRun(const TriangleMesh& mesh, std::span<MeshSink* const> sinks, const SimplifyTask& task,
          const MeshSurface::Pieces& pieces, const Executor& executor, const RunControl& control,
          const HeadStart& head_start)
      : mesh_(mesh),
        sinks_(sinks),
        allow_empty_(control.allow_empty),
        executor_(executor),
        task_(task),
        world_(mesh.offset, common_offset(sinks)),
        back_end_(task_, world_, sinks, executor_, control, control.stop.get(), head_start),
        pieces_(mesh, executor_, pieces),
        loop_(pieces_, {}, &back_end_, report_) {}

  // The report; or the head start of the run that has to take the place of this one.
  std::variant<MeshReport, HeadStart> run() {
    report_.threads = executor_.threads();
    report_errors(task_, report_);
    do {
      loop_.step();
    } while (!loop_.complete());
    if (const std::optional<HeadStart> next = back_end_.overshot()) return *next;
    loop_.wait_for_sinks();
    loop_.finish();
    warn();
    if (report_.triangles == 0) {
      report_nothing(mesh_.triangles.empty() ? "the mesh has no triangles" : "nothing is left of the triangles",
                     allow_empty_, report_);
    }
    Stopwatch finishing;
    for (MeshSink* sink : sinks_) sink->finish();
    finishing.lap(report_.seconds_write);
    report_.peak_bytes = system::peak_bytes();
    return std::move(report_);
  }

 private:
  void warn() {
    if (world_.offset() != mesh_.offset) {
      report_.warnings.push_back(
          "coordinates were rounded to 32 bits anew, as the sink was opened with another offset than the mesh has");
    }
    if (pieces_.dropped() > 0) {
      report_.warnings.push_back(std::to_string(pieces_.dropped()) + " triangles that repeat a vertex are left out");
    }
    if (!mesh_.normals.empty()) report_.warnings.push_back("the normals of the mesh are not kept");
    if (report_.locked_vertices > 0) {
      report_.warnings.push_back(std::to_string(report_.locked_vertices) +
                                 " vertices are not on an oriented manifold and stay where they are");
    }
  }

  const TriangleMesh& mesh_;
  const std::span<MeshSink* const> sinks_;
  const bool allow_empty_;
  const Executor& executor_;
  const SimplifyTask& task_;
  const World world_;
  HostBackEnd back_end_;
  MeshSurface pieces_;
  MeshReport report_;
  Loop loop_;
};

// The options with a number of triangles in place of a share of all.
SimplifyOptions with_number(SimplifyOptions options, std::uint64_t all) {
  options.triangles = goal_of(options).of(all);
  options.share = 0;
  return options;
}

// The head start of a run to a number, by an error that is known or by samples of the mesh.
HeadStart head_start_of(const TriangleMesh& mesh, const SimplifyOptions& options, const SurfaceMeasure& measure,
                        const Executor& executor, const RunControl& control) {
  if (options.triangles == 0) return {};
  const double error =
      control.head_start ? *control.head_start : mesh_head_start(mesh, options, measure, executor, control);
  return {head_start_cost(error, measure.a0)};
}

}  // namespace

MeshReport simplify_mesh(const TriangleMesh& mesh, MeshSink& sink, const SimplifyOptions& options,
                         const RunControl& control) {
  MeshSink* const sinks[] = {&sink};
  return simplify_mesh(mesh, sinks, options, control);
}

MeshReport simplify_mesh(const TriangleMesh& mesh, std::span<MeshSink* const> sinks,
                         const SimplifyOptions& options_given, const RunControl& control) {
  const StandardFloats floats;
  const SimplifyOptions options = with_number(options_given, mesh.triangles.size());
  check_sinks(sinks, options.levels.size());
  MeshOptions asked;
  static_cast<SimplifyOptions&>(asked) = options;
  require_possible(RunKind::kSimplify, asked, control);
  if (!mesh.values.empty() && mesh.values.size() != mesh.vertices.size()) {
    throw std::invalid_argument("values of a mesh: expected one for each of " + std::to_string(mesh.vertices.size()) +
                                " vertices, found " + std::to_string(mesh.values.size()));
  }
  Stopwatch total;
  const Executor executor(control.threads);
  const SurfaceMeasure measure = measure_of(mesh, options, executor);
  const SimplifyTask task = resolve_simplification(options, measure);
  const MeshSurface::Pieces pieces = pieces_of(mesh, options, control.piece);
  const auto run = [&](const HeadStart& head_start) {
    return MeshRun(mesh, sinks, task, pieces, executor, control, head_start).run();
  };
  std::variant<MeshReport, HeadStart> made = run(head_start_of(mesh, options, measure, executor, control));
  while (const HeadStart* const next = std::get_if<HeadStart>(&made)) made = run(*next);
  MeshReport& report = std::get<MeshReport>(made);
  total.lap(report.seconds_total);
  return std::move(report);
}

}  // namespace isoweave
