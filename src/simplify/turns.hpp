// The safe rule by vertices: an edge may be decided when it is the least of both its ends and comes before the least
// edge of every neighbour.
#pragma once

#include "parallel/parallel.hpp"
#include "simplify/zone.hpp"

namespace isoweave {

// Sets cost and edge of v's turn from its edges. v must be complete or final and still there.
void renew_turn(Zone& zone, Index v);

// Turns of the vertices whose edges got keys with the last append.
void give_turns(Zone& zone, const Executor& executor);

// There is an edge to decide at v, and its key is known.
inline bool has_turn(const Zone& zone, Index v) {
  const CostBits cost = zone.turns[v].cost;
  return cost != kUnknownCost && cost <= zone.options().retire;
}

inline Index other_end(const Zone& zone, Index edge, Index v) {
  const Index origin = zone.origin(edge);
  return origin == v ? zone.destination(edge) : origin;
}

inline bool same_edge(const Zone& zone, const Turn& a, const Turn& b) {
  return a.cost == b.cost && zone.tie(a.edge) == zone.tie(b.edge);
}

// a comes before b, whose cost is known. Unknown keys come before all others.
inline bool earlier(const Zone& zone, const Turn& a, const Turn& b) {
  if (a.cost != b.cost) return a.cost < b.cost;
  return a.edge != kNone && b.edge != kNone && zone.tie(a.edge) < zone.tie(b.edge);
}

}  // namespace isoweave
