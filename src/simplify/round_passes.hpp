// Bulk rounds, pass by pass: what a device does with one thread for every item of a list, and the schedule `rounds` on
// processors. Docs/determinism.md has the argument.
//
// A round lists the vertices near which something has changed, picks the local minima among their least edges, decides
// all of these, as their stars share no triangle, and renews the turns of the vertices touched. These vertices are the
// list of changes for the next round. The order of a list means nothing.
#pragma once

#include "simplify/decide.hpp"
#include "simplify/turns.hpp"

namespace isoweave {

// A list that many threads fill at once and that the next pass reads.
struct IndexList {
  Index* items = nullptr;  // room for as many as can be pushed
  std::uint32_t* size = nullptr;

  ISOWEAVE_HD void push(Index item) const { items[fetch_add(*size, 1)] = item; }
  ISOWEAVE_HD Index operator[](std::int64_t n) const { return items[n]; }
};

template <class Arithmetic>
struct RoundPasses {
  static constexpr std::uint32_t kCandidate = 1;
  static constexpr std::uint32_t kChanged = 2;

  ZoneView zone;
  std::uint32_t* marks = nullptr;  // per vertex: the lists that hold it
  IndexList changed;               // vertices whose turn is new
  IndexList candidates;            // vertices whose least edge may have become a local minimum
  IndexList minima;                // edges

  // Pass 1 lists candidates: the n-th changed vertex and its neighbours.
  ISOWEAVE_HD void list_candidates(std::int64_t n) const {
    const Index v = changed[n];
    list(v, kCandidate, candidates);
    if (is_unknown(zone.turn_keys[v]) || !zone.walkable(v)) return;
    each_neighbour(zone, v, [&](Index w) {
      list(w, kCandidate, candidates);
      return true;
    });
  }

  // Pass 2 picks the least edge of the n-th candidate, if it is a local minimum. Where both ends of an edge are
  // candidates, the end with the smaller index looks at it.
  ISOWEAVE_HD void pick_minimum(std::int64_t n) const {
    const Index v = candidates[n];
    const Index edge = zone.turns[v].edge;
    const Index other = other_end(zone, edge, v);
    if (!same_turn(zone, v, other)) return;
    if (other < v && (load_relaxed(marks[other]) & kCandidate) != 0) return;
    if (comes_first(v, v) && comes_first(v, other)) minima.push(edge);
  }

  // Pass 3 decides the n-th minimum, and lists the vertices at whose edges something has changed.
  ISOWEAVE_HD void decide(std::int64_t n, DecisionCounts& counts) const {
    BasicDecider<Arithmetic> decider(zone);
    decider.look_at(minima[n]);
    decider.decide();
    mark(decider.first().vertex, kChanged, changed);
    mark(decider.second().vertex, kChanged, changed);
    if (decider.vanished()) {
      for (std::size_t m = 0; m < 3; ++m) mark(decider.first().neighbour[m], kChanged, changed);
    }
    if (decider.collapsed()) {
      decider.merged().each_neighbour(zone, [&](Index w) {
        list(w, kChanged, changed);
        return true;
      });
    }
    counts += decider.counts();
  }

  // Pass 4 renews the turn of the n-th changed vertex.
  ISOWEAVE_HD void renew(std::int64_t n) const {
    const Index v = changed[n];
    store_relaxed(marks[v], 0);
    if (!exists(zone.vertices[v].half_edge)) {
      zone.turn_keys[v] = kNoTurn;
    } else if (has_turn(zone, v)) {
      renew_turn(zone, v);
    }
  }

  // Pass 4 also clears the marks of candidates, as the next round lists its own.
  ISOWEAVE_HD void forget_candidate(std::int64_t n) const { store_relaxed(marks[candidates[n]], 0); }

 private:
  ISOWEAVE_HD void mark(Index v, std::uint32_t as, const IndexList& in) const {
    if ((fetch_or(marks[v], as) & as) == 0) in.push(v);
  }

  ISOWEAVE_HD void list(Index v, std::uint32_t as, const IndexList& in) const {
    if (has_turn(zone, v)) mark(v, as, in);
  }

  // Whether no neighbour of `end` has a turn that comes before v's.
  ISOWEAVE_HD bool comes_first(Index v, Index end) const {
    return each_neighbour(zone, end, [&](Index w) { return !earlier(zone, w, v); });
  }
};

}  // namespace isoweave
