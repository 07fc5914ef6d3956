// How triangles become a part of the zone, element by element: twins, first quadrics, first keys. Shared by host and
// device.
#pragma once

#include <cmath>

#include "parallel/atomics.hpp"
#include "simplify/kernels.hpp"

namespace isoweave {

// One side of an edge, in a list of one of its ends.
struct EdgeSide {
  static constexpr Index kBackwards = Index{1} << 31;  // runs from the other end to this one

  Index other = 0;
  Index half_edge = kNone;

  EdgeSide() = default;
  ISOWEAVE_HD EdgeSide(Index other_end, Index h) : other(other_end), half_edge(h) {}

  ISOWEAVE_HD Index other_end() const { return other & ~kBackwards; }
  ISOWEAVE_HD bool backwards() const { return (other & kBackwards) != 0; }
};

// Pairs the sides at one end, sorted by the other end. A good edge has one side, or two that run in opposite
// directions: see_pair(forwards, backwards) is told those half-edges. A bad edge has others: see_bad(half-edge) is
// told.
template <class SeePair, class SeeBad>
ISOWEAVE_HD inline void link_sorted(std::span<const EdgeSide> sides, const SeePair& see_pair, const SeeBad& see_bad) {
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].other_end() == sides[begin].other_end()) ++end;
    if (end - begin == 1) continue;
    const Index a = sides[begin].half_edge;
    const Index b = sides[begin + 1].half_edge;
    if (end - begin == 2 && sides[begin].other != sides[begin + 1].other) {
      sides[begin].backwards() ? see_pair(b, a) : see_pair(a, b);
    } else {
      see_bad(a);
    }
  }
}

// The weight of a face's plane, per twice its area.
ISOWEAVE_HD inline double initial_weight(const ZoneOptions& options) { return 1 / (6 * options.a0 * options.a0); }

// The normal of the face of h, twice as long as its area, as seen from the origin of h.
ISOWEAVE_HD inline Vec3 face_normal(const ZoneView& zone, Index h) {
  const Vec3 from = zone.vertices[zone.origin(h)].position;
  return cross(zone.vertices[zone.destination(h)].position - from,
               zone.vertices[zone.origin(previous(h))].position - from);
}

// The quadric of the plane through the border edge from v to another vertex, perpendicular to its face, weighted by
// squared length.
ISOWEAVE_HD inline Quadric border_plane(const ZoneView& zone, Index v, Index other, Index face) {
  const Vec3 side = zone.vertices[other].position - zone.vertices[v].position;
  const Vec3 across = cross(side, face_normal(zone, face));
  const double size = dot(across, across);
  const double a0 = zone.options.a0;
  return size > 0 ? plane_quadric(across, dot(side, side) / (a0 * a0 * size)) : Quadric();
}

// Turns v's start to where its fan begins: the half-edge without a twin if v lies on a border, else that to the
// neighbour with the smallest id. So a sum over the fan does not depend on the pieces in which its faces came.
ISOWEAVE_HD inline void start_fan(const ZoneView& zone, Index v) {
  const Index first = zone.vertices[v].half_edge;
  Index least = first;
  std::uint64_t least_id = zone.vertices[zone.destination(first)].id;
  Index h = first;
  while (exists(zone.twin(h))) {
    h = next(zone.twin(h));
    if (h == first) break;
    const std::uint64_t id = zone.vertices[zone.destination(h)].id;
    least = id < least_id ? h : least;
    least_id = id < least_id ? id : least_id;
  }
  zone.vertices[v].half_edge = exists(zone.twin(h)) ? least : h;
}

// Planes of the faces around v, weighted by area / 3, from the start of its fan on counter-clockwise; then, on an open
// border, planes through the two border edges perpendicular to their faces.
ISOWEAVE_HD inline void give_initial_quadric(const ZoneView& zone, Index v) {
  start_fan(zone, v);
  const Index first = zone.vertices[v].half_edge;
  Quadric sum;
  Index h = first;
  Index last = h;
  do {
    const Vec3 normal = face_normal(zone, h);
    const double size = sqrt(dot(normal, normal));  // twice the area
    if (size > 0) sum = sum + plane_quadric(normal, initial_weight(zone.options) / size);
    last = h;
    h = zone.rotate(h);
  } while (h != first && exists(h));
  if (zone.twin(first) == kNone) {
    sum = sum + border_plane(zone, v, zone.destination(first), first) +
          border_plane(zone, v, zone.origin(previous(last)), last);
  }
  zone.vertices[v].quadric = sum;
}

ISOWEAVE_HD inline Vec3 normal_at(const ZoneView& zone, Index v) {
  const Point& normal = zone.normals[v];
  return {double{normal[0]}, double{normal[1]}, double{normal[2]}};
}

// Adds what the normals of the faces around v say: after give_initial_quadric, in the order of its faces.
ISOWEAVE_HD inline void give_normal_quadric(const ZoneView& zone, Index v) {
  const double each = initial_weight(zone.options) * kNormalWeight * zone.options.a0;
  const Index first = zone.vertices[v].half_edge;
  const Vec3 from = zone.vertices[v].position;
  Index h = first;
  do {
    const Index corners[2] = {zone.destination(h), zone.origin(previous(h))};
    const Vec3 a = zone.vertices[corners[0]].position - from;
    const Vec3 b = zone.vertices[corners[1]].position - from;
    const double size = sqrt(dot(cross(a, b), cross(a, b)));  // twice the area
    const Vec3 normals[3] = {normal_at(zone, v), normal_at(zone, corners[0]), normal_at(zone, corners[1])};
    if (size > 0) add_face(a, b, normals, each * size, zone.vertices[v].quadric, zone.normal_quadrics[v]);
    h = zone.rotate(h);
  } while (h != first && exists(h));
}

// Costs of collapsing edges.
template <class Arithmetic>
ISOWEAVE_HD inline void edge_costs(const ZoneView& zone, const Arithmetic& arithmetic, std::span<const EdgeEnds> edges,
                                   CostBits* costs) {
  if (zone.normal_quadrics.empty()) return arithmetic.edge_costs(edges, costs);
  const Vertex* const vertices = zone.vertices.data();
  for (std::size_t n = 0; n < edges.size(); ++n) {
    const Vertex& first = *edges[n].first;
    const Vertex& second = *edges[n].second;
    costs[n] = to_cost(collapse_cost(first.quadric, zone.normal_quadrics[static_cast<std::size_t>(&first - vertices)],
                                     second.quadric, zone.normal_quadrics[static_cast<std::size_t>(&second - vertices)],
                                     second.position - first.position));
  }
}

// The ends of an edge, the one with the smaller id first.
ISOWEAVE_HD inline EdgeEnds ends_in_order(const ZoneView& zone, Index a, Index b) {
  const Vertex* const both[2] = {&zone.vertices[a], &zone.vertices[b]};
  const std::size_t first = both[1]->id < both[0]->id ? 1 : 0;  // cannot be predicted
  return {both[first], both[1 - first]};
}

// Gives an edge its tie, and returns it.
ISOWEAVE_HD inline std::uint64_t give_tie(const ZoneView& zone, Index h, const EdgeEnds& ends) {
  const std::uint64_t tie = mix_bits(zone.options.numbering.edge_id(ends.first->id, ends.second->id));
  const Index twin = zone.twin(h);
  zone.triangles[h >> 2].tie_low[h & 3] = static_cast<std::uint32_t>(tie);
  if (exists(twin)) zone.triangles[twin >> 2].tie_low[twin & 3] = static_cast<std::uint32_t>(tie);
  return tie;
}

}  // namespace isoweave
