#include "simplify/turns.hpp"

namespace isoweave {

void renew_turn(Zone& zone, Index v) {
  CostBits least = kRetiredCost;
  Index edge = kNone;
  const auto offer = [&](CostBits cost, Index h) {
    if (cost > least || (cost == least && edge != kNone && zone.tie(h) >= zone.tie(edge))) return;
    least = cost;
    edge = h;
  };
  const Index first = zone.vertices[v].half_edge;
  Index h = first;
  do {
    const Triangle& triangle = zone.triangles[h >> 2];
    const Index incoming = previous(h);
    offer(triangle.cost[h & 3], h);
    h = triangle.twin[incoming & 3];
    if (!exists(h)) offer(triangle.cost[incoming & 3], incoming);
  } while (h != first && exists(h));
  zone.turns[v].cost = least;
  zone.turns[v].edge = edge;
}

void give_turns(Zone& zone, const Executor& executor) {
  executor.for_each(static_cast<std::int64_t>(zone.settled.size()), 4096, [&](std::int64_t n) {
    const Index v = zone.settled[static_cast<std::size_t>(n)];
    switch (zone.states[v]) {
      case VertexState::kIncomplete:
        zone.turns[v].cost = kUnknownCost;
        break;
      case VertexState::kLocked:
        zone.turns[v].cost = kRetiredCost;
        break;
      default:
        if (exists(zone.vertices[v].half_edge)) renew_turn(zone, v);
    }
  });
}

}  // namespace isoweave
