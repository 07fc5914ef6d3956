#include "mesh/write/node_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "mesh/write/glb_scene.hpp"

namespace isoweave {
namespace {

constexpr unsigned kNodeBits = 16;   // of a node's number along an axis
constexpr double kMostNodes = 4096;  // along an axis: products of steps stay below 2^63
constexpr double kMeanTriangles = 16384;

std::pair<std::int64_t, std::int64_t> range_along(std::size_t axis, std::span<const NodePlace> places) {
  const auto less = [axis](const NodePlace& a, const NodePlace& b) { return a[axis] < b[axis]; };
  const auto [low, high] = std::minmax_element(places.begin(), places.end(), less);
  return {(*low)[axis], (*high)[axis]};
}

// Where an edge crosses a plane, in whole steps. The ends go by their order along the axis, not by that of the edge.
NodePlace crossing(std::size_t axis, std::int64_t plane, NodePlace low, NodePlace high) {
  if (low[axis] > high[axis]) std::swap(low, high);
  const std::int64_t whole = 2 * (high[axis] - low[axis]);
  const std::int64_t part = plane - low[axis];
  NodePlace place = low;
  for (std::size_t other = 0; other < 3; ++other) {
    const std::int64_t times = 2 * (high[other] - low[other]) * part + whole / 2;
    place[other] += times / whole - static_cast<std::int64_t>(times % whole < 0);
  }
  return place;
}

// The part of a polygon on one side of a plane: side is 1 above it, -1 below it.
std::vector<NodePlace> part_of(std::span<const NodePlace> polygon, std::size_t axis, std::int64_t plane, int side) {
  std::vector<NodePlace> part;
  for (std::size_t n = 0; n < polygon.size(); ++n) {
    const NodePlace& place = polygon[n];
    const NodePlace& next = polygon[(n + 1) % polygon.size()];
    const std::int64_t here = side * (place[axis] - plane);
    const std::int64_t there = side * (next[axis] - plane);
    if (here >= 0) part.push_back(place);
    if ((here < 0 && there > 0) || (here > 0 && there < 0)) part.push_back(crossing(axis, plane, place, next));
  }
  return part;
}

void begin_at_least(std::array<NodePlace, 3>& corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
}

}  // namespace

std::uint64_t node_number(const std::array<std::uint32_t, 3>& node) {
  std::uint64_t number = 0;
  for (unsigned bit = 0; bit < kNodeBits; ++bit) {
    for (unsigned axis = 0; axis < 3; ++axis) number |= std::uint64_t{node[axis] >> bit & 1U} << (3 * bit + axis);
  }
  return number;
}

std::array<std::uint32_t, 3> node_at(std::uint64_t number) {
  std::array<std::uint32_t, 3> node{};
  for (unsigned bit = 0; bit < kNodeBits; ++bit) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      node[axis] |= static_cast<std::uint32_t>(number >> (3 * bit + axis) & 1U) << bit;
    }
  }
  return node;
}

std::uint64_t node_of(const NodeTriangle& triangle) {
  return std::uint64_t{triangle[0]} << 32 | std::uint64_t{triangle[1]} << 16 | std::uint64_t{triangle[2]};
}

std::uint64_t eighth_of(const NodeTriangle& triangle) {
  std::uint64_t eighth = 0;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::uint16_t high = std::max({triangle[3 + axis], triangle[6 + axis], triangle[9 + axis]});
    eighth |= std::uint64_t{high > kMiddleOfNode ? 1U : 0U} << axis;
  }
  return eighth;
}

NodeGrid::NodeGrid(std::span<const Point> corners, std::span<const std::uint64_t> triangles) {
  if (corners.empty()) return;
  Bounds bounds;
  bounds.add(corners);
  origin_ = bounds.low;
  std::array<double, 3> sides{};
  for (std::size_t axis = 0; axis < 3; ++axis) sides[axis] = double{bounds.high[axis]} - double{bounds.low[axis]};
  const double longest = *std::max_element(sides.begin(), sides.end());
  if (longest == 0) return;
  const double area = sides[0] * sides[1] + sides[1] * sides[2] + sides[2] * sides[0];
  double along = 1;
  for (std::size_t level = 0; level < triangles.size(); ++level) {
    const double wanted = std::sqrt(area * kMeanTriangles / static_cast<double>(triangles[level]));
    along = std::max(along, std::ldexp(longest, static_cast<int>(level)) / wanted);
  }
  const auto side = static_cast<float>(longest / std::ceil(std::min(along, kMostNodes)));
  side_ = std::nextafter(side, std::numeric_limits<float>::infinity());  // no point lies behind the last node
}

double NodeGrid::step(std::size_t level) const {
  return std::ldexp(double{side_}, static_cast<int>(level)) / static_cast<double>(kNodeSteps);
}

double NodeGrid::error(std::size_t level) const { return 1.02 * std::sqrt(3.0) / 2 * step(level); }

NodePlace NodeGrid::place(const Point& point, std::size_t level) const {
  const double step = this->step(level);
  NodePlace place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place[axis] = std::llround((double{point[axis]} - double{origin_[axis]}) / step);
  }
  return place;
}

std::span<const NodeTriangle> NodeCutter::cut(std::array<NodePlace, 3> corners) {
  found_.clear();
  begin_at_least(corners);
  cut_along(0, {corners.begin(), corners.end()});
  return found_;
}

// Cuts a polygon along an axis and those behind it, from below.
void NodeCutter::cut_along(std::size_t axis, Polygon polygon) {
  if (axis == 3) return add(polygon);
  for (;;) {
    const auto [low, high] = range_along(axis, polygon);
    const std::int64_t plane = plane_above(low);
    if (high <= plane) return cut_along(axis + 1, std::move(polygon));
    cut_along(axis + 1, part_of(polygon, axis, plane, -1));
    polygon = part_of(polygon, axis, plane, 1);
  }
}

std::int64_t NodeCutter::plane_above(std::int64_t at) const {
  const std::int64_t node = at / kNodeSteps * kNodeSteps;
  return eighths_ && at < node + kMiddleOfNode ? node + kMiddleOfNode : node + kNodeSteps;
}

// Adds a polygon inside a node as a fan. One that lies on the side between two nodes belongs to the lower one.
void NodeCutter::add(const Polygon& polygon) {
  std::array<std::uint32_t, 3> node{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = range_along(axis, polygon);
    const bool between = low == high && low > 0 && low % kNodeSteps == 0;
    node[axis] = static_cast<std::uint32_t>(low / kNodeSteps) - (between ? 1U : 0U);
  }
  for (std::size_t n = 2; n < polygon.size(); ++n) add_triangle(node, {polygon[0], polygon[n - 1], polygon[n]});
}

void NodeCutter::add_triangle(const std::array<std::uint32_t, 3>& node, std::array<NodePlace, 3> corners) {
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) return;
  begin_at_least(corners);
  const std::uint64_t number = node_number(node);
  NodeTriangle& triangle = found_.emplace_back();
  for (unsigned word = 0; word < 3; ++word) triangle[word] = static_cast<std::uint16_t>(number >> (32 - 16 * word));
  for (std::size_t corner = 0; corner < 3; ++corner) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      triangle[3 + 3 * corner + axis] = static_cast<std::uint16_t>(corners[corner][axis] - kNodeSteps * node[axis]);
    }
  }
}

}  // namespace isoweave
