#include "pipeline/forecast/mesh_head_start.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

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
constexpr double kLeastLeft = 120;            // triangles of a sample: of fewer, too many lie on its border
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
};

SampleCounts simplify_sample(const TriangleMesh& sample, const SampleBall& ball, const SimplifyTask& task,
                             const RunControl& control) {
  SampleCounts counts;
  if (sample.triangles.empty()) return counts;
  const auto in_middle = [&](const Point& p) { return ball.has_in_middle(p); };
  for (const auto& t : sample.triangles) counts.all += in_middle(sample.vertices[t[0]]) ? 1U : 0U;
  const World world;
  const Executor alone(1);
  CountWhere left(in_middle);
  MeshSink* const sinks[] = {&left};
  HostBackEnd back_end(task, world, sinks, alone, control, control.stop.get());
  back_end.count_removed();
  MeshSurface pieces(sample, alone, {.triangles = sample.triangles.size(), .exactly = true});
  MeshReport report;
  Loop loop(pieces, {}, &back_end, report);
  while (!loop.complete()) loop.step();
  loop.wait_for_sinks();
  counts.left = left.total;
  counts.removed = back_end.removed_by_key();
  return counts;
}

}  // namespace

double mesh_head_start(const TriangleMesh& mesh, const SimplifyOptions& options, const SurfaceMeasure& measure,
                       const Executor& executor, const RunControl& control) {
  if (mesh.triangles.size() < kLargeMesh || mesh.triangles.size() <= options.triangles) return 0;
  const double most = std::min(kSampleError * measure.side, error_of(options, measure.side));
  const SimplifyTask task = task_of_samples(options, measure, most);
  if (!task.needed) return 0;
  RunControl alone;
  alone.threads = 1;
  alone.measure = false;
  alone.stop = control.stop;
  const MeshSamples samples(mesh, executor);
  std::array<SampleCounts, MeshSamples::kCount> counts;
  executor.for_each(MeshSamples::kCount, 1, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    counts[n] = simplify_sample(samples.cut(n), samples.ball(n), task, alone);
  });
  ForecastCurve curve(measure.side, most);
  for (const SampleCounts& each : counts) curve.add(each.all, each.left, each.removed);
  const auto all = static_cast<double>(mesh.triangles.size());
  const double wanted = kSampleMargin * static_cast<double>(options.triangles);
  return curve.head_start(std::max(wanted, all * kLeastLeft / samples.triangles()), all);
}

}  // namespace isoweave
