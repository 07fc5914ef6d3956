#include "extract/trilinear_rules.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "extract/shortest_diagonals.hpp"

namespace isoweave {
namespace {

using table_rules::kFaces;

// The values on four parallel edges of a cell, around it, at a place along them.
struct EdgeValues {
  std::array<int, 4> corner{};  // where the edges begin
  int step = 0;                 // to the corner where an edge ends
  std::array<double, 4> low{}, rise{};

  EdgeValues(const CornerValues& values, int axis) : step(1 << axis) {
    const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3;
    corner = {0, u, u | v, v};
    for (std::size_t n = 0; n < 4; ++n) {
      low[n] = values[static_cast<std::size_t>(corner[n])];
      rise[n] = values[static_cast<std::size_t>(corner[n] | step)] - low[n];
    }
  }

  double at(std::size_t n, double t) const { return low[n] + t * rise[n]; }
};

// The quadratic a t^2 + b t + c that tells which corners of a plane across an axis are joined: the product of the first
// and the third value less that of the other two.
struct JoinQuadratic {
  double a = 0, b = 0, c = 0;

  explicit JoinQuadratic(const EdgeValues& e)
      : a(e.rise[0] * e.rise[2] - e.rise[1] * e.rise[3]),
        b(e.low[0] * e.rise[2] + e.low[2] * e.rise[0] - e.low[1] * e.rise[3] - e.low[3] * e.rise[1]),
        c(e.low[0] * e.low[2] - e.low[1] * e.low[3]) {}

  double extremum() const { return -b / (2 * a); }
  double discriminant() const { return b * b - 4 * a * c; }

  // The two roots, in ascending order, within the cell.
  std::array<double, 2> roots() const {
    const double root = std::sqrt(std::max(discriminant(), 0.0));
    const double q = -(b + (b < 0 ? -root : root)) / 2;  // nothing cancels
    double first = q / a, second = q != 0 ? c / q : first;
    if (second < first) std::swap(first, second);
    return {std::clamp(first, 0.0, 1.0), std::clamp(second, 0.0, 1.0)};
  }
};

bool is_corner_inside(std::uint32_t cell, int corner) { return (cell >> corner & 1) != 0; }

// The faces whose inside corners are joined, one bit each. Both cells at a face compare the same two products.
int joined_faces(std::uint32_t cell, const CornerValues& values) {
  int joined = 0;
  for (int face = 0; face < 6; ++face) {
    if (!table_rules::is_ambiguous(static_cast<int>(cell), face)) continue;
    const auto value = [&](int n) { return values[static_cast<std::size_t>(kFaces[face][n])]; };
    const double first = value(0) * value(2);
    const double second = value(1) * value(3);
    const bool first_inside = is_corner_inside(cell, kFaces[face][0]);
    if (first_inside ? first > second : second > first) joined |= 1 << face;
  }
  return joined;
}

// The corners of a cell in sets that are joined on its faces.
class Regions {
 public:
  Regions(std::uint32_t cell, int joined) {
    std::iota(set_.begin(), set_.end(), 0);
    for (int corner = 0; corner < 8; ++corner) {
      for (int step = 1; step < 8; step *= 2) join_if(alike(cell, corner, corner | step), corner, corner | step);
    }
    for (int face = 0; face < 6; ++face) {
      if (!table_rules::is_ambiguous(static_cast<int>(cell), face)) continue;
      const bool inside_joined = (joined >> face & 1) != 0;
      for (int n = 0; n < 2; ++n) {
        const int corner = kFaces[face][n];
        join_if(is_corner_inside(cell, corner) == inside_joined, corner, kFaces[face][n + 2]);
      }
    }
  }

  int of(int corner) const { return set_[static_cast<std::size_t>(corner)]; }

 private:
  static bool alike(std::uint32_t cell, int a, int b) { return is_corner_inside(cell, a) == is_corner_inside(cell, b); }

  void join_if(bool wanted, int a, int b) {
    if (wanted) std::replace(set_.begin(), set_.end(), of(a), int{of(b)});
  }

