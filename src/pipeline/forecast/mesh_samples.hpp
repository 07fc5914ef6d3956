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

// The samples, around vertices in different parts of the mesh.
class MeshSamples {
 public:
  static constexpr std::size_t kCount = 16;

  // The mesh has triangles, and must outlive the samples.
  MeshSamples(const TriangleMesh& mesh, const Executor& executor);

  double triangles() const { return triangles_; }  // of one sample, about
  const SampleBall& ball(std::size_t n) const { return balls_[n]; }

  // Sample n as a mesh without values. Nothing where far more triangles are as near as those that it should have.
  TriangleMesh cut(std::size_t n) const;

 private:
  using Mask = std::uint16_t;  // a bit for each sample
  static_assert(kCount <= 16);

  void find_balls(const Executor& executor);
  void mark_vertices(const Executor& executor);
  void list_triangles(const Executor& executor);
  unsigned mask_of(std::uint32_t triangle) const;

  const TriangleMesh& mesh_;
  const double triangles_;
  std::array<SampleBall, kCount> balls_;
  std::vector<Mask> masks_;           // per vertex: the balls that it is in
  std::vector<std::uint32_t> inner_;  // triangles that are in a ball
};

}  // namespace isoweave
