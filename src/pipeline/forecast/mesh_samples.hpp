// Samples of a mesh: small parts of it that stand for the whole in a forecast.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "isoweave/mesh.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

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

struct MeshSample {
  TriangleMesh mesh;            // without values; nothing where far more triangles are in the ball than should be
  std::uint64_t cut_edges = 0;  // edges beyond which the surface goes on outside of the sample, about
};

// The samples, around vertices in different parts of the mesh: few of a small mesh.
class MeshSamples {
 public:
  static constexpr std::size_t kMost = 16;

  // The mesh has triangles, and must outlive the samples.
  MeshSamples(const TriangleMesh& mesh, const Executor& executor);

  std::size_t count() const { return count_; }
  const SampleBall& ball(std::size_t n) const { return balls_[n]; }

  MeshSample cut(std::size_t n) const;

 private:
  using Mask = std::uint16_t;  // a bit for each sample
  static_assert(kMost <= 16);

  void find_balls(const Executor& executor);
  void mark_vertices(const Executor& executor);
  void list_triangles(const Executor& executor);
  std::array<unsigned, 3> masks_of(std::uint32_t triangle) const;

  const TriangleMesh& mesh_;
  const std::size_t count_;
  const double triangles_;               // of one sample, about
  std::array<SampleBall, kMost> balls_;  // count_ of them
  std::vector<Mask> masks_;              // per vertex: the balls that it is in
  std::vector<std::uint32_t> listed_;    // triangles two corners of which, or all, are in one ball
};

}  // namespace isoweave
