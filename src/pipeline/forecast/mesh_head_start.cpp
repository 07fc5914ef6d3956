#include "pipeline/forecast/mesh_head_start.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "output/world.hpp"
#include "parallel/collect.hpp"
#include "pipeline/forecast/forecast_curve.hpp"
#include "pipeline/forecast/forecast_sinks.hpp"
#include "pipeline/host_back_end.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/mesh_surface.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kLargeMesh = 50'000;  // triangles: simplifying fewer takes little longer than samples of them
constexpr std::size_t kSamples = 16;
constexpr double kSampledTriangles = 0.03;                          // of the triangles, in all samples
constexpr double kLeastTriangles = 1'200, kMostTriangles = 50'000;  // of one sample
constexpr double kLeastLeft = 120;          // triangles of a sample: of fewer, too many lie on its border
constexpr double kSampleMargin = 1.1;       // samples mislead more than the tiles of a volume
constexpr double kTooMany = 4;              // times as many triangles as a sample should have
constexpr std::size_t kMeasured = 1 << 15;  // vertices whose distances tell how large a sample is
constexpr double kSampleError = 3;          // lengths like that of a triangle's side, to which samples are simplified
constexpr std::int64_t kMeshBlock = 1 << 14;

using SampleMask = std::uint16_t;  // a bit for each sample
static_assert(kSamples <= 16);

// A sample has the triangles whose corners are within a ball. The border of the sample hardly disturbs its middle.
struct SampleBall {
  Point centre{};
  double squared_radius = 0;

  double squared_distance(const Point& p) const {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double along = double{p[axis]} - double{centre[axis]};
      sum += along * along;
    }
    return sum >= 0 ? sum : std::numeric_limits<double>::infinity();  // a place may be no number
  }
  bool has_in_middle(const Point& p) const { return 4 * squared_distance(p) < squared_radius; }
};

// The balls of all samples by columns, for lanes of vectors.
class BallColumns {
 public:
  explicit BallColumns(const std::vector<SampleBall>& balls) {
    for (std::size_t n = 0; n < kSamples; ++n) {
      x_[n] = balls[n].centre[0];
      y_[n] = balls[n].centre[1];
      z_[n] = balls[n].centre[2];
      squared_radius_[n] = static_cast<float>(balls[n].squared_radius);
    }
  }

  SampleMask mask_of(const Point& p) const {
    unsigned mask = 0;
    for (unsigned n = 0; n < kSamples; ++n) {
      const float x = p[0] - x_[n], y = p[1] - y_[n], z = p[2] - z_[n];
      mask |= (x * x + y * y + z * z < squared_radius_[n] ? 1U : 0U) << n;
    }
    return static_cast<SampleMask>(mask);
  }

 private:
  std::array<float, kSamples> x_{}, y_{}, z_{}, squared_radius_{};
};

// Some of the vertices, evenly spread over the list of them, in the order of a curve that leaves no cube before it has
// been in all of it (G. M. Morton 1966): vertices far from each other in the order lie in different parts of the mesh.
class SpreadVertices {
 public:
  explicit SpreadVertices(const TriangleMesh& mesh) {
    const std::size_t step = std::max<std::size_t>(mesh.vertices.size() / kMeasured, 1);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += step) points_.push_back(mesh.vertices[v]);
    for (std::size_t axis = 0; axis < 3; ++axis) find_bounds(axis);
    std::vector<std::pair<std::uint32_t, std::size_t>> order;
    for (const Point& p : points_) order.emplace_back(place_on_curve(p), order.size());
    std::ranges::sort(order);
    std::vector<Point> sorted;
    for (const auto& [place, n] : order) sorted.push_back(points_[n]);
    points_ = std::move(sorted);
  }

  // A point that a share of the others comes before.
  const Point& at(double share) const { return points_[rank(share)]; }

  // The ball around a point that holds a share of the points.
  SampleBall ball_around(const Point& centre, double share) const {
    SampleBall ball{centre};
    std::vector<double> squares;
    for (const Point& p : points_) squares.push_back(ball.squared_distance(p));
    const auto found = squares.begin() + static_cast<std::ptrdiff_t>(rank(share));
    std::nth_element(squares.begin(), found, squares.end());
    ball.squared_radius = *found;
    return ball;
  }

 private:
  static constexpr unsigned kBits = 10;  // along each axis

  std::size_t rank(double share) const {
    const auto rank = static_cast<std::size_t>(share * static_cast<double>(points_.size()));
    return std::min(rank, points_.size() - 1);
  }

  void find_bounds(std::size_t axis) {
    float low = std::numeric_limits<float>::max(), high = std::numeric_limits<float>::lowest();
    for (const Point& p : points_) {
      if (!std::isfinite(p[axis])) continue;
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    low_[axis] = low;
    per_length_[axis] = high > low ? (1U << kBits) / (double{high} - double{low}) : 0;
  }

  std::uint32_t place_on_curve(const Point& p) const {
    constexpr double kLast = (1U << kBits) - 1;
    std::uint32_t place = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double along = (double{p[axis]} - low_[axis]) * per_length_[axis];
      const auto cell = static_cast<std::uint32_t>(along > 0 ? std::min(along, kLast) : 0);
      for (unsigned bit = 0; bit < kBits; ++bit) place |= (cell >> bit & 1) << (3 * bit + axis);
    }
    return place;
  }

  std::vector<Point> points_;
  std::array<double, 3> low_{}, per_length_{};
};

