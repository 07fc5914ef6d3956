#include "simplify/turns.hpp"

#include <atomic>

namespace isoweave {
namespace {

// The least of the edges offered.
class LeastEdge {
 public:
  LeastEdge(const Zone& zone, Index first) : zone_(zone), edge_(first), key_(zone.key(first)) {}

  void offer(Index h) {
    const Key key = zone_.key(h);
    const bool first_of_equals = key == key_ && zone_.tie_low(h) < zone_.tie_low(edge_);
    const bool less = key < key_ || first_of_equals;
    key_ = less ? key : key_;
    edge_ = less ? h : edge_;
  }

  void set_turn(Zone& zone, Index v) const {
    zone.turns[v].edge = edge_;
    std::atomic_ref(zone.turn_keys[v]).store(key_, std::memory_order_seq_cst);
  }

 private:
  const Zone& zone_;
  Index edge_;
  Key key_;
};

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
  const Index first = zone.vertices[v].half_edge;
  LeastEdge least(zone, first);
  for (Index h = zone.rotate(first), before = first; h != first; h = zone.rotate(h)) {
    if (!exists(h)) {
      least.offer(previous(before));
      break;
    }
    least.offer(h);
    before = h;
  }
  least.set_turn(zone, v);
}

void renew_turn(Zone& zone, const Star& star) {
  if (star.overflow) return renew_turn(zone, star.vertex);
  LeastEdge least(zone, star.out[0]);
  const auto faces = static_cast<std::size_t>(star.faces);
  for (std::size_t n = 1; n < faces; ++n) least.offer(star.out[n]);
  if (star.border) least.offer(previous(star.out[faces - 1]));
  least.set_turn(zone, star.vertex);
}

void give_all_turns(Zone& zone) {
  for (Index v = 0; v < zone.vertices.size(); ++v) give_turn(zone, v);
}

void give_turns(Zone& zone, const Executor& executor) {
  executor.for_each(static_cast<std::int64_t>(zone.settled.size()), 4096,
                    [&](std::int64_t n) { give_turn(zone, zone.settled[static_cast<std::size_t>(n)]); });
}

}  // namespace isoweave
