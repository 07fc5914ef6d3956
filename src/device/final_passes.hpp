// How final triangles leave the zone on a device: the passes of Simplifier and HandOver, with one thread for every
// item.
#pragma once

#include "parallel/atomics.hpp"
#include "simplify/simplify_totals.hpp"
#include "simplify/turns.hpp"

namespace isoweave {

struct FinalTotals {
  SurfaceDefects defects;
  std::uint64_t open_edges = 0;

  ISOWEAVE_HD void operator+=(const FinalTotals& other) {
    defects.nonmanifold_edges += other.defects.nonmanifold_edges;
    defects.nonmanifold_vertices += other.defects.nonmanifold_vertices;
    open_edges += other.open_edges;
  }
};

struct FinalPasses {
  static constexpr std::uint32_t kUndecided = 1;
  static constexpr std::uint32_t kNewlyFinal = 2;

  ZoneView zone;
  std::uint32_t* status = nullptr;          // per vertex
  std::uint32_t* corners = nullptr;         // per vertex: of the triangles that are there
  std::uint32_t* triangle_place = nullptr;  // per triangle: 1 if it is final, then its place among those
  std::uint32_t* new_place = nullptr;       // per vertex: 1 if it is new in the piece, then its place among those
  std::uint32_t* known_place = nullptr;     // per vertex: 1 if the piece names it and it is known, then its place
  Index* final_triangles = nullptr;
  Index* final_vertices = nullptr;  // the known ones of the piece, then the new ones
  KnownVertex* out_known = nullptr;
  Vec3* out_positions = nullptr;
  Point* out_normals = nullptr;  // of new vertices; or none
  std::array<std::uint32_t, 3>* out_triangles = nullptr;
  std::uint32_t known_vertices = 0;
  Receipt first_new{};  // of the new vertices

  // Makes a vertex final when all its edges are retired.
  ISOWEAVE_HD void name_vertex(std::int64_t n) {
    const auto v = static_cast<Index>(n);
    VertexState& state = zone.states[v];
    const bool undecided = state == VertexState::kIncomplete || cost_of(zone.turn_keys[v]) <= zone.options.retire;
    const bool newly = !undecided && state != VertexState::kFinal;
    status[v] = (undecided ? kUndecided : 0) | (newly && zone.walkable(v) ? kNewlyFinal : 0);
    if (newly) state = VertexState::kFinal;
    corners[v] = new_place[v] = known_place[v] = 0;
  }

  // Finds the final triangles: those whose vertices are all final.
  ISOWEAVE_HD void name_triangle(std::int64_t t) {
    const Triangle& triangle = zone.triangles[static_cast<std::size_t>(t)];
    triangle_place[t] = 0;
    if (triangle.sides[0].vertex == kNone) return;
    bool undecided = false;
    for (const HalfEdge& side : triangle.sides) {
      const bool waits = (status[side.vertex] & kUndecided) != 0;
      undecided = undecided || waits;
      if (!waits) fetch_add(corners[side.vertex], 1);
    }
    if (undecided) return;
    triangle_place[t] = 1;
    for (const HalfEdge& side : triangle.sides) {
      const bool is_new = zone.vertices[side.vertex].number == kNotHandedOver;
      store_relaxed((is_new ? new_place : known_place)[side.vertex], 1);
    }
  }

  // Inspects a vertex. The faces that name it must be the one fan that a walk around it finds, and its neighbours must
  // differ.
  ISOWEAVE_HD void inspect(std::int64_t n, FinalTotals& totals) {
    const auto v = static_cast<Index>(n);
    if ((status[v] & kNewlyFinal) == 0) return;
    std::uint32_t faces = 0;
    const Index first = zone.vertices[v].half_edge;
    for (Index h = first; exists(h) && faces <= corners[v];) {
      ++faces;
      h = zone.rotate(h);
      if (h == first) break;
    }
    if (faces != corners[v]) ++totals.defects.nonmanifold_vertices;
    turn_rules::walk_edges(zone, v, [&](Index h) {
      const Index w = other_end(zone, h, v);
      bool before = true;  // edges met before h
      turn_rules::walk_edges(zone, v, [&](Index other) {
        before = before && other != h;
        if (before && other_end(zone, other, v) == w && v < w) ++totals.defects.nonmanifold_edges;
      });
    });
  }

  // Lists the final triangles. Their places come from scans: an item is listed where the place grows.
  ISOWEAVE_HD void list_triangle(std::int64_t t) {
    if (triangle_place[t + 1] != triangle_place[t]) final_triangles[triangle_place[t]] = static_cast<Index>(t);
  }
  ISOWEAVE_HD void list_vertex(std::int64_t v) {
    if (known_place[v + 1] != known_place[v]) final_vertices[known_place[v]] = static_cast<Index>(v);
    if (new_place[v + 1] != new_place[v]) final_vertices[known_vertices + new_place[v]] = static_cast<Index>(v);
  }

  // Fills in a vertex of the piece. A new one gets its receipt.
  ISOWEAVE_HD void write_vertex(std::int64_t n) {
    const Index v = final_vertices[n];
    Vertex& vertex = zone.vertices[v];
    if (n < known_vertices) {
      out_known[n] = {vertex.position, {vertex.number, vertex.label}};
      return;
    }
    const std::int64_t place = n - known_vertices;
    out_positions[place] = vertex.position;
    if (out_normals != nullptr) out_normals[place] = zone.normals[v];
    vertex.number = first_new.number + static_cast<std::uint64_t>(place);
    vertex.label = first_new.label + static_cast<std::uint32_t>(place);
  }

  // Fills in a triangle of the piece. Must be called before vertices get their receipts.
  ISOWEAVE_HD void write_triangle(std::int64_t n) {
    const Triangle& triangle = zone.triangles[final_triangles[n]];
    for (std::size_t c = 0; c < 3; ++c) {
      const Index v = triangle.sides[c].vertex;
      const bool is_new = zone.vertices[v].number == kNotHandedOver;
      out_triangles[n][c] = is_new ? known_vertices + new_place[v] : known_place[v];
    }
  }

  // Tells the triangles beside this one that it is gone. Neighbours may leave at the same time.
  ISOWEAVE_HD void close_sides(std::int64_t n, FinalTotals& totals) {
    for (HalfEdge& side : zone.triangles[final_triangles[n]].sides) {
      const Index twin = load_relaxed(side.twin);
      if (twin == kNone) ++totals.open_edges;
      if (exists(twin)) store_relaxed(zone.half(twin).twin, kWritten);
    }
  }

  ISOWEAVE_HD void drop(std::int64_t n) { zone.remove_triangle(final_triangles[n]); }
};

}  // namespace isoweave
