// The octree that a mesh for neuroglancer is cut along. Its nodes are cubes, twice as wide from one level of detail to
// the next. Coordinates in a node are whole numbers of steps, of 16 bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave {

inline constexpr std::int64_t kNodeSteps = 65535;     // a node is as many steps wide
inline constexpr std::int64_t kMiddleOfNode = 32768;  // where neuroglancer cuts a node in two along each axis

// A place in steps from the corner of the octree.
using NodePlace = std::array<std::int64_t, 3>;

// A triangle in its node. Three words are the number of the node along the curve in Z-order, the most significant one
// first; three times three are the corners, the least one first. So triangles that are sorted are in order of nodes.
using NodeTriangle = std::array<std::uint16_t, 12>;

// The number of a node along the curve: bits of x, y and z in turn, those of x the least.
std::uint64_t node_number(const std::array<std::uint32_t, 3>& node);
std::array<std::uint32_t, 3> node_at(std::uint64_t number);
std::uint64_t node_of(const NodeTriangle& triangle);

// The eighth of the node that a triangle lies in, as the last three bits of the number of a node one level below.
std::uint64_t eighth_of(const NodeTriangle& triangle);

// An octree around levels of detail.
class NodeGrid {
 public:
  // corners: of the boxes of all levels. triangles: of each level, finest first. Nodes are so large that one has some
  // 16,000 triangles of the level that has most in its nodes, where they lie as evenly as on half the sides of the box.
  NodeGrid(std::span<const Point> corners, std::span<const std::uint64_t> triangles);

  NodePlace place(const Point& point, std::size_t level) const;

  // The length of a step, and the farthest that place() moves a point, with some room for the digits that tell it.
  double step(std::size_t level) const;
  double error(std::size_t level) const;

  const Point& origin() const { return origin_; }
  float side() const { return side_; }  // of a node of the finest level

 private:
  Point origin_{};
  float side_ = static_cast<float>(kNodeSteps);
};

// Cuts triangles where the sides of nodes are, and as neuroglancer wants it, of all levels but the finest also where
// the sides of their eighths are. The ends of an edge alone decide where the edge is cut, so there are no gaps.
class NodeCutter {
 public:
  explicit NodeCutter(std::size_t level) : eighths_(level > 0) {}

  // The triangles that a triangle falls into. Those with two corners in one place are left out. The same triangles come
  // from whatever corner it begins with. The span is valid until the next call.
  std::span<const NodeTriangle> cut(std::array<NodePlace, 3> corners);

 private:
  using Polygon = std::vector<NodePlace>;

  void cut_along(std::size_t axis, Polygon polygon);
  std::int64_t plane_above(std::int64_t at) const;
  void add(const Polygon& polygon);
  void add_triangle(const std::array<std::uint32_t, 3>& node, std::array<NodePlace, 3> corners);

  bool eighths_;
  std::vector<NodeTriangle> found_;
};

}  // namespace isoweave
