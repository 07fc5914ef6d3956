// The safe rule by vertices: an edge may be decided when it is the least of both its ends and comes before the least
// edge of every neighbour.
#pragma once

#include <algorithm>

#include "parallel/atomics.hpp"
#include "simplify/star.hpp"
#include "simplify/zone_view.hpp"

namespace isoweave {

namespace turn_rules {

// Offers every edge at v, once around.
template <class Offer>
ISOWEAVE_HD inline void walk_edges(const ZoneView& zone, Index v, const Offer& offer) {
  const HalfEdge* const halves = &zone.half(0);
  const Index first = zone.vertices[v].half_edge;
  Index h = first;
  Index before = h;
  do {
    offer(h);
    before = h;
    h = halves[previous(h)].twin;
  } while (h != first && exists(h));
  if (!exists(h)) offer(previous(before));
}

// Offers every edge at the vertex of a star that has not overflowed.
template <class Offer>
ISOWEAVE_HD inline void walk_edges(const ZoneView&, const Star& star, const Offer& offer) {
  const auto faces = static_cast<std::size_t>(star.faces);
  for (std::size_t n = 0; n < faces; ++n) offer(star.out[n]);
  if (star.border) offer(previous(star.out[faces - 1]));
}

// Sets the turn of v from its edges. The walk has no branch on keys: which edge is the least cannot be predicted.
template <class Around>
ISOWEAVE_HD inline void set_turn(const ZoneView& zone, Index v, const Around& around) {
  const HalfEdge* const halves = &zone.half(0);
  Index edge = kNone;
  Key least = ~Key{0};
  bool tied = false;
  walk_edges(zone, around, [&](Index h) {
    const Key key = halves[h].key;
    const bool less = key < least;
    tied = (tied & !less) | (key == least);
    least = less ? key : least;
    edge = less ? h : edge;
  });
  if (tied) {
    walk_edges(zone, around, [&](Index h) {
      if (zone.comes_before(h, edge)) edge = h;
    });
  }
  zone.turns[v].edge = edge;
  publish(zone.turn_keys[v], least);
}

}  // namespace turn_rules

// Sets v's turn from its edges. v must be complete or final and must not have been merged into another vertex. A thread
// that does not own v may read the key of the turn meanwhile, as an atomic.
ISOWEAVE_HD inline void renew_turn(const ZoneView& zone, Index v) { turn_rules::set_turn(zone, v, v); }

// Sets the turn of the vertex of a star that has just been gathered.
ISOWEAVE_HD inline void renew_turn(const ZoneView& zone, const Star& star) {
  star.overflow ? turn_rules::set_turn(zone, star.vertex, star.vertex) : turn_rules::set_turn(zone, star.vertex, star);
}

// Whether a vertex in that state blocks: its turn cannot be known here, or not yet.
ISOWEAVE_HD inline bool blocks(VertexState state) {
  return state == VertexState::kIncomplete || state == VertexState::kDeferred || state == VertexState::kCut;
}

// Sets the turn of a vertex in any state.
ISOWEAVE_HD inline void give_turn(const ZoneView& zone, Index v) {
  if (blocks(zone.states[v])) {
    publish(zone.turn_keys[v], kUnknownTurn);
  } else if (zone.states[v] == VertexState::kLocked || !exists(zone.vertices[v].half_edge)) {
    publish(zone.turn_keys[v], kNoTurn);
  } else {
    renew_turn(zone, v);
  }
}

// The least cost of an edge at a vertex of a triangle.
inline CostBits least_cost(const ZoneView& zone, Index triangle) {
  CostBits least = kRetiredCost;
  for (const HalfEdge& side : zone.triangles[triangle].sides) {
    least = std::min(least, cost_of(zone.turn_keys[side.vertex]));
  }
  return least;
}

ISOWEAVE_HD inline bool is_unknown(Key turn) { return cost_of(turn) == kUnknownCost; }

// Whether v has an edge to decide whose key is known.
ISOWEAVE_HD inline bool has_turn(const ZoneView& zone, Index v) {
  const CostBits cost = cost_of(zone.turn_keys[v]);
  return cost != kUnknownCost && cost <= zone.limit;
}

ISOWEAVE_HD inline Index other_end(const ZoneView& zone, Index edge, Index v) {
  const Index origin = zone.origin(edge);
  return origin == v ? zone.destination(edge) : origin;
}

// Whether v and w have the same least edge, where v has a turn.
ISOWEAVE_HD inline bool same_turn(const ZoneView& zone, Index v, Index w) {
  if (zone.turn_keys[v] != zone.turn_keys[w]) return false;
  const Index edge = zone.turns[w].edge;
  return edge != kNone && (edge == zone.turns[v].edge || edge == zone.twin(zone.turns[v].edge));
}

// Whether v's turn comes before w's, which is known.
ISOWEAVE_HD inline bool earlier(const ZoneView& zone, Index v, Index w) {
  if (zone.turn_keys[v] != zone.turn_keys[w]) return zone.turn_keys[v] < zone.turn_keys[w];
  const Index a = zone.turns[v].edge;
  const Index b = zone.turns[w].edge;
  return a != kNone && b != kNone && zone.tie_low(a) < zone.tie_low(b);
}

}  // namespace isoweave
