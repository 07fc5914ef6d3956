#include "pipeline/forecast/mesh_samples.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parallel/collect.hpp"

namespace isoweave {
namespace {

constexpr double kSampledTriangles = 0.02;                          // of the triangles, in all samples
constexpr double kMostOfMesh = 0.05;                                // the same of a small mesh: it has fewer samples
constexpr double kLeastTriangles = 1'200, kMostTriangles = 50'000;  // of one sample
constexpr double kLeastSamples = 6;
constexpr double kTooMany = 4;                                   // times as many triangles as a sample should have
constexpr double kPointsInBall = 48;                             // vertices that tell how large a ball is
constexpr double kLeastPoints = 1 << 10, kMostPoints = 1 << 14;  // such vertices in all
constexpr std::int64_t kMeshBlock = 1 << 14;

// The samples that a mesh of so many triangles has.
std::size_t sample_count(double triangles) {
  const double most = static_cast<double>(MeshSamples::kMost);
  return static_cast<std::size_t>(std::clamp(kMostOfMesh * triangles / kLeastTriangles, kLeastSamples, most));
}

// The balls of all samples by columns, for lanes of vectors.
class BallColumns {
 public:
  explicit BallColumns(const std::array<SampleBall, MeshSamples::kMost>& balls) {
    for (std::size_t n = 0; n < MeshSamples::kMost; ++n) {
      x_[n] = balls[n].centre[0];
      y_[n] = balls[n].centre[1];
      z_[n] = balls[n].centre[2];
      squared_radius_[n] = static_cast<float>(std::min(balls[n].squared_radius, kLargest));
    }
  }

  // A bit for each ball that a point is in.
  unsigned mask_of(const Point& p) const {
    unsigned mask = 0;
    for (unsigned n = 0; n < MeshSamples::kMost; ++n) {
      const float x = p[0] - x_[n], y = p[1] - y_[n], z = p[2] - z_[n];
      mask |= (x * x + y * y + z * z < squared_radius_[n] ? 1U : 0U) << n;
    }
    return mask;
  }

 private:
  static constexpr double kLargest = std::numeric_limits<float>::max();

  std::array<float, MeshSamples::kMost> x_{}, y_{}, z_{}, squared_radius_{};
};

// Some of the vertices, evenly spread over the list of them, in the order of a curve that leaves no cube before it has
// been in all of it (G. M. Morton 1966): vertices far from each other in the order lie in different parts of the mesh.
class SpreadVertices {
 public:
  SpreadVertices(const TriangleMesh& mesh, std::size_t points) {
    const std::size_t step = std::max<std::size_t>(mesh.vertices.size() / points, 1);
    for (std::size_t v = 0; v < mesh.vertices.size(); v += step) points_.push_back(mesh.vertices[v]);
    for (std::size_t axis = 0; axis < 3; ++axis) find_bounds(axis);
    std::vector<std::pair<std::uint32_t, std::size_t>> order;
    order.reserve(points_.size());
    for (const Point& p : points_) order.emplace_back(place_on_curve(p), order.size());
    std::ranges::sort(order);
    std::vector<Point> sorted(points_.size());
    std::ranges::transform(order, sorted.begin(), [&](const auto& place) { return points_[place.second]; });
    points_ = std::move(sorted);
  }

  // A point that a share of the others comes before.
  const Point& at(double share) const { return points_[rank(share)]; }

  // The ball around a point that holds a share of the points.
  SampleBall ball_around(const Point& centre, double share) const {
    SampleBall ball{centre};
    std::vector<double> squares(points_.size());
    std::ranges::transform(points_, squares.begin(), [&](const Point& p) { return ball.squared_distance(p); });
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

// Some triangles of a mesh, and their vertices, as a mesh.
TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint64_t> corners;  // the vertex of each, and its place among them
  corners.reserve(3 * triangles.size());
  for (const std::uint32_t t : triangles) {
    for (const std::uint32_t v : mesh.triangles[t]) corners.push_back(std::uint64_t{v} << 32 | corners.size());
  }
  std::ranges::sort(corners);
  TriangleMesh part;
  part.triangles.resize(triangles.size());
  std::uint64_t before = ~std::uint64_t{0};
  for (const std::uint64_t corner : corners) {
    const std::uint64_t v = corner >> 32, place = corner & 0xffffffffU;
    if (v != std::exchange(before, v)) part.vertices.push_back(mesh.vertices[v]);
    part.triangles[place / 3][place % 3] = static_cast<std::uint32_t>(part.vertices.size() - 1);
  }
  return part;
}

}  // namespace

MeshSamples::MeshSamples(const TriangleMesh& mesh, const Executor& executor)
    : mesh_(mesh),
      count_(sample_count(static_cast<double>(mesh.triangles.size()))),
      triangles_(
          std::clamp(kSampledTriangles * static_cast<double>(mesh.triangles.size()) / static_cast<double>(count_),
                     kLeastTriangles, kMostTriangles)) {
  find_balls(executor);
  mark_vertices(executor);
  list_triangles(executor);
}

MeshSample MeshSamples::cut(std::size_t n) const {
  MeshSample sample;
  std::vector<std::uint32_t> kept;
  for (const std::uint32_t t : listed_) {
    const auto [a, b, c] = masks_of(t);
    const unsigned corners = (a >> n & 1) + (b >> n & 1) + (c >> n & 1);
    if (corners == 3) kept.push_back(t);
    if (corners == 2) ++sample.cut_edges;  // the one between these corners
  }
  if (static_cast<double>(kept.size()) <= kTooMany * triangles_) sample.mesh = part_of(mesh_, kept);
  return sample;
}

void MeshSamples::find_balls(const Executor& executor) {
  const double share = triangles_ / static_cast<double>(mesh_.triangles.size());
  const double points = std::clamp(kPointsInBall / share, kLeastPoints, kMostPoints);
  const SpreadVertices vertices(mesh_, static_cast<std::size_t>(points));
  executor.for_each(static_cast<std::int64_t>(count_), 1, [&](std::int64_t n) {
    const double place = (static_cast<double>(n) + 0.5) / static_cast<double>(count_);
    balls_[static_cast<std::size_t>(n)] = vertices.ball_around(vertices.at(place), share);
  });
}

void MeshSamples::mark_vertices(const Executor& executor) {
  masks_.resize(mesh_.vertices.size());
  const BallColumns balls(balls_);
  executor.for_each(static_cast<std::int64_t>(masks_.size()), kMeshBlock, [&](std::int64_t v) {
    masks_[static_cast<std::size_t>(v)] = static_cast<Mask>(balls.mask_of(mesh_.vertices[static_cast<std::size_t>(v)]));
  });
}

void MeshSamples::list_triangles(const Executor& executor) {
  collect(
      executor, static_cast<std::int64_t>(mesh_.triangles.size()), kMeshBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<std::uint32_t>& list) {
        for (auto t = static_cast<std::uint32_t>(begin); t < static_cast<std::uint32_t>(end); ++t) {
          const auto [a, b, c] = masks_of(t);
          if (((a & b) | (b & c) | (c & a)) != 0) list.push_back(t);
        }
      },
      listed_);
}

std::array<unsigned, 3> MeshSamples::masks_of(std::uint32_t triangle) const {
  const auto& [a, b, c] = mesh_.triangles[triangle];
  return {masks_[a], masks_[b], masks_[c]};
}

}  // namespace isoweave
