#include "measure/triangle_tree.hpp"

#include <algorithm>
#include <utility>

namespace isoweave::measure {
namespace {

constexpr std::size_t kLeafTriangles = 4;
constexpr std::int64_t kGrain = 4096;

// Below this sine of an angle the normal of a triangle is rounding noise. Its sides say where it is.
constexpr double kLeastSine = 1e-12;

// The squared distance from the origin to the segment a b.
double squared_distance_to_segment(const Vector& a, const Vector& b) {
  const Vector ab = b - a;
  const double length = dot(ab, ab);
  const double along = length > 0 ? std::clamp(-dot(a, ab) / length, 0.0, 1.0) : 0.0;
  const Vector nearest = a + along * ab;
  return dot(nearest, nearest);
}

}  // namespace

double squared_distance(const Vector& point, const TriangleCorners& triangle) {
  const Vector a = triangle[0] - point;
  const Vector b = triangle[1] - point;
  const Vector c = triangle[2] - point;
  const Vector ab = b - a;
  const Vector ac = c - a;
  const Vector normal = cross(ab, ac);
  const double squared = dot(normal, normal);
  const bool flat = squared > kLeastSine * kLeastSine * dot(ab, ab) * dot(ac, ac);
  // The point lies above the triangle when it is on the inner side of all three edges.
  if (flat && dot(normal, cross(a, b)) >= 0 && dot(normal, cross(b, c)) >= 0 && dot(normal, cross(c, a)) >= 0) {
    const double height = dot(a, normal);
    return height * height / squared;
  }
  return std::min(
      {squared_distance_to_segment(a, b), squared_distance_to_segment(b, c), squared_distance_to_segment(c, a)});
}

void TriangleTree::Box::add(const Point& p) {
  for (std::size_t i = 0; i < 3; ++i) {
    low[i] = std::min(low[i], p[i]);
    high[i] = std::max(high[i], p[i]);
  }
}

bool TriangleTree::Box::meets(const Box& other) const {
  return low[0] <= other.high[0] && other.low[0] <= high[0] && low[1] <= other.high[1] && other.low[1] <= high[1] &&
         low[2] <= other.high[2] && other.low[2] <= high[2];
}

double TriangleTree::Box::squared_distance_from(const Vector& p) const {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double outside = std::max({double{low[i]} - p[i], 0.0, p[i] - double{high[i]}});
    sum += outside * outside;
  }
  return sum;
}

TriangleTree::TriangleTree(const TriangleMesh& mesh, const Executor& executor) : count_(mesh.triangles.size()) {
  while (count_ >> depth_ > kLeafTriangles) ++depth_;
  std::vector<Item> items = items_of(mesh, executor);
  for (std::size_t level = 0; level < depth_; ++level) split_level(items, level, executor);
  corners_.resize(count_);
  numbers_.resize(count_);
  executor.for_each(static_cast<std::int64_t>(count_), kGrain, [&](std::int64_t n) {
    const auto i = static_cast<std::size_t>(n);
    numbers_[i] = items[i].triangle;
    const auto& t = mesh.triangles[numbers_[i]];
    corners_[i] = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  });
  boxes_.resize(std::size_t{2} << depth_);
  for (std::size_t level = depth_ + 1; level > 0; --level) bound_level(level - 1, executor);
}

TriangleTree::Box TriangleTree::box_of(const Corners& corners) {
  Box box;
  for (const Point& p : corners) box.add(p);
  return box;
}

// The centre of each triangle's box. Halves are added, so that huge coordinates do not overflow.
std::vector<TriangleTree::Item> TriangleTree::items_of(const TriangleMesh& mesh, const Executor& executor) {
  std::vector<Item> items(mesh.triangles.size());
  executor.for_each(static_cast<std::int64_t>(items.size()), kGrain, [&](std::int64_t i) {
    Box box;
    for (const std::uint32_t v : mesh.triangles[static_cast<std::size_t>(i)]) box.add(mesh.vertices[v]);
    Item& item = items[static_cast<std::size_t>(i)];
    for (std::size_t axis = 0; axis < 3; ++axis) item.centre[axis] = 0.5F * box.low[axis] + 0.5F * box.high[axis];
    item.triangle = static_cast<std::uint32_t>(i);
  });
  return items;
}

// Splits every node of a level at the median along the longest side of its centres. Ties go by number, so the halves
// are sets that no implementation of nth_element can change.
void TriangleTree::split_level(std::vector<Item>& items, std::size_t level, const Executor& executor) const {
  const std::int64_t nodes = std::int64_t{1} << level;
  executor.for_each(nodes, std::max<std::int64_t>(1, nodes / 512), [&](std::int64_t k) {
    const std::size_t node = static_cast<std::size_t>(k);
    const auto at = [&](std::size_t i) { return items.begin() + static_cast<std::ptrdiff_t>(i); };
    const auto begin = at(first_of(level, node));
    const auto end = at(first_of(level, node + 1));
    Box box;
    std::for_each(begin, end, [&](const Item& item) { box.add(item.centre); });
    std::size_t axis = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      if (double{box.high[i]} - double{box.low[i]} > double{box.high[axis]} - double{box.low[axis]}) axis = i;
    }
    std::nth_element(begin, at(first_of(level + 1, 2 * node + 1)), end, [axis](const Item& a, const Item& b) {
      return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.triangle < b.triangle;
    });
  });
}

// Computes the boxes of a level: of the triangles in leaves, and of the two children elsewhere.
void TriangleTree::bound_level(std::size_t level, const Executor& executor) {
  const std::size_t nodes = std::size_t{1} << level;
  executor.for_each(static_cast<std::int64_t>(nodes), kGrain, [&](std::int64_t k) {
    const std::size_t node = static_cast<std::size_t>(k);
    Box& box = boxes_[nodes + node];
    if (level == depth_) {
      for (std::size_t i = first_of(level, node); i < first_of(level, node + 1); ++i) {
        for (const Point& p : corners_[i]) box.add(p);
      }
      return;
    }
    for (const std::size_t child : {2 * (nodes + node), 2 * (nodes + node) + 1}) {
      box.add(boxes_[child].low);
      box.add(boxes_[child].high);
    }
  });
}

double TriangleTree::squared_distance_from(const Vector& point, std::size_t& hint) const {
  const auto distance_to = [&](std::size_t i) {
    return squared_distance(point, {vector_of(corners_[i][0]), vector_of(corners_[i][1]), vector_of(corners_[i][2])});
  };
  double best = hint == kNoHint ? std::numeric_limits<double>::infinity() : distance_to(hint);
  struct Pending {
    std::size_t node;
    double distance;
  };
  std::array<Pending, 64> stack;  // one open sibling per level, of which there are at most 32
  std::size_t open = 0;
  stack[open++] = {1, 0};
  const std::size_t first_leaf = std::size_t{1} << depth_;
  while (open > 0) {
    const Pending top = stack[--open];
    if (top.distance >= best) continue;
    if (top.node >= first_leaf) {
      const std::size_t leaf = top.node - first_leaf;
      for (std::size_t i = first_of(depth_, leaf); i < first_of(depth_, leaf + 1); ++i) {
        const double distance = distance_to(i);
        if (distance < best) {
          best = distance;
          hint = i;
        }
      }
      continue;
    }
    Pending near{2 * top.node, boxes_[2 * top.node].squared_distance_from(point)};
    Pending far{2 * top.node + 1, boxes_[2 * top.node + 1].squared_distance_from(point)};
    if (far.distance < near.distance) std::swap(near, far);
    stack[open++] = far;
    stack[open++] = near;
  }
  return best;
}

}  // namespace isoweave::measure
