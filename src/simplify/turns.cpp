#include "simplify/turns.hpp"

#include <atomic>

namespace isoweave {
namespace {

void give_turn(Zone& zone, Index v) {
  if (zone.states[v] == VertexState::kIncomplete) {
    zone.turn_keys[v] = kUnknownTurn;
  } else if (zone.states[v] == VertexState::kLocked || !exists(zone.vertices[v].half_edge)) {
    zone.turn_keys[v] = kNoTurn;
  } else {
    renew_turn(zone, v);
  }
}

}  // namespace

void renew_turn(Zone& zone, Index v) {
  const HalfEdge* const halves = &zone.half(0);
  const Index first = zone.vertices[v].half_edge;
  Index edge = first;
  Key least = halves[first].key;
  const auto offer = [&](Index h) {
    const Key key = halves[h].key;
    const bool first_of_equals = key == least && zone.tie_low(h) < zone.tie_low(edge);
    const bool less = key < least || first_of_equals;
    least = less ? key : least;
    edge = less ? h : edge;
  };
  for (Index h = halves[previous(first)].twin, before = first; h != first;) {
    if (!exists(h)) {
      offer(previous(before));
      break;
    }
    offer(h);
    before = h;
    h = halves[previous(h)].twin;
  }
  std::atomic_ref(zone.turn_keys[v]).store(least, std::memory_order_relaxed);
  zone.turns[v].edge = edge;
}

void give_all_turns(Zone& zone) {
  for (Index v = 0; v < zone.vertices.size(); ++v) give_turn(zone, v);
}

void give_turns(Zone& zone, const Executor& executor) {
  executor.for_each(static_cast<std::int64_t>(zone.settled.size()), 4096,
                    [&](std::int64_t n) { give_turn(zone, zone.settled[static_cast<std::size_t>(n)]); });
}

}  // namespace isoweave