// The samples of a mesh, around vertices in different parts of it.
class MeshSamples {
 public:
  MeshSamples(const TriangleMesh& mesh, const Executor& executor) : mesh_(mesh), balls_(kSamples) {
    const auto all = static_cast<double>(mesh.triangles.size());
    triangles_ = std::clamp(kSampledTriangles * all / kSamples, kLeastTriangles, kMostTriangles);
    const SpreadVertices vertices(mesh);
    executor.for_each(kSamples, 1, [&](std::int64_t n) {
      const double share = (static_cast<double>(n) + 0.5) / kSamples;
      balls_[static_cast<std::size_t>(n)] = vertices.ball_around(vertices.at(share), triangles_ / all);
    });
    mark(executor);
  }

  double triangles() const { return triangles_; }  // of one sample, about
  const SampleBall& ball(std::size_t n) const { return balls_[n]; }

  // A sample as a mesh. Nothing where far more triangles are as near as those that it should have.
  TriangleMesh cut(std::size_t n) const {
    TriangleMesh sample;
    std::vector<std::uint32_t> kept;
    for (const std::uint32_t t : marked_) {
      if ((mask_of(t) >> n & 1) != 0) kept.push_back(t);
    }
    if (static_cast<double>(kept.size()) > kTooMany * triangles_) return sample;
    std::vector<std::uint32_t> vertices;
    for (const std::uint32_t t : kept)
      vertices.insert(vertices.end(), mesh_.triangles[t].begin(), mesh_.triangles[t].end());
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::uint32_t v : vertices) sample.vertices.push_back(mesh_.vertices[v]);
    for (const std::uint32_t t : kept) {
      auto& triangle = sample.triangles.emplace_back(mesh_.triangles[t]);
      for (std::uint32_t& v : triangle) {
        v = static_cast<std::uint32_t>(std::ranges::lower_bound(vertices, v) - vertices.begin());
      }
    }
    return sample;
  }

 private:
  // Finds which samples each vertex is in, and the triangles that are in one.
  void mark(const Executor& executor) {
    masks_.resize(mesh_.vertices.size());
    const BallColumns balls(balls_);
    executor.for_each(static_cast<std::int64_t>(masks_.size()), kMeshBlock, [&](std::int64_t v) {
      masks_[static_cast<std::size_t>(v)] = balls.mask_of(mesh_.vertices[static_cast<std::size_t>(v)]);
    });
    collect(
        executor, static_cast<std::int64_t>(mesh_.triangles.size()), kMeshBlock,
        [&](std::int64_t begin, std::int64_t end, std::vector<std::uint32_t>& list) {
          for (auto t = static_cast<std::uint32_t>(begin); t < static_cast<std::uint32_t>(end); ++t) {
            if (mask_of(t) != 0) list.push_back(t);
          }
        },
        marked_);
  }

  unsigned mask_of(std::uint32_t t) const {
    const auto& [a, b, c] = mesh_.triangles[t];
    return unsigned{masks_[a]} & masks_[b] & masks_[c];
  }

  const TriangleMesh& mesh_;
  double triangles_ = 0;  // that a sample should have
  std::vector<SampleBall> balls_;
  std::vector<SampleMask> masks_;      // per vertex
  std::vector<std::uint32_t> marked_;  // triangles
};

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
  SimplifyOptions of_sample = options;
  of_sample.triangles = 0;
  of_sample.levels.clear();
  of_sample.error = Length::units(most);
  const SimplifyTask task = resolve_simplification(of_sample, measure);
  if (!task.needed) return 0;
  RunControl alone;
  alone.threads = 1;
  alone.measure = false;
  alone.stop = control.stop;
  const MeshSamples samples(mesh, executor);
  std::array<SampleCounts, kSamples> counts;
  executor.for_each(kSamples, 1, [&](std::int64_t i) {
    const auto n = static_cast<std::size_t>(i);
    counts[n] = simplify_sample(samples.cut(n), samples.ball(n), task, alone);
  });
  ForecastCurve curve(measure.side, most);
  for (const SampleCounts& each : counts) curve.add(each.all, each.left, each.removed);
  const auto all = static_cast<double>(mesh.triangles.size());
  const double wanted =
      std::max(kSampleMargin * static_cast<double>(options.triangles), all * kLeastLeft / samples.triangles());
  return curve.head_start(wanted, all);
}

}  // namespace isoweave
