// The 256 marching-cubes cases, generated from one rule (Lorensen and Cline, 1987; face rule as in Bloomenthal, 1988).
//
// A cell has 8 corners, corner c at offset (c & 1, c >> 1 & 1, c >> 2), and 12 edges. Bit c of a case is set when
// corner c is inside. On every face the crossings are joined in pairs; on an ambiguous face (inside corners on a
// diagonal) inside corners are kept apart. The rule sees the four corners of the face only, so both cells at a
// face draw the same segments and the surface closes. Segments chain into polygons, counter-clockwise seen from
// outside.
//
// Polygons are triangulated without any diagonal that lies in a cell face: the cell behind that face could pick the
// same diagonal, and the edge would have four triangles. The table has one triangulation; polygons with a choice are
// listed beside it, and get the shortest diagonals where they are (choose_diagonals.hpp).
#pragma once

#include <array>
#include <cstdint>

namespace isoweave {

inline constexpr int kCellEdges = 12;
inline constexpr int kMaxCellTriangles = 5;

// The lattice edge behind a cell edge: axis and offset of its lower end from the cell's corner 0.
struct CellEdge {
  std::uint8_t axis, dx, dy, dz;
};

struct CellCase {
  std::uint8_t triangles = 0;
  std::array<std::uint8_t, 3 * kMaxCellTriangles> edges{};  // three cell edges per triangle
};

namespace table_rules {

// Edge 4 * axis + n: the n-th combination of offsets along the two other axes.
constexpr CellEdge cell_edge(int edge) {
  const int axis = edge / 4;
  const auto low = static_cast<std::uint8_t>(edge & 1);
  const auto high = static_cast<std::uint8_t>(edge >> 1 & 1);
  if (axis == 0) return {0, 0, low, high};
  if (axis == 1) return {1, low, 0, high};
  return {2, low, high, 0};
}

// The edge between two neighbouring corners.
constexpr int edge_between(int a, int b) {
  const int axis = (a ^ b) >> 1;  // 1, 2, 4 -> 0, 1, 2
  const int x = a & 1, y = a >> 1 & 1, z = a >> 2 & 1;
  return 4 * axis + (axis == 0 ? y + 2 * z : axis == 1 ? x + 2 * z : x + 2 * y);
}

// Corners of the faces x=0, x=1, y=0, y=1, z=0, z=1, counter-clockwise seen from outside the cell.
inline constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

constexpr bool on_face(int edge, int face) {
  const CellEdge e = cell_edge(edge);
  const int offset[3] = {e.dx, e.dy, e.dz};
  return e.axis != face / 2 && offset[face / 2] == (face & 1);
}

constexpr bool share_face(int edge, int other) {
  for (int face = 0; face < 6; ++face) {
    if (on_face(edge, face) && on_face(other, face)) return true;
  }
  return false;
}

// Whether inside corners lie on a diagonal of a face.
constexpr bool is_ambiguous(int inside, int face) {
  const auto is_inside = [&](int n) { return (inside >> kFaces[face][n] & 1) != 0; };
  return is_inside(0) == is_inside(2) && is_inside(1) == is_inside(3) && is_inside(0) != is_inside(1);
}

// next[e] is the crossing that follows crossing e on its polygon, or -1 where edge e is not crossed. Around a face, one
// segment cuts off each run of inside corners, from where the run is entered to where it is left. Where the inside
// corners of an ambiguous face are joined (its bit of `joined` is set), segments cut off the outside corners.
constexpr std::array<int, kCellEdges> chain_segments(int inside, int joined = 0) {
  std::array<int, kCellEdges> next{};
  next.fill(-1);
  for (int f = 0; f < 6; ++f) {
    const auto& face = kFaces[f];
    for (int n = 0; n < 4; ++n) {
      const bool enters = !(inside >> face[n] & 1) && (inside >> face[(n + 1) % 4] & 1);
      if (!enters) continue;
      int last = n + 1;
      while (inside >> face[(last + 1) % 4] & 1) ++last;
      if ((joined >> f & 1) != 0) last = n + 3;  // the segment ends on the other side of the outside corner
      next[static_cast<std::size_t>(edge_between(face[n], face[(n + 1) % 4]))] =
          edge_between(face[last % 4], face[(last + 1) % 4]);
    }
  }
  return next;
}

struct Polygon {
  int size = 0;
  std::array<int, kCellEdges> edges{};
};

// Triangulates vertices first...last of a polygon, whose side (first, last) is given: tries every apex in turn and
// undoes a choice that leads nowhere. Polygons have at most 7 vertices.
constexpr bool triangulate(const Polygon& polygon, int first, int last, CellCase& out) {
  if (last - first < 2) return true;
  const auto allowed = [&](int a, int b) {
    return b - a == 1 ||
           !share_face(polygon.edges[static_cast<std::size_t>(a)], polygon.edges[static_cast<std::size_t>(b)]);
  };
  for (int apex = first + 1; apex < last; ++apex) {
    if (!allowed(first, apex) || !allowed(apex, last)) continue;
    const std::uint8_t before = out.triangles;
    const std::size_t slot = 3 * static_cast<std::size_t>(out.triangles++);
    const int corners[3] = {first, apex, last};
    for (std::size_t n = 0; n < 3; ++n) {
      out.edges[slot + n] = static_cast<std::uint8_t>(polygon.edges[static_cast<std::size_t>(corners[n])]);
    }
    if (triangulate(polygon, first, apex, out) && triangulate(polygon, apex, last, out)) return true;
    out.triangles = before;
  }
  return false;
}

// Calls visit(polygon) for the polygons of a case, in the order of their least cell edges.
template <class Visit>
constexpr void for_polygons(int inside, const Visit& visit, int joined = 0) {
  std::array<int, kCellEdges> next = chain_segments(inside, joined);
  for (std::size_t start = 0; start < kCellEdges; ++start) {
    Polygon polygon;
    for (int edge = static_cast<int>(start); next[static_cast<std::size_t>(edge)] >= 0;) {
      polygon.edges[static_cast<std::size_t>(polygon.size++)] = edge;
      const int following = next[static_cast<std::size_t>(edge)];
      next[static_cast<std::size_t>(edge)] = -1;
      edge = following;
    }
    if (polygon.size > 0) visit(polygon);
  }
}

constexpr CellCase make_case(int inside) {
  CellCase out;
  for_polygons(inside, [&](const Polygon& polygon) {
    if (!triangulate(polygon, 0, polygon.size - 1, out)) throw "a polygon without a triangulation";
  });
  return out;
}

constexpr std::array<CellCase, 256> make_cases() {
  std::array<CellCase, 256> cases{};
  for (int inside = 0; inside < 256; ++inside) cases[static_cast<std::size_t>(inside)] = make_case(inside);
  return cases;
}

constexpr std::array<CellEdge, kCellEdges> make_edges() {
  std::array<CellEdge, kCellEdges> edges{};
  for (int edge = 0; edge < kCellEdges; ++edge) edges[static_cast<std::size_t>(edge)] = cell_edge(edge);
  return edges;
}

}  // namespace table_rules

inline constexpr std::array<CellEdge, kCellEdges> kEdgeTable = table_rules::make_edges();
inline constexpr std::array<CellCase, 256> kCaseTable = table_rules::make_cases();

}  // namespace isoweave
