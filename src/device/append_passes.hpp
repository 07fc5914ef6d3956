// How new triangles become a part of the zone on a device: the passes of Zone::append, with one thread for every item.
#pragma once

#include "simplify/round_passes.hpp"
#include "simplify/scalar_arithmetic.hpp"
#include "simplify/zone_rules.hpp"

namespace isoweave {

struct AppendPasses {
  static constexpr std::uint32_t kFront = 4;  // mark of vertices that later slabs add to; other marks as in RoundPasses
  static constexpr std::uint32_t kSettled = RoundPasses<ScalarArithmetic>::kChanged;

  ZoneView zone;
  Index first_vertex = 0;  // new
  Index first_triangle = 0;
  std::uint32_t* marks = nullptr;      // per vertex
  std::uint32_t* side_base = nullptr;  // per vertex: counts of edge sides, then where they begin
  std::uint32_t* side_fill = nullptr;  // per vertex: the place of the next side
  EdgeSide* sides = nullptr;
  const Index* front = nullptr;  // the new one
  IndexList unkeyed;             // half-edges of older triangles whose edges have no key yet
  IndexList still_unkeyed;
  IndexList settled;  // vertices whose edges may get keys

  // Half-edge n of those that may get a twin: half-edges without a key, then all half-edges of the new triangles.
  ISOWEAVE_HD Index side(std::int64_t n, std::uint32_t old) const {
    if (n < old) return unkeyed[n];
    const auto corner = static_cast<Index>(n - old);
    return half_edge(first_triangle + corner / 3, corner % 3);
  }

  ISOWEAVE_HD bool is_open(std::int64_t n, std::uint32_t old, Index h) const {
    if (n >= old) return true;
    return zone.twin(h) == kNone && is_incomplete(zone.origin(h)) && is_incomplete(zone.destination(h));
  }

  // Counts a side at the end with the smaller number, and offers a new triangle to its vertices to start walks at.
  ISOWEAVE_HD void count_side(std::int64_t n, std::uint32_t old) {
    const Index h = side(n, old);
    if (n >= old) make_least(zone.vertices[zone.origin(h)].half_edge, h);
    if (is_open(n, old, h)) fetch_add(side_base[smaller_end(h)], 1);
  }

  ISOWEAVE_HD void fill_side(std::int64_t n, std::uint32_t old) {
    const Index h = side(n, old);
    if (!is_open(n, old, h)) return;
    const Index from = zone.origin(h);
    const Index to = zone.destination(h);
    sides[fetch_add(side_fill[smaller_end(h)], 1)] = EdgeSide(to < from ? from | EdgeSide::kBackwards : to, h);
  }

  // Pairs the sides listed at the n-th vertex.
  ISOWEAVE_HD void pair_sides(std::int64_t n_vertex) {
    const std::uint32_t begin = side_base[n_vertex];
    const std::uint32_t end = side_base[n_vertex + 1];
    for (std::uint32_t n = begin + 1; n < end; ++n) {
      const EdgeSide side = sides[n];
      std::uint32_t at = n;
      for (; at > begin && side.other_end() < sides[at - 1].other_end(); --at) sides[at] = sides[at - 1];
      sides[at] = side;
    }
    const auto link = [&](Index h, Index back) {
      zone.set_twin(h, back);
      zone.set_twin(back, h);
    };
    link_sorted({sides + begin, end - begin}, link, [](Index) {});
  }

  // Settles the vertices that were incomplete (settle_front) and the vertices beside them (settle_ends); where no turn
  // is known, every complete vertex (settle_held); and the new vertices.
  ISOWEAVE_HD void settle_front(std::int64_t n, const Index* old_front) { settle_old(old_front[n]); }
  ISOWEAVE_HD void settle_ends(std::int64_t n) {
    settle_old(zone.origin(unkeyed[n]));
    settle_old(zone.destination(unkeyed[n]));
  }
  ISOWEAVE_HD void settle_held(std::int64_t v) {
    if (zone.states[static_cast<std::size_t>(v)] == VertexState::kComplete) settle_old(static_cast<Index>(v));
  }
  ISOWEAVE_HD void settle_new(std::int64_t n) { settled.push(first_vertex + static_cast<Index>(n)); }

  ISOWEAVE_HD void mark_front(std::int64_t n) { fetch_or(marks[front[n]], kFront); }

  // Completes a vertex that later slabs do not add to, and gives it its quadric.
  ISOWEAVE_HD void settle_vertex(std::int64_t n) {
    const Index v = settled[n];
    if (!is_incomplete(v) || (marks[v] & kFront) != 0) return;
    zone.states[v] = VertexState::kComplete;
    if (exists(zone.vertices[v].half_edge)) give_initial_quadric(zone, v);
  }

  // Gives an edge its key where both ends are complete. Other edges wait.
  ISOWEAVE_HD void settle_edge(std::int64_t n, std::uint32_t old) {
    const Index h = side(n, old);
    if (n >= old && !zone.represents_edge(h)) return;
    const Index a = zone.origin(h);
    const Index b = zone.destination(h);
    if (is_incomplete(a) || is_incomplete(b)) return still_unkeyed.push(h);
    const EdgeEnds ends = ends_in_order(zone, a, b);
    const std::uint64_t tie = give_tie(zone, h, ends);
    const bool locked = zone.states[a] == VertexState::kLocked || zone.states[b] == VertexState::kLocked;
    CostBits cost = kRetiredCost;
    if (!locked) {
      ScalarArithmetic().edge_costs({&ends, 1}, &cost);
      cost = scaled(cost, key_factors(zone.options.quality).first);
    }
    zone.set_key(h, make_key(cost, tie));
  }

  // Gives a vertex its turn. This pass is the last and clears the marks: rounds begin without marks.
  ISOWEAVE_HD void settle_turn(std::int64_t n) {
    const Index v = settled[n];
    give_turn(zone, v);
    marks[v] = 0;
  }

 private:
  ISOWEAVE_HD void settle_old(Index v) const {
    if ((fetch_or(marks[v], kSettled) & kSettled) == 0) settled.push(v);
  }

  ISOWEAVE_HD bool is_incomplete(Index v) const { return zone.states[v] == VertexState::kIncomplete; }

  ISOWEAVE_HD Index smaller_end(Index h) const {
    const Index a = zone.origin(h);
    const Index b = zone.destination(h);
    return a < b ? a : b;
  }
};

}  // namespace isoweave
