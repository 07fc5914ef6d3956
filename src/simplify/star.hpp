// The faces around a vertex.
#pragma once

#include <array>
#include <cstring>

#include "simplify/zone_view.hpp"

namespace isoweave {

// Calls visit(w) for every neighbour of v until visit() answers false. Returns whether it never answered false. Keeps
// nothing, where a Star would be read once.
template <class Visit>
ISOWEAVE_HD bool each_neighbour(const ZoneView& zone, Index v, const Visit& visit) {
  const HalfEdge* const halves = &zone.half(0);
  const Index start = zone.vertices[v].half_edge;
  Index h = start;
  do {
    const HalfEdge& from_next = halves[previous(h)];
    if (!visit(from_next.vertex)) return false;
    h = from_next.twin;
  } while (h != start && exists(h));
  return exists(h) || visit(halves[next(start)].vertex);
}

// The faces and neighbours of a vertex, counter-clockwise. Face n lies between neighbours n and n + 1 (modulo the
// number of neighbours in a closed star; an open star has one neighbour more than faces).
struct Star {
  // A star with more faces cannot merge within kMaxValence. It is gathered up to here only.
  static constexpr int kCapacity = 28;
  static constexpr int kPadding = 16;
  static constexpr int kRoom = 64;

  Index vertex = kNone;
  int faces = 0;
  int neighbours = 0;
  bool border = false;
  bool overflow = false;
  std::array<Index, kRoom> out;  // half-edge of face n that starts at the vertex
  std::array<Index, kRoom> neighbour;

  // Gathers the star of v. A closed star starts with half-edge `start`, an open one at its border.
  ISOWEAVE_HD void gather(const ZoneView& zone, Index v, Index start) {
    vertex = v;
    walk(zone, start);
    if (border && start != zone.vertices[v].half_edge) walk(zone, zone.vertices[v].half_edge);
  }

  ISOWEAVE_HD void gather(const ZoneView& zone, Index v) { gather(zone, v, zone.vertices[v].half_edge); }

  // Makes the star that is left of two closed stars, a and b, that start at the edge between them, when that edge
  // collapses into the vertex of a: from the first opposite vertex around a to the second, and around b back to the
  // first. Copies have a fixed size, as the number of faces cannot be predicted.
  ISOWEAVE_HD void join(const Star& a, const Star& b) {
    vertex = a.vertex;
    const auto from_a = static_cast<std::size_t>(a.faces - 2);
    faces = neighbours = a.faces + b.faces - 4;
    border = overflow = false;
    constexpr std::size_t kBytes = kCapacity * sizeof(Index);
    memcpy(&out[0], &a.out[1], kBytes);
    memcpy(&neighbour[0], &a.neighbour[1], kBytes);
    memcpy(&out[from_a], &b.out[1], kBytes);
    memcpy(&neighbour[from_a], &b.neighbour[1], kBytes);
  }

  // The neighbour's place in the list.
  ISOWEAVE_HD std::size_t place_of(Index w) const {
    std::size_t n = 0;
    while (neighbour[n] != w) {
      ++n;
      ISOWEAVE_CHECK(n < count());
    }
    return n;
  }

  // Fills the places past the last neighbour, so that loops can take whole vectors.
  ISOWEAVE_HD void pad(Index with) {
    for (std::size_t n = 0; n < kPadding; ++n) neighbour[count() + n] = with;
  }

  ISOWEAVE_HD std::size_t count() const { return static_cast<std::size_t>(neighbours); }

  // Calls visit(w) for every neighbour, also those past the capacity, until visit() answers false. Returns whether it
  // never answered false.
  template <class Visit>
  ISOWEAVE_HD bool each_neighbour(const ZoneView& zone, const Visit& visit) const {
    for (int n = 0; n < neighbours; ++n) {
      if (!visit(neighbour[static_cast<std::size_t>(n)])) return false;
    }
    return !overflow || isoweave::each_neighbour(zone, vertex, visit);
  }

 private:
  ISOWEAVE_HD void walk(const ZoneView& zone, Index start) {
    const HalfEdge* const halves = &zone.half(0);
    Index h = start;
    std::size_t n = 0;
    neighbour[0] = halves[next(start)].vertex;
    do {
      out[n] = h;
      const HalfEdge& from_next = halves[previous(h)];
      neighbour[++n] = from_next.vertex;
      h = from_next.twin;
    } while (h != start && exists(h) && n < kCapacity);
    faces = static_cast<int>(n);
    overflow = h != start && exists(h);
    border = !exists(h);
    neighbours = faces + (border ? 1 : 0);
  }
};

}  // namespace isoweave
