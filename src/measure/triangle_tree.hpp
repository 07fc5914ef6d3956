// A bounding volume hierarchy over the triangles of a mesh, for distances from points.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "measure/geometry.hpp"
#include "parallel/parallel.hpp"

namespace isoweave::measure {

// Exact up to rounding: about 1e-12 of the triangle's size. Degenerate triangles are segments or points.
double squared_distance(const Vector& point, const TriangleCorners& triangle);

// A complete binary tree: node k of level l holds the triangles [n k / 2^l, n (k + 1) / 2^l) of an order made by
// splitting at the median of the longest side, so nodes need no links. The same tree for any number of threads.
class TriangleTree {
 public:
  // For n < 2^32 triangles, at least one.
  TriangleTree(const TriangleMesh& mesh, const Executor& executor);

  static constexpr std::size_t kNoHint = std::numeric_limits<std::size_t>::max();

  // Squared distance to the nearest triangle. `hint` is in: a triangle that may be near, or kNoHint; out: the nearest.
  // It makes runs of neighbouring points faster and changes no result.
  double squared_distance_from(const Vector& point, std::size_t& hint) const;

 private:
  struct Box {
    Point low{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    Point high{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(),
               std::numeric_limits<float>::lowest()};

    void add(const Point& p);
    double squared_distance_from(const Vector& p) const;
  };
  struct Item {
    Point centre;
    std::uint32_t triangle;
  };
  using Corners = std::array<Point, 3>;

  std::size_t first_of(std::size_t level, std::size_t node) const { return (count_ * node) >> level; }
  static std::vector<Item> items_of(const TriangleMesh& mesh, const Executor& executor);
  void split_level(std::vector<Item>& items, std::size_t level, const Executor& executor) const;
  void bound_level(std::size_t level, const Executor& executor);

  std::size_t count_;
  std::size_t depth_ = 0;         // level of the leaves
  std::vector<Corners> corners_;  // in tree order
  std::vector<Box> boxes_;        // of node k of level l at 2^l + k
};

}  // namespace isoweave::measure
