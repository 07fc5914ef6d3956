#include "simplify/turns.hpp"

namespace isoweave {

void renew_turn(Zone& zone, Index v) {
  CostBits least = kRetiredCost;
  Index edge = kNone;
  const auto offer = [&](Index h) {
    const CostBits cost = zone.cost(h);
    if (edge != kNone && (cost > least || (cost == least && zone.tie(h) >= zone.tie(edge)))) return;
    least = cost;
    edge = h;
  };
  const Index first = zone.vertices[v].half_edge;
  Index h = first;
  do {
    offer(h);
    const Index incoming = previous(h);
    h = zone.twin(incoming);
    if (!exists(h)) offer(incoming);
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
