// Doubled vertices: at seams, or in every triangle.
#include "isoweave/weld.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "lattice/triangles.hpp"
#include "mesh/read/welder.hpp"

namespace isoweave {
namespace {

// For each vertex the number of its place, and the vertices that come first at their places.
struct Places {
  std::vector<std::uint32_t> number;
  std::vector<Point> points;
};

Places find_places(const std::vector<Point>& vertices) {
  Places places;
  places.number.reserve(vertices.size());
  Welder welder(places.points);
  for (const Point& vertex : vertices) places.number.push_back(welder.number(vertex));
  return places;
}

// Keeps one element for each place: that of its first vertex.
template <class T>
void keep_first(std::vector<T>& list, const Places& places) {
  if (list.empty()) return;
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < places.number.size(); ++v) {
    if (places.number[v] == next) list[next++] = list[v];
  }
  list.resize(next);
}

// An edge between two places, by the triangle's vertices there. Sorting puts the edges of one pair of places together,
// and among them those of the same two vertices.
struct Side {
  std::array<std::uint32_t, 2> places;
  std::array<std::uint32_t, 2> vertices;

  bool operator==(const Side&) const = default;
  bool operator<(const Side& other) const {
    return places != other.places ? places < other.places : vertices < other.vertices;
  }
};

Side side_between(const Places& places, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t at_a = places.number[a], at_b = places.number[b];
  if (at_a < at_b) return {{at_a, at_b}, {a, b}};
  return {{at_b, at_a}, {b, a}};
}

// For each place: whether more than one vertex lies there.
std::vector<bool> crowded_places(const Places& places) {
  std::vector<bool> taken(places.points.size()), crowded(places.points.size());
  for (const std::uint32_t place : places.number) {
    if (taken[place]) crowded[place] = true;
    taken[place] = true;
  }
  return crowded;
}

// The sides that may lie on sides of other vertices. No other side is part of a seam.
std::vector<Side> sides_at_crowded_places(const TriangleMesh& mesh, const Places& places) {
  const std::vector<bool> crowded = crowded_places(places);
  std::vector<Side> sides;
  for (const auto& triangle : mesh.triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Side side = side_between(places, triangle[c], triangle[(c + 1) % 3]);
      const bool may = crowded[side.places[0]] || crowded[side.places[1]];
      if (may && side.places[0] != side.places[1]) sides.push_back(side);
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

// Counts the edges of one triangle among sorted sides of one pair of places.
std::uint64_t border_edges(std::vector<Side>::const_iterator begin, std::vector<Side>::const_iterator end) {
  std::uint64_t count = 0;
  while (begin != end) {
    const auto next = std::find_if(begin, end, [&](const Side& side) { return side != *begin; });
    if (next - begin == 1) ++count;
    begin = next;
  }
  return count;
}

}  // namespace

std::uint64_t weld_vertices(TriangleMesh& mesh) {
  measure::require_indices_in_range(mesh);
  Places places = find_places(mesh.vertices);
  const std::uint64_t gone = mesh.vertices.size() - places.points.size();
  if (gone == 0) return 0;
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = places.number[vertex];
  }
  keep_first(mesh.normals, places);
  keep_first(mesh.values, places);
  mesh.vertices = std::move(places.points);
  return gone;
}

std::uint64_t count_seam_edges(const TriangleMesh& mesh) {
  measure::require_indices_in_range(mesh);
  const Places places = find_places(mesh.vertices);
  if (places.points.size() == mesh.vertices.size()) return 0;
  const std::vector<Side> sides = sides_at_crowded_places(mesh, places);
  std::uint64_t seams = 0;
  for (auto begin = sides.begin(); begin != sides.end();) {
    const auto end = std::find_if(begin, sides.end(), [&](const Side& side) { return side.places != begin->places; });
    const std::uint64_t border = border_edges(begin, end);
    if (border > 1) seams += border;
    begin = end;
  }
  return seams;
}

}  // namespace isoweave
