// Two schedules that are too slow to ship and too simple to be wrong.
#pragma once

#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "simplify/turns.hpp"
#include "surfaces.hpp"

namespace isoweave::testing {

inline Index standing_half_edge(const Zone& zone, Index h) {
  const Index twin = zone.twin(h);
  return exists(twin) ? std::min(h, twin) : h;
}

// The reference: an ordered set of all live edges; always decide the first, until so many triangles have gone. For
// complete surfaces.
inline DecisionCounts decide_in_order(Zone& zone, std::uint64_t most_removed = ~std::uint64_t{0}) {
  using Entry = std::tuple<CostBits, std::uint64_t, Index>;
  const CostBits retire = zone.options.retire;
  std::set<Entry> live;
  std::vector<Entry> entry(4 * std::size_t{zone.triangle_count()});
  const auto offer = [&](Index h) {
    if (zone.cost(h) > retire) return;
    entry[h] = {zone.cost(h), zone.tie(h), h};
    live.insert(entry[h]);
  };
  for (Index h = 0; h < 4 * zone.triangle_count(); ++h) {
    if ((h & 3) == 3) continue;
    if (zone.represents_edge(h)) offer(h);
  }
  Decider decider(zone);
  while (!live.empty() && decider.counts().removed < most_removed) {
    const Entry first = *live.begin();
    live.erase(live.begin());
    const Index h = std::get<2>(first);
    const bool stale =
        !zone.alive(h) || !zone.represents_edge(h) || entry[h] != first || zone.cost(h) != std::get<0>(first);
    if (stale) continue;
    decider.look_at(h);
    decider.decide();
    for (int n = 0; n < decider.changed_count(); ++n) {
      offer(standing_half_edge(zone, decider.changed()[static_cast<std::size_t>(n)]));
    }
  }
  give_all_turns(zone);
  return decider.counts();
}

// A sweep of the complete surface by the reference.
inline SurfaceRun reference_run(const SurfaceCase& surface) {
  const Executor executor(1);
  Simplifier simplifier({surface.zone(), Schedule::kQueue}, executor, nullptr);
  DecisionCounts counts;
  SurfaceRun run =
      sweep(surface, kWholeVolume, executor, simplifier, [&] { counts += decide_in_order(simplifier.zone()); });
  run.report.collapses = counts.collapses;
  run.report.postponed = counts.postponed;
  run.report.rekeyed = counts.rekeyed;
  run.report.specks = counts.specks;
  return run;
}

// Keys as the safe rule compares them; unknown keys come before all others.
using Key = std::pair<CostBits, std::uint64_t>;

// Edges whose key is the smallest of all live edges that conflict with them: m1 is the least key at a vertex, m2 the
// least m1 over its closed ring, and an edge is safe when its key is m2 at both ends.
inline std::vector<Index> safe_edges(const Zone& zone) {
  constexpr Key kNothing{0xffffffffu, ~std::uint64_t{0}};
  const CostBits retire = zone.options.retire;
  std::vector<Key> m1(zone.vertices.size(), kNothing);
  for (Index h = 0; h < 4 * zone.triangle_count(); ++h) {
    if ((h & 3) == 3) continue;
    if (!zone.alive(h) || zone.cost(h) > retire) continue;
    const Key key = zone.cost(h) == kUnknownCost ? Key{0, 0} : Key{zone.cost(h), zone.tie(h)};
    for (const Index v : {zone.origin(h), zone.destination(h)}) m1[v] = std::min(m1[v], key);
  }
  for (Index v = 0; v < zone.vertices.size(); ++v) {
    if (zone.states[v] == VertexState::kDeferred) m1[v] = {0, 0};
  }
  std::vector<Key> m2 = m1;
  for (Index h = 0; h < 4 * zone.triangle_count(); ++h) {
    if ((h & 3) == 3) continue;
    if (!zone.alive(h)) continue;
    m2[zone.origin(h)] = std::min(m2[zone.origin(h)], m1[zone.destination(h)]);
    m2[zone.destination(h)] = std::min(m2[zone.destination(h)], m1[zone.origin(h)]);
  }
  std::vector<Index> safe;
  for (Index h = 0; h < 4 * zone.triangle_count(); ++h) {
    if ((h & 3) == 3) continue;
    if (!zone.alive(h) || !zone.represents_edge(h) || zone.cost(h) > retire || zone.cost(h) == kUnknownCost) continue;
    const Key key{zone.cost(h), zone.tie(h)};
    if (m2[zone.origin(h)] == key && m2[zone.destination(h)] == key) safe.push_back(h);
  }
  return safe;
}

// Decides random subsets of the safe edges in random order until none is left.
inline void decide_at_random(Zone& zone, std::mt19937& random) {
  Decider decider(zone);
  for (std::vector<Index> safe = safe_edges(zone); !safe.empty(); safe = safe_edges(zone)) {
    std::shuffle(safe.begin(), safe.end(), random);
    safe.resize(1 + random() % safe.size());
    for (const Index h : safe) {
      decider.look_at(h);
      decider.decide();
    }
  }
  give_all_turns(zone);
}

}  // namespace isoweave::testing
