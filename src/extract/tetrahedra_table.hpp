// The 256 cases of a cube that is cut into six tetrahedra around its diagonal (Kuhn, 1960).
//
// Corner c of a cube lies at offset (c & 1, c >> 1 & 1, c >> 2). A tetrahedron is a path from corner 0 to corner 7, one
// axis after the other. An edge goes from a corner along the axes of its direction; 19 edges touch a cube. The
// surface in a tetrahedron is a triangle or a quadrilateral, whose diagonal begins at the crossing with the least id:
// that order is the same in every cube.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "extract/lattice_edges.hpp"

namespace isoweave {

// A row of lattice edges that a row of cubes touches: edges of a direction, in the row and slice at an offset.
struct KuhnEdgeRow {
  std::uint8_t direction, dy, dz;
};

namespace kuhn {

inline constexpr std::size_t kEdgeRows = 14;

constexpr std::array<KuhnEdgeRow, kEdgeRows> make_edge_rows() {
  std::array<KuhnEdgeRow, kEdgeRows> rows{};
  std::size_t count = 0;
  for (std::uint8_t direction = 1; direction < 8; ++direction) {
    for (std::uint8_t offset = 0; offset < 4; ++offset) {
      const auto dy = static_cast<std::uint8_t>(offset & 1), dz = static_cast<std::uint8_t>(offset >> 1);
      if ((dy << 1 & direction) == 0 && (dz << 2 & direction) == 0) rows[count++] = {direction, dy, dz};
    }
  }
  return rows;
}

inline constexpr std::array<KuhnEdgeRow, kEdgeRows> kRows = make_edge_rows();

// An edge between two corners of a tetrahedron.
struct Edge {
  int corner, direction;  // where it begins, and its axes

  // The order of ids.
  constexpr int order() const { return 8 * corner + direction; }
};

constexpr Edge edge_between(int a, int b) { return a < b ? Edge{a, b - a} : Edge{b, a - b}; }

// The place of an edge's crossing among 28 numbers: those at the cube's bit of the 14 rows, then those at the next bit.
constexpr std::uint8_t place_of(Edge edge) {
  for (std::size_t row = 0; row < kEdgeRows; ++row) {
    if (kRows[row].direction != edge.direction || kRows[row].dy != (edge.corner >> 1 & 1)) continue;
    if (kRows[row].dz == edge.corner >> 2) return static_cast<std::uint8_t>(row + (edge.corner & 1) * kEdgeRows);
  }
  throw "an edge without a row";
}

// The places of all edges, by corner and direction.
inline constexpr std::array<std::array<std::uint8_t, 8>, 8> kPlaces = [] {
  std::array<std::array<std::uint8_t, 8>, 8> places{};
  for (int corner = 0; corner < 8; ++corner) {
    for (int direction = 1; direction < 8; ++direction) {
      if ((corner & direction) != 0) continue;
      places[static_cast<std::size_t>(corner)][static_cast<std::size_t>(direction)] = place_of({corner, direction});
    }
  }
  return places;
}();

struct Case {
  std::uint8_t triangles = 0;
  std::array<std::uint8_t, 36> places{};  // of the corners, three a triangle

  constexpr void add(Edge a, Edge b, Edge c) {
    for (const Edge edge : {a, b, c}) {
      places[next_++] = kPlaces[static_cast<std::size_t>(edge.corner)][static_cast<std::size_t>(edge.direction)];
    }
    ++triangles;
  }

 private:
  std::size_t next_ = 0;
};

// Adds the quadrilateral around four crossings, in two triangles.
constexpr void add_quad(const std::array<Edge, 4>& edges, Case& out) {
  std::size_t first = 0;
  for (std::size_t n = 1; n < 4; ++n) {
    if (edges[n].order() < edges[first].order()) first = n;
  }
  const auto at = [&](std::size_t n) { return edges[(first + n) % 4]; };
  out.add(at(0), at(1), at(2));
  out.add(at(0), at(2), at(3));
}

// Adds the surface in a tetrahedron whose corners are oriented: seen from the first one, the others go around
// counter-clockwise as seen from behind them.
constexpr void add_tetrahedron(std::array<int, 4> corners, int inside, Case& out) {
  const auto is_inside = [&](int n) { return (inside >> corners[static_cast<std::size_t>(n)] & 1) != 0; };
  int count = 0;
  for (int n = 0; n < 4; ++n) count += is_inside(n);
  if (count == 0 || count == 4) return;
  // Even permutations bring the corners that differ to the front.
  constexpr int kEven[12][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2}, {1, 3, 2, 0}, {1, 2, 0, 3},
                                {2, 0, 1, 3}, {2, 1, 3, 0}, {2, 3, 0, 1}, {3, 0, 2, 1}, {3, 2, 1, 0}, {3, 1, 0, 2}};
  for (const auto& order : kEven) {
    const bool leads = count == 2 ? is_inside(order[0]) && is_inside(order[1]) : is_inside(order[0]) == (count == 1);
    if (!leads) continue;
    const auto edge = [&](int a, int b) {
      return edge_between(corners[static_cast<std::size_t>(order[a])], corners[static_cast<std::size_t>(order[b])]);
    };
    if (count == 2) return add_quad({edge(0, 2), edge(0, 3), edge(1, 3), edge(1, 2)}, out);
    return count == 1 ? out.add(edge(0, 1), edge(0, 2), edge(0, 3)) : out.add(edge(0, 1), edge(0, 3), edge(0, 2));
  }
}

constexpr Case make_case(int inside) {
  Case out;
  constexpr int kPaths[6][2] = {{1, 2}, {1, 4}, {2, 1}, {2, 4}, {4, 1}, {4, 2}};  // xyz, xzy, yxz, yzx, zxy, zyx
  for (const auto& [first, second] : kPaths) {
    const bool even = (first == 1 && second == 2) || (first == 2 && second == 4) || (first == 4 && second == 1);
    const int a = first, b = first + second;
    add_tetrahedron(even ? std::array{0, a, b, 7} : std::array{0, b, a, 7}, inside, out);
  }
  return out;
}

constexpr std::array<Case, 256> make_cases() {
  std::array<Case, 256> cases{};
  for (int inside = 0; inside < 256; ++inside) cases[static_cast<std::size_t>(inside)] = make_case(inside);
  return cases;
}

}  // namespace kuhn

inline constexpr std::array<kuhn::Case, 256> kTetrahedraTable = kuhn::make_cases();

}  // namespace isoweave
