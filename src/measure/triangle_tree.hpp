// A bounding volume hierarchy over the triangles of a mesh, for distances from points and for pairs of triangles.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "lattice/triangles.hpp"
#include "parallel/parallel.hpp"

namespace isoweave::measure {

// The squared distance from a point to a triangle, exact up to rounding: about 1e-12 of the triangle's size. Degenerate
// triangles are segments or points.
double squared_distance(const Vector& point, const TriangleCorners& triangle);

// A complete binary tree: node k of level l holds the triangles [n k / 2^l, n (k + 1) / 2^l) of an order made by
// splitting at the median of the longest side, so nodes need no links. The same tree for any number of threads.
class TriangleTree {
 public:
  // For n < 2^32 triangles, at least one.
  TriangleTree(const TriangleMesh& mesh, const Executor& executor);

  static constexpr std::size_t kNoHint = std::numeric_limits<std::size_t>::max();

  // The squared distance to the nearest triangle. `hint` is a triangle that may be near, or kNoHint; it becomes the
  // nearest triangle. A hint makes runs of neighbouring points faster and changes no result.
  double squared_distance_from(const Vector& point, std::size_t& hint) const;

  std::size_t leaves() const { return std::size_t{1} << depth_; }

  // Calls visit(i, j) with the numbers of two triangles whose boxes have a point in common: the first lies in this
  // leaf, the second in it or in a later one. Over all leaves every such pair comes once.
  template <class Visit>
  void for_each_near_pair(std::size_t leaf, Visit&& visit) const;

 private:
  struct Box {
    Point low{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(), std::numeric_limits<float>::max()};
    Point high{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(),
               std::numeric_limits<float>::lowest()};

    void add(const Point& p);
    bool meets(const Box& other) const;
    double squared_distance_from(const Vector& p) const;
  };
  struct Item {
    Point centre;
    std::uint32_t triangle;
  };
  using Corners = std::array<Point, 3>;

  std::size_t first_of(std::size_t level, std::size_t node) const { return (count_ * node) >> level; }
  static Box box_of(const Corners& corners);
  template <class Visit>
  void pair_leaves(std::size_t leaf, std::size_t other, Visit&& visit) const;
  static std::vector<Item> items_of(const TriangleMesh& mesh, const Executor& executor);
  void split_level(std::vector<Item>& items, std::size_t level, const Executor& executor) const;
  void bound_level(std::size_t level, const Executor& executor);

  std::size_t count_;
  std::size_t depth_ = 0;               // level of the leaves
  std::vector<Corners> corners_;        // in tree order
  std::vector<std::uint32_t> numbers_;  // in the mesh, in tree order
  std::vector<Box> boxes_;              // of node k of level l at 2^l + k
};

// Walks down from the root, past every node that lies before the leaf or away from it.
template <class Visit>
void TriangleTree::for_each_near_pair(std::size_t leaf, Visit&& visit) const {
  const Box& box = boxes_[leaves() + leaf];
  std::array<std::size_t, 64> stack;  // one open sibling per level, of which there are at most 32
  std::size_t open = 0;
  stack[open++] = 1;
  while (open > 0) {
    const std::size_t node = stack[--open];
    const std::size_t level = static_cast<std::size_t>(std::bit_width(node)) - 1;
    const std::size_t end_leaf = ((node + 1) << (depth_ - level)) - leaves();
    if (end_leaf <= leaf || !boxes_[node].meets(box)) continue;
    if (level == depth_) {
      pair_leaves(leaf, node - leaves(), visit);
    } else {
      stack[open++] = 2 * node + 1;
      stack[open++] = 2 * node;
    }
  }
}

template <class Visit>
void TriangleTree::pair_leaves(std::size_t leaf, std::size_t other, Visit&& visit) const {
  for (std::size_t i = first_of(depth_, leaf); i < first_of(depth_, leaf + 1); ++i) {
    const Box box = box_of(corners_[i]);
    if (!box.meets(boxes_[leaves() + other])) continue;
    for (std::size_t j = std::max(i + 1, first_of(depth_, other)); j < first_of(depth_, other + 1); ++j) {
      if (box.meets(box_of(corners_[j]))) visit(numbers_[i], numbers_[j]);
    }
  }
}

}  // namespace isoweave::measure