  std::array<int, 8> set_{};
};

// The regions on the two sides of a loop.
std::pair<int, int> sides_of(const CellLoop& loop, const Regions& regions) {
  const CellEdge edge = kEdgeTable[static_cast<std::size_t>(loop.edges[0])];
  const int low = edge.dx + 2 * edge.dy + 4 * edge.dz;
  return {regions.of(low), regions.of(low | 1 << edge.axis)};
}

// Two corners that are joined through the inside of the cell, or twice the same.
std::pair<int, int> joined_inside(const CornerValues& values) {
  const EdgeValues edges(values, 2);
  const JoinQuadratic quadratic(edges);
  const double t = quadratic.extremum();
  if (!(t > 0 && t < 1 && quadratic.discriminant() > 0)) return {0, 0};
  const auto is_inside = [&](std::size_t n) { return edges.at(n, t) >= 0; };
  if (is_inside(0) != is_inside(2) || is_inside(1) != is_inside(3) || is_inside(0) == is_inside(1)) return {0, 0};
  const auto corner = [&](std::size_t n) {  // the end of an edge that is on the side of its point
    const bool low_alike = (edges.low[n] >= 0) == is_inside(n);
    return low_alike ? edges.corner[n] : edges.corner[n] | edges.step;
  };
  const std::size_t first = quadratic.a < 0 ? 0 : 1;  // a largest value joins the first and the third
  return {corner(first), corner(first + 2)};
}

// Finds the two loops between two regions: each has one of them on one side, and both the same on the other.
void find_tunnel(const Regions& regions, int first, int second, CellTopology& topology) {
  for (std::size_t m = 0; m < topology.loops; ++m) {
    for (std::size_t n = 0; n < topology.loops; ++n) {
      const auto [a, b] = sides_of(topology.loop[m], regions);
      const auto [c, d] = sides_of(topology.loop[n], regions);
      const int beyond = a == first ? b : b == first ? a : -1;
      const int before = c == second ? d : d == second ? c : -2;
      if (beyond != before) continue;
      topology.has_tunnel = true;
      topology.tunnel = {m, n};
    }
  }
}

bool needs_centre(const CellLoop& loop) {
  return !ShortestDiagonals<kCellEdges>(static_cast<std::size_t>(loop.size), [&](std::size_t a, std::size_t b) {
            return table_rules::share_face(loop.edges[a], loop.edges[b]) ? std::numeric_limits<double>::infinity()
                                                                         : 0.0;
          }).exist();
}

}  // namespace

std::uint32_t CellTopology::triangles() const {
  int count = has_tunnel ? 4 + 12 : 0;  // two strips, for two loops
  for (std::size_t n = 0; n < loops; ++n) count += loop[n].size - 2 + (has_centre[n] ? 2 : 0);
  return static_cast<std::uint32_t>(count);
}

std::uint32_t CellTopology::vertices() const {
  return (has_tunnel ? 6U : 0U) + static_cast<std::uint32_t>(std::count(has_centre.begin(), has_centre.end(), true));
}

bool may_differ(std::uint32_t cell) {
  for (int face = 0; face < 6; ++face) {
    if (table_rules::is_ambiguous(static_cast<int>(cell), face)) return true;
  }
  for (int corner = 0; corner < 4; ++corner) {
    const std::uint32_t opposite = 1U << corner | 1U << (7 - corner);
    if (cell == opposite || cell == 255 - opposite) return true;
  }
  return false;
}

CellTopology topology_of(std::uint32_t cell, const CornerValues& values) {
  CellTopology topology;
  const int joined = joined_faces(cell, values);
  table_rules::for_polygons(
      static_cast<int>(cell), [&](const CellLoop& loop) { topology.loop[topology.loops++] = loop; }, joined);
  const bool all_known = std::none_of(values.begin(), values.end(), [](double value) { return value != value; });
  if (all_known && topology.loops > 1) {
    const Regions regions(cell, joined);
    const auto [a, b] = joined_inside(values);
    if (regions.of(a) != regions.of(b)) find_tunnel(regions, regions.of(a), regions.of(b), topology);
  }
  for (std::size_t n = 0; n < topology.loops; ++n) {
    topology.has_centre[n] = !topology.is_in_tunnel(n) && needs_centre(topology.loop[n]);
  }
  return topology;
}

std::array<Vec3, 6> waist_of(const CornerValues& values) {
  std::array<std::array<double, 2>, 3> roots;
  for (int axis = 0; axis < 3; ++axis) {
    roots[static_cast<std::size_t>(axis)] = JoinQuadratic(EdgeValues(values, axis)).roots();
  }
  const auto& [x, y, z] = roots;
  // On the plane at the first root along z the surface is two lines that cross: where, tells which roots along x and y.
  const EdgeValues plane(values, 2);
  const double a = plane.at(0, z[0]), b = plane.at(1, z[0]), c = plane.at(2, z[0]), d = plane.at(3, z[0]);
  const double across = a - b + c - d;
  const std::size_t i = (a - d) / across > (x[0] + x[1]) / 2 ? 1 : 0;
  const std::size_t j = (a - b) / across > (y[0] + y[1]) / 2 ? 1 : 0;
  const std::size_t m = 1 - i, n = 1 - j;
  return {{{x[i], y[j], z[0]},
           {x[m], y[j], z[0]},
           {x[m], y[j], z[1]},
           {x[m], y[n], z[1]},
           {x[i], y[n], z[1]},
           {x[i], y[n], z[0]}}};
}

double interpolant_at(const CornerValues& values, const Vec3& at) {
  const auto along_x = [&](std::size_t corner) { return (1 - at.x) * values[corner] + at.x * values[corner + 1]; };
  const auto along_y = [&](std::size_t corner) { return (1 - at.y) * along_x(corner) + at.y * along_x(corner + 2); };
  return (1 - at.z) * along_y(0) + at.z * along_y(4);
}

Vec3 interpolant_gradient(const CornerValues& values, const Vec3& at) {
  const auto slope = [&](double Vec3::*axis) {  // the interpolant is linear along an axis
    Vec3 low = at, high = at;
    low.*axis = 0;
    high.*axis = 1;
    return interpolant_at(values, high) - interpolant_at(values, low);
  };
  return {slope(&Vec3::x), slope(&Vec3::y), slope(&Vec3::z)};
}

Vec3 nearby_zero(const CornerValues& values, const Vec3& start, double margin) {
  const auto clamped = [&](double x) { return x > margin ? std::min(x, 1 - margin) : margin; };
  Vec3 at = start;
  for (int step = 0; step < 2; ++step) {
    const Vec3 gradient = interpolant_gradient(values, at);
    const double squared = dot(gradient, gradient);
    if (!(squared > 0)) break;
    at = at - (interpolant_at(values, at) / squared) * gradient;
    at = {clamped(at.x), clamped(at.y), clamped(at.z)};
  }
  return at;
}

}  // namespace isoweave
