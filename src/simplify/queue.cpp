#include "simplify/queue.hpp"

#include <algorithm>

namespace isoweave {

void flag_front(const Zone& zone, Flags& flags) {
  for (Index h = 0; h < zone.half_edges.size(); ++h) {
    if (!zone.alive(h) || zone.cost[h] != kUnknownCost) continue;
    flags[zone.origin(h)] = 1;
    flags[zone.destination(h)] = 1;
  }
}

void Queue::run(std::span<const Index> edges, CostBits limit, Flags& flags, const std::atomic<bool>* stop) {
  heap_.clear();
  for (const Index h : edges) heap_.push(zone_.cost[h], h);
  while (heap_.pop_group(group_)) {
    decide_group(limit, flags);
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) return;
  }
}

// Edges of equal cost, by tie. What they push costs more, so the group is settled while it runs; entries whose edge has
// gone, moved to another half-edge or got another key are stale.
void Queue::decide_group(CostBits limit, Flags& flags) {
  if (group_.size() > 1) {
    std::sort(group_.begin(), group_.end(),
              [&](RadixHeap::Entry a, RadixHeap::Entry b) { return zone_.tie[a.edge] < zone_.tie[b.edge]; });
  }
  for (const auto [cost, h] : group_) {
    if (!zone_.alive(h) || zone_.cost[h] != cost || !zone_.represents_edge(h)) continue;
    decider_.look_at(h);
    if (flagged(decider_.first(), flags) || flagged(decider_.second(), flags)) {
      flags[decider_.first().vertex] = 1;
      flags[decider_.second().vertex] = 1;
      continue;
    }
    decider_.decide();
    for (int n = 0; n < decider_.changed_count(); ++n) {
      const Index changed = decider_.changed()[static_cast<std::size_t>(n)];
      if (zone_.cost[changed] > limit) continue;
      const Index other = zone_.twin(changed);
      heap_.push(zone_.cost[changed], exists(other) ? std::min(changed, other) : changed);
    }
  }
}

bool Queue::flagged(const Star& star, const Flags& flags) const {
  if (flags[star.vertex]) return true;
  for (int n = 0; n < star.neighbours; ++n) {
    if (flags[star.neighbour[static_cast<std::size_t>(n)]]) return true;
  }
  if (!star.overflow) return false;
  const Index first = zone_.vertices[star.vertex].half_edge;
  Index h = first;
  do {
    if (flags[zone_.destination(h)] || flags[zone_.origin(previous(h))]) return true;
    h = zone_.rotate(h);
  } while (h != first && exists(h));
  return false;
}

}  // namespace isoweave
