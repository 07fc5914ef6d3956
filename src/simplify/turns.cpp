#include "simplify/turns.hpp"

#include <atomic>

namespace isoweave {
namespace {

// Offers every edge at v, once around.
template <class Offer>
void walk_edges(const Zone& zone, Index v, const Offer& offer) {
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

// The same for the vertex of a star that has not overflowed.
template <class Offer>
void walk_edges(const Zone&, const Star& star, const Offer& offer) {
  const auto faces = static_cast<std::size_t>(star.faces);
  for (std::size_t n = 0; n < faces; ++n) offer(star.out[n]);
  if (star.border) offer(previous(star.out[faces - 1]));
}

// Sets the turn of v from its edges. The walk has no branch on keys: which edge is the least cannot be predicted.
template <class Around>
void set_turn(Zone& zone, Index v, const Around& around) {
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
  std::atomic_ref(zone.turn_keys[v]).store(least, std::memory_order_seq_cst);
}

}  // namespace

void renew_turn(Zone& zone, Index v) { set_turn(zone, v, v); }

void renew_turn(Zone& zone, const Star& star) {
  star.overflow ? set_turn(zone, star.vertex, star.vertex) : set_turn(zone, star.vertex, star);
}

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

void give_all_turns(Zone& zone) {
  for (Index v = 0; v < zone.vertices.size(); ++v) give_turn(zone, v);
}

void give_turns(Zone& zone, const Executor& executor) {
  executor.for_each(static_cast<std::int64_t>(zone.settled.size()), 4096,
                    [&](std::int64_t n) { give_turn(zone, zone.settled[static_cast<std::size_t>(n)]); });
}

}  // namespace isoweave
