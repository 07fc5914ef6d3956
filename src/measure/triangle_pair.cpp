#include "measure/triangle_pair.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "measure/orientation.hpp"

namespace isoweave::measure {
namespace {

using Signs = std::array<int, 3>;

int side_of(const TrianglePoints& plane, const Point& p) { return orientation(plane[0], plane[1], plane[2], p); }

Signs sides_of(const TrianglePoints& plane, const TrianglePoints& t) {
  return {side_of(plane, t[0]), side_of(plane, t[1]), side_of(plane, t[2])};
}

bool all_on_one_side(const Signs& signs) { return signs[0] != 0 && signs[0] == signs[1] && signs[1] == signs[2]; }

// An axis along which the triangle is seen with an area; 3 where there is none.
std::size_t axis_with_area(const TrianglePoints& t) {
  std::size_t axis = 0;
  while (axis < 3 && orientation_along(axis, t[0], t[1], t[2]) == 0) ++axis;
  return axis;
}

// Convex sets in a plane are apart when a side of one of them, as a line, has the other one beyond it. The sides of a
// segment are its own line, from both sides.

bool a_side_separates(std::size_t axis, const TrianglePoints& t, std::span<const Point> others) {
  const int inside = orientation_along(axis, t[0], t[1], t[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto beyond = [&](const Point& p) { return orientation_along(axis, t[i], t[(i + 1) % 3], p) == -inside; };
    if (std::all_of(others.begin(), others.end(), beyond)) return true;
  }
  return false;
}

bool meet_in_plane(const TrianglePoints& s, const TrianglePoints& t) {
  const std::size_t axis = axis_with_area(s);
  return !a_side_separates(axis, s, t) && !a_side_separates(axis, t, s);
}

bool segment_meets_in_plane(const std::array<Point, 2>& segment, const TrianglePoints& t) {
  const std::size_t axis = axis_with_area(t);
  const auto side = [&](const Point& p) { return orientation_along(axis, segment[0], segment[1], p); };
  return !all_on_one_side({side(t[0]), side(t[1]), side(t[2])}) && !a_side_separates(axis, t, segment);
}

// A triangle that crosses or touches a plane, turned so that corner 0 is alone on its side: the plane meets the two
// sides that start there. `below`: corner 0 is on the negative side, or it is in the plane and the other corners are
// above it.
struct TurnedTriangle {
  TrianglePoints corners;
  bool below;
};

TurnedTriangle turned(const TrianglePoints& t, const Signs& signs) {
  const auto rotated = [&](int alone, bool below) -> TurnedTriangle {
    const auto first = static_cast<std::size_t>(std::find(signs.begin(), signs.end(), alone) - signs.begin());
    return {{t[first], t[(first + 1) % 3], t[(first + 2) % 3]}, below};
  };
  const auto above = std::count(signs.begin(), signs.end(), 1);
  const auto below = std::count(signs.begin(), signs.end(), -1);
  if (above == 1) return rotated(1, false);
  if (below == 1) return rotated(-1, true);
  return rotated(0, above == 2);
}

}  // namespace

bool has_area(const TrianglePoints& t) { return axis_with_area(t) < 3; }

// Two planes meet in a line, and each triangle has an interval of it. Let both corners 0 lie above the other's plane.
// Along the line, s begins on its side 0-1 and ends on 0-2, and t goes the other way round. Two orientations compare
// the ends of the intervals.
bool triangles_meet(const TrianglePoints& s, const TrianglePoints& t) {
  const Signs sides_of_t = sides_of(s, t);
  if (all_on_one_side(sides_of_t)) return false;
  if (sides_of_t == Signs{}) return meet_in_plane(s, t);
  const Signs sides_of_s = sides_of(t, s);
  if (all_on_one_side(sides_of_s)) return false;
  auto [p, p_below] = turned(s, sides_of_s);
  auto [q, q_below] = turned(t, sides_of_t);
  if (p_below) std::swap(q[1], q[2]);
  if (q_below) std::swap(p[1], p[2]);
  return orientation(p[0], p[1], q[0], q[1]) <= 0 && orientation(p[0], p[2], q[0], q[2]) >= 0;
}

// Both triangles have a segment of the line in which their planes meet, and both segments begin at the vertex v. They
// have more points in common when the segments go the same way. Let n be the normal of v a b and m that of v c d. The
// segment in v a b goes along (m . a) b - (m . b) a = -(m x n) where a lies above m's plane and b below, and the
// opposite way where b lies above. The segment in v c d goes along -(n x m) where c lies above and d below.
bool triangles_meet_beyond_vertex(const TrianglePoints& s, const TrianglePoints& t) {
  const int a = side_of(t, s[1]);
  const int b = side_of(t, s[2]);
  if (a * b > 0) return false;
  if (a == 0 && b == 0) {
    // The common part reaches the side across from the vertex in one of the two triangles.
    return segment_meets_in_plane({s[1], s[2]}, t) || segment_meets_in_plane({t[1], t[2]}, s);
  }
  const int c = side_of(s, t[1]);
  const int d = side_of(s, t[2]);
  return c * d <= 0 && (a > b) != (c > d);
}

// Two triangles in different planes have the line of the edge in common, and no more of it than the edge.
bool triangles_meet_beyond_edge(const TrianglePoints& s, const TrianglePoints& t) {
  if (side_of(s, t[2]) != 0) return false;
  const std::size_t axis = axis_with_area(s);
  return orientation_along(axis, s[0], s[1], s[2]) == orientation_along(axis, s[0], s[1], t[2]);
}

}  // namespace isoweave::measure
