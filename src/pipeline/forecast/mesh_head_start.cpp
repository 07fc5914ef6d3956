#include "pipeline/forecast/mesh_head_start.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "output/world.hpp"
#include "pipeline/forecast/forecast_curve.hpp"
#include "pipeline/forecast/forecast_sinks.hpp"
#include "pipeline/forecast/mesh_samples.hpp"
#include "pipeline/host_back_end.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/mesh_surface.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kLargeMesh = 50'000;  // triangles: simplifying fewer takes little longer than samples of them
constexpr double kSampleError = 3;            // of samples, in SurfaceMeasure::side
constexpr double kLeastLeft = 90;             // triangles of a sheet in a sample: of fewer, too many lie at its border
constexpr double kSampleMargin = 1.1;         // samples mislead more than the tiles of a volume

SimplifyTask task_of_samples(const SimplifyOptions& options, const SurfaceMeasure& measure, double error) {
  SimplifyOptions of_sample = options;
  of_sample.triangles = 0;
  of_sample.levels.clear();
  of_sample.error = Length::units(error);
  return resolve_simplification(of_sample, measure);
}

// The triangles in the middle of a sample, before and after, and those of the whole sample that went, by costs.
struct SampleCounts {
  std::uint64_t all = 0, left = 0;
  CostHistogram removed;
  std::uint64_t triangles = 0, cut_edges = 0;  // of the whole sample
};

SampleCounts simplify_sample(const MeshSample& sample, const SampleBall& ball, const SimplifyTask& task,
                             const RunControl& control) {
  SampleCounts counts;
  const TriangleMesh& mesh = sample.mesh;
  if (mesh.triangles.empty()) return counts;
  counts.triangles = mesh.triangles.size();
  counts.cut_edges = sample.cut_edges;
  const auto in_middle = [&](const Point& p) { return ball.has_in_middle(p); };
  for (const auto& t : mesh.triangles) counts.all += in_middle(mesh.vertices[t[0]]) ? 1U : 0U;
  const World world;
  const Executor alone(1);
  CountWhere left(in_middle);
  MeshSink* const sinks[] = {&left};
  HostBackEnd back_end(task, world, sinks, alone, control, control.stop.get());
  back_end.count_removed();
  MeshSurface pieces(mesh, alone, {.triangles = mesh.triangles.size(), .exactly = true});
  MeshReport report;
  Loop loop(pieces, {}, &back_end, report);
  while (!loop.complete()) loop.step();
  loop.wait_for_sinks();
  counts.left = left.total;
  counts.removed = back_end.removed_by_key();
  return counts;
}

std::vector<SampleCounts> simplify_samples(const MeshSamples& samples, const SimplifyTask& task,
                                           const Executor& executor, const RunControl& control) {
  RunControl alone;
  alone.threads = 1;
  alone.measure = false;
  alone.stop = control.stop;
  std::vector<SampleCounts> counts(samples.count());
  executor.for_each(static_cast<std::int64_t>(counts.size()), 1, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    counts[n] = simplify_sample(samples.cut(n), samples.ball(n), task, alone);
  });
  return counts;
}

// About the triangles of each sheet of the surface that runs through a sample, in the mean. A disc of n equilateral
// triangles is cut at some sqrt(7.8 n) edges, as they zigzag around it.
double triangles_of_sheet(std::span<const SampleCounts> samples) {
  double triangles = 0, cut_edges = 0;
  for (const SampleCounts& sample : samples) {
    triangles += static_cast<double>(sample.triangles);
    cut_edges += static_cast<double>(sample.cut_edges);
  }
  const double per_edge = triangles / std::max(cut_edges, 1.0);
  return std::max(std::min(triangles / static_cast<double>(samples.size()), 7.8 * per_edge * per_edge), 1.0);
}

}  // namespace

double mesh_head_start(const TriangleMesh& mesh, const SimplifyOptions& options, const SurfaceMeasure& measure,
                       const Executor& executor, const RunControl& control) {
  if (mesh.triangles.size() < kLargeMesh || mesh.triangles.size() <= options.triangles) return 0;
  const double most = std::min(kSampleError * measure.side, error_of(options, measure.side));
  const SimplifyTask task = task_of_samples(options, measure, most);
  if (!task.needed) return 0;
  const std::vector<SampleCounts> samples = simplify_samples(MeshSamples(mesh, executor), task, executor, control);
  ForecastCurve curve(measure.side, most);
  for (const SampleCounts& sample : samples) curve.add(sample.all, sample.left, sample.removed);
  const auto all = static_cast<double>(mesh.triangles.size());
  const double wanted = kSampleMargin * static_cast<double>(options.triangles);
  return curve.head_start(std::max(wanted, all * kLeastLeft / triangles_of_sheet(samples)), all);
}

}  // namespace isoweave
