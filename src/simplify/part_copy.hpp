// Copies of some triangles of a surface, as a part by itself.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "simplify/zone_part.hpp"

namespace isoweave {

// Calls visit(array of one surface, array of the other) for each array of facts about vertices.
template <class From, class To, class Visit>
void for_vertex_arrays(From& from, To& to, const Visit& visit) {
  visit(from.vertices, to.vertices);
  visit(from.states, to.states);
  visit(from.normals, to.normals);
  visit(from.normal_quadrics, to.normal_quadrics);
  visit(from.values, to.values);
  to.levels.resize(from.levels.size());
  for (std::size_t level = 0; level < from.levels.size(); ++level) visit(from.levels[level], to.levels[level]);
}

// Copies some triangles of a part or a zone, with their vertices. place: per vertex of it, all kNone before and after.
template <class Surface>
ZonePart copy_some(const Surface& surface, const std::vector<Index>& triangles, std::vector<Index>& place) {
  std::vector<Index> vertices;
  for (const Index t : triangles) {
    for (const HalfEdge& side : surface.triangles[t].sides) {
      if (std::exchange(place[side.vertex], 0) == kNone) vertices.push_back(side.vertex);
    }
  }
  for (std::size_t n = 0; n < vertices.size(); ++n) place[vertices[n]] = static_cast<Index>(n);
  ZonePart some;
  for_vertex_arrays(surface, some, [&](const auto& from, auto& to) {
    to.resize(from.empty() ? 0 : vertices.size());
    for (std::size_t n = 0; n < to.size(); ++n) to[n] = from[vertices[n]];
  });
  some.triangles.resize(triangles.size());
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    some.triangles[n] = surface.triangles[triangles[n]];
    for (HalfEdge& side : some.triangles[n].sides) side.vertex = place[side.vertex];
  }
  for (const Index v : vertices) place[v] = kNone;
  return some;
}

}  // namespace isoweave
