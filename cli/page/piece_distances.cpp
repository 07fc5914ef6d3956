#include "page/piece_distances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "isoweave/measure.hpp"

namespace isoweave::cli {
namespace {

constexpr std::size_t kPieceTriangles = 500'000;
constexpr double kReach = 0.002;  // of the first pass, in parts of the diagonal of a mesh's box

struct Bounds {
  Point low{}, high{};
};

Bounds bounds_of(std::span<const Point> points) {
  Bounds bounds{points.front(), points.front()};
  for (const Point& point : points) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      bounds.low[axis] = std::min(bounds.low[axis], point[axis]);
      bounds.high[axis] = std::max(bounds.high[axis], point[axis]);
    }
  }
  return bounds;
}

// A lower bound of the distance to anything within the bounds.
double distance_to(const Bounds& bounds, const Point& point) {
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double below = double{bounds.low[axis]} - double{point[axis]};
    const double above = double{point[axis]} - double{bounds.high[axis]};
    const double outside = std::max({below, above, 0.0});
    squared += outside * outside;
  }
  return std::sqrt(squared);
}

double diagonal_of(const TriangleMesh& mesh) {
  const Bounds bounds = bounds_of(mesh.vertices);
  return distance_to({bounds.low, bounds.low}, bounds.high);
}

// The vertices of a mesh, with their distances from what has come.
class Seeker {
 public:
  explicit Seeker(const TriangleMesh* mesh)
      : mesh_(mesh),
        reach_(kReach * diagonal_of(*mesh)),
        distances_(mesh->vertices.size(), std::numeric_limits<float>::infinity()) {}

  void see(const TriangleMesh& piece, const Bounds& bounds, int threads) {
    near_.clear();
    // Of a mesh without triangles nothing is measured, so there is one.
    TriangleMesh points{{}, {{0, 0, 0}}};
    points.offset = mesh_->offset;
    for (std::size_t v = 0; v < distances_.size(); ++v) {
      const double most = std::min(double{distances_[v]}, reach_);
      if (double{distances_[v]} <= known_ || distance_to(bounds, mesh_->vertices[v]) > most) continue;
      near_.push_back(v);
      points.vertices.push_back(mesh_->vertices[v]);
    }
    if (near_.empty()) return;
    const std::vector<float> found = vertex_distances(points, piece, threads);
    for (std::size_t n = 0; n < found.size(); ++n) distances_[near_[n]] = std::min(distances_[near_[n]], found[n]);
  }

  // Whether all distances are known: every piece within reach has been looked at.
  bool complete() const { return double{*std::ranges::max_element(distances_)} <= reach_; }

  // From now on all pieces are looked at, for the vertices whose distances are not known.
  void look_everywhere() {
    known_ = reach_;
    reach_ = std::numeric_limits<double>::infinity();
  }

  std::vector<float> take() { return std::move(distances_); }

 private:
  const TriangleMesh* mesh_;
  double reach_;
  double known_ = -1;  // distances up to this are known
  std::vector<float> distances_;
  std::vector<std::size_t> near_;
};

// Gathers triangles into pieces that are worth a tree.
class PieceSink final : public MeshSink {
 public:
  PieceSink(std::vector<Seeker>& seekers, const std::array<double, 3>& offset, int threads)
      : seekers_(seekers), threads_(threads) {
    piece_.offset = offset;
  }

  void append(const MeshPiece& piece) override {
    vertices_.insert(vertices_.end(), piece.vertices.begin(), piece.vertices.end());
    for (const std::array<std::uint64_t, 3>& triangle : piece.triangles) {
      const auto first = static_cast<std::uint32_t>(piece_.vertices.size());
      for (const std::uint64_t v : triangle) piece_.vertices.push_back(vertices_[v]);
      piece_.triangles.push_back({first, first + 1, first + 2});
      if (piece_.triangles.size() == kPieceTriangles) show();
    }
  }

  void finish() override {
    if (!piece_.triangles.empty()) show();
  }

  std::array<double, 3> offset() const override { return piece_.offset; }

 private:
  void show() {
    const Bounds bounds = bounds_of(piece_.vertices);
    for (Seeker& seeker : seekers_) seeker.see(piece_, bounds, threads_);
    piece_.vertices.clear();
    piece_.triangles.clear();
  }

  std::vector<Seeker>& seekers_;
  int threads_;
  std::vector<Point> vertices_;  // of the surface so far
  TriangleMesh piece_;           // with corners of its own for each triangle
};

}  // namespace

std::vector<std::vector<float>> piece_distances(const std::vector<const TriangleMesh*>& meshes,
                                                const SurfacePass& surface, int threads) {
  std::vector<Seeker> seekers(meshes.begin(), meshes.end());
  const auto pass = [&] {
    PieceSink sink(seekers, meshes.front()->offset, threads);
    surface(sink);
  };
  pass();
  if (!std::ranges::all_of(seekers, &Seeker::complete)) {
    for (Seeker& seeker : seekers) seeker.look_everywhere();
    pass();
  }
  std::vector<std::vector<float>> distances;
  distances.reserve(seekers.size());
  for (Seeker& seeker : seekers) distances.push_back(seeker.take());
  return distances;
}

}  // namespace isoweave::cli
