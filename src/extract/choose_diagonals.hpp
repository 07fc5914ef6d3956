// The diagonals of the polygons of marching cubes, by their geometry: the shortest ones that do not lie in a cell face.
// Shared by host and device.
//
// A polygon of five corners goes around three corners of a cell in an L. Its ear, the corner on the edge at the L's
// elbow, is cut off first: the three edges there are parallel. On the steps of a mask both parts are flat then, and
// simplification leaves fewer triangles.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "extract/shortest_diagonals.hpp"
#include "extract/tables.hpp"
#include "parallel/annotations.hpp"

namespace isoweave {

inline constexpr std::size_t kMostCorners = 7;

// A polygon of a case that has more than three corners.
struct ChoicePolygon {
  std::uint8_t size = 0;
  std::uint8_t first = 0;                              // triangle of the case
  std::array<std::uint8_t, kMostCorners> at{};         // of each corner: its place among the corners of its triangles
  std::array<std::uint8_t, kMostCorners> diagonals{};  // of each corner: a bit for each one that it may be joined to
};

// The polygons of all cases, and where those of a case begin. One more follows the last polygon, and the last case.
struct ChoicePolygons {
  static constexpr std::size_t kCount = 214;
  static constexpr std::size_t kMostOfCase = 2;
  std::array<ChoicePolygon, kCount + 1> polygons{};
  std::array<std::uint16_t, 257> first{};
};

namespace table_rules {

// The corner of a polygon whose edge is parallel to those of both its neighbours, or -1. Five corners of a case have
// one.
constexpr int ear_of(const Polygon& polygon) {
  const auto axis = [&](int n) { return cell_edge(polygon.edges[static_cast<std::size_t>(n % polygon.size)]).axis; };
  for (int n = 0; n < polygon.size; ++n) {
    if (axis(n) == axis(n + 1) && axis(n) == axis(n + polygon.size - 1)) return n;
  }
  return -1;
}

// The corners of a polygon go around it. Those of five begin with the ear.
constexpr ChoicePolygon choice_polygon(const Polygon& polygon, const CellCase& shape, std::size_t first) {
  ChoicePolygon out;
  out.size = static_cast<std::uint8_t>(polygon.size);
  out.first = static_cast<std::uint8_t>(first);
  const std::size_t begin = polygon.size == 5 ? static_cast<std::size_t>(ear_of(polygon)) : 0;
  const auto edge = [&](std::size_t corner) { return polygon.edges[(begin + corner) % out.size]; };
  for (std::size_t a = 0; a < out.size; ++a) {
    while (shape.edges[3 * first + out.at[a]] != edge(a)) ++out.at[a];
    for (std::size_t b = 0; b < out.size; ++b) {
      if (!share_face(edge(a), edge(b))) out.diagonals[a] |= static_cast<std::uint8_t>(1U << b);
    }
  }
  return out;
}

constexpr ChoicePolygons make_choice_polygons() {
  ChoicePolygons out;
  std::size_t count = 0;
  for (int inside = 0; inside < 256; ++inside) {
    out.first[static_cast<std::size_t>(inside)] = static_cast<std::uint16_t>(count);
    std::size_t triangle = 0;
    for_polygons(inside, [&](const Polygon& polygon) {
      if (polygon.size > 3)
        out.polygons[count++] = choice_polygon(polygon, kCaseTable[static_cast<std::size_t>(inside)], triangle);
      triangle += static_cast<std::size_t>(polygon.size) - 2;
    });
  }
  out.first[256] = static_cast<std::uint16_t>(count);
  return out;
}

}  // namespace table_rules

inline constexpr ChoicePolygons kChoicePolygons = table_rules::make_choice_polygons();

// Gives the triangles of a polygon of so many corners, which are those of the table, the shortest diagonals. vertex(n):
// the n-th of their corners, three for each; place(v): where a vertex lies.
template <std::size_t kSize, class Vertex, class Place>
ISOWEAVE_HD inline void choose_diagonals_of(const ChoicePolygon& polygon, const Vertex& vertex, const Place& place) {
  std::uint32_t corners[kSize];
  Vec3 places[kSize];
  for (std::size_t n = 0; n < kSize; ++n) {
    corners[n] = vertex(polygon.at[n]);
    places[n] = place(corners[n]);
  }
  const ShortestDiagonals<kSize> shortest(kSize, [&](std::size_t a, std::size_t b) {
    const bool allowed = (polygon.diagonals[a] >> b & 1) != 0;
    return allowed ? squared_distance(places[a], places[b]) : std::numeric_limits<double>::infinity();
  });
  std::size_t next = 0;
  shortest.for_each_triangle([&](std::size_t a, std::size_t b, std::size_t c) {
    vertex(next++) = corners[a];
    vertex(next++) = corners[b];
    vertex(next++) = corners[c];
  });
}

// One of two numbers, without a branch: which one it is cannot be predicted.
ISOWEAVE_HD inline std::uint32_t either(bool first, std::uint32_t a, std::uint32_t b) {
  return b ^ ((a ^ b) & (0U - std::uint32_t{first}));
}

// Four corners have two diagonals, both of which are allowed. The table has the one from corner 1 to 3.
template <class Vertex, class Place>
ISOWEAVE_HD inline void choose_diagonal(const ChoicePolygon& polygon, const Vertex& vertex, const Place& place) {
  const std::uint32_t a = vertex(polygon.at[0]), b = vertex(polygon.at[1]);
  const std::uint32_t c = vertex(polygon.at[2]), d = vertex(polygon.at[3]);
  const bool from_a = squared_distance(place(a), place(c)) < squared_distance(place(b), place(d));
  const std::uint32_t corners[6] = {a, c, d, a, b, c};
  for (std::size_t n = 0; n < 6; ++n) vertex(n) = either(from_a, corners[n], vertex(n));
}

// Five corners lose their ear, and the four others get the shorter diagonal.
template <class Vertex, class Place>
ISOWEAVE_HD inline void cut_ear(const ChoicePolygon& polygon, const Vertex& vertex, const Place& place) {
  std::uint32_t around[5];  // from the ear on
  for (std::size_t n = 0; n < 5; ++n) around[n] = vertex(polygon.at[n]);
  const auto [a, b, c, d, e] = around;
  const bool from_b = !(squared_distance(place(c), place(e)) < squared_distance(place(b), place(d)));
  const std::uint32_t corners[9] = {a, b, e, b, c, either(from_b, d, e), either(from_b, b, c), d, e};
  for (std::size_t n = 0; n < 9; ++n) vertex(n) = corners[n];
}

template <class Vertex, class Place>
ISOWEAVE_HD inline void choose_diagonals(const ChoicePolygon& polygon, const Vertex& vertex, const Place& place) {
  if (polygon.size == 4) return choose_diagonal(polygon, vertex, place);
  if (polygon.size == 5) return cut_ear(polygon, vertex, place);
  if (polygon.size == 6) return choose_diagonals_of<6>(polygon, vertex, place);
  choose_diagonals_of<7>(polygon, vertex, place);
}

}  // namespace isoweave
