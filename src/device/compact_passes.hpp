// How the arrays of the zone are compacted on a device: the passes of Zone::compact, with one thread for every item.
#pragma once

#include "parallel/atomics.hpp"
#include "simplify/zone_view.hpp"

namespace isoweave {

struct CompactPasses {
  ZoneView from, to;
  std::uint32_t* triangle_place = nullptr;  // per triangle: 1 if it stays, then its place
  std::uint32_t* vertex_place = nullptr;    // per vertex: 1 if a triangle uses it, or will, then its place
  Index* front = nullptr;                   // incomplete vertices
  Index* unkeyed = nullptr;                 // half-edges

  ISOWEAVE_HD void keep_front(std::int64_t n) { vertex_place[front[n]] = 1; }

  ISOWEAVE_HD void keep_triangle(std::int64_t t) {
    const Triangle& triangle = from.triangles[static_cast<std::size_t>(t)];
    triangle_place[t] = triangle.sides[0].vertex == kNone ? 0 : 1;
    if (triangle_place[t] == 0) return;
    for (const HalfEdge& side : triangle.sides) store_relaxed(vertex_place[side.vertex], 1);
  }

  ISOWEAVE_HD void move_triangle(std::int64_t n) {
    const auto t = static_cast<std::size_t>(n);
    if (triangle_place[t + 1] == triangle_place[t]) return;
    Triangle triangle = from.triangles[t];
    for (HalfEdge& side : triangle.sides) {
      side.vertex = vertex_place[side.vertex];
      side.twin = moved(side.twin);
    }
    to.triangles[triangle_place[t]] = triangle;
  }

  ISOWEAVE_HD void move_vertex(std::int64_t n) {
    const auto v = static_cast<std::size_t>(n);
    if (vertex_place[v + 1] == vertex_place[v]) return;
    const std::size_t place = vertex_place[v];
    to.vertices[place] = from.vertices[v];
    to.vertices[place].half_edge = moved(from.vertices[v].half_edge);
    to.states[place] = from.states[v];
    to.turn_keys[place] = from.turn_keys[v];
    to.turns[place] = Turn();
    to.turns[place].edge = moved(from.turns[v].edge);
    if (!from.normals.empty()) to.normals[place] = from.normals[v];
  }

  ISOWEAVE_HD void move_front(std::int64_t n) { front[n] = vertex_place[front[n]]; }
  ISOWEAVE_HD void move_unkeyed(std::int64_t n) { unkeyed[n] = moved(unkeyed[n]); }

 private:
  ISOWEAVE_HD Index moved(Index h) const {
    if (!exists(h)) return h;
    const Index t = h >> 2;
    return triangle_place[t + 1] == triangle_place[t] ? kNone : half_edge(triangle_place[t], h & 3);
  }
};

}  // namespace isoweave
