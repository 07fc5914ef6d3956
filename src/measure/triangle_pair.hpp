// Whether two triangles have more points in common than the vertices that they share. Exact: every answer is made of
// signs of orientations. Triangles are closed sets, so touching is meeting; all have an area.
#pragma once

#include <array>

#include "isoweave/mesh.hpp"

namespace isoweave::measure {

using TrianglePoints = std::array<Point, 3>;

// Whether the corners do not lie on one line.
bool has_area(const TrianglePoints& t);

// Whether two triangles without a common vertex have a point in common (Devillers, Guigue 2002).
bool triangles_meet(const TrianglePoints& s, const TrianglePoints& t);

// Whether two triangles have a second point in common, where s[0] and t[0] are one vertex.
bool triangles_meet_beyond_vertex(const TrianglePoints& s, const TrianglePoints& t);

// Whether two triangles have a point in common off their edge, where s[0] and t[0] are one vertex and s[1] and t[1]
// another.
bool triangles_meet_beyond_edge(const TrianglePoints& s, const TrianglePoints& t);

}  // namespace isoweave::measure
