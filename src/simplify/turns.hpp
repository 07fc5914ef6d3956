// The safe rule by vertices: an edge may be decided when it is the least of both its ends and comes before the least
// edge of every neighbour.
#pragma once

#include "parallel/parallel.hpp"
#include "simplify/star.hpp"
#include "simplify/zone.hpp"

namespace isoweave {

inline constexpr Key kUnknownTurn = 0;  // comes before all others
inline constexpr Key kNoTurn = Key{kRetiredCost} << 32;

// Sets v's turn from its edges. v must be complete or final and still there. Whoever does not own v may read its key
// meanwhile, as an atomic.
void renew_turn(Zone& zone, Index v);

// The same for the vertex of a star that has just been gathered.
void renew_turn(Zone& zone, const Star& star);

// Turns of all vertices.
void give_all_turns(Zone& zone);

// Turns of the vertices whose edges got keys with the last append.
void give_turns(Zone& zone, const Executor& executor);

inline bool is_unknown(Key turn) { return cost_of(turn) == kUnknownCost; }

// There is an edge to decide at v, and its key is known.
inline bool has_turn(const Zone& zone, Index v) {
  const CostBits cost = cost_of(zone.turn_keys[v]);
  return cost != kUnknownCost && cost <= zone.limit();
}

inline Index other_end(const Zone& zone, Index edge, Index v) {
  const Index origin = zone.origin(edge);
  return origin == v ? zone.destination(edge) : origin;
}

// v and w have the same least edge; v has a turn.
inline bool same_turn(const Zone& zone, Index v, Index w) {
  if (zone.turn_keys[v] != zone.turn_keys[w]) return false;
  const Index edge = zone.turns[w].edge;
  return edge != kNone && (edge == zone.turns[v].edge || edge == zone.twin(zone.turns[v].edge));
}

// v's turn comes before w's, which is known.
inline bool earlier(const Zone& zone, Index v, Index w) {
  if (zone.turn_keys[v] != zone.turn_keys[w]) return zone.turn_keys[v] < zone.turn_keys[w];
  const Index a = zone.turns[v].edge;
  const Index b = zone.turns[w].edge;
  return a != kNone && b != kNone && zone.tie_low(a) < zone.tie_low(b);
}

}  // namespace isoweave
