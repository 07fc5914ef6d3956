#include "simplify/queue.hpp"

#include <algorithm>

#include "simplify/turns.hpp"

namespace isoweave {

void Queue::run(const std::atomic<bool>* stop) {
  decide(stop);
  give_all_turns(zone_);
  ++rounds_;
}

void Queue::decide(const std::atomic<bool>* stop) {
  offer_live_edges();
  while (removed() < most_removed_ && heap_.pop_group(group_)) {
    decide_group();
    if (stop != nullptr && stop->load(std::memory_order_relaxed)) return;
  }
}

void Queue::offer_live_edges() {
  heap_.clear();
  flags_.resize(zone_.vertices.size());
  for (Index v = 0; v < flags_.size(); ++v) flags_[v] = zone_.states[v] == VertexState::kCut ? 1 : 0;
  for (Index t = 0; t < zone_.triangle_count(); ++t) {
    for (Index h = half_edge(t, 0); h <= half_edge(t, 2); ++h) {
      if (!zone_.alive(h) || zone_.cost(h) > zone_.limit) continue;
      if (zone_.cost(h) == kUnknownCost) {
        flags_[zone_.origin(h)] = 1;
        flags_[zone_.destination(h)] = 1;
      } else if (zone_.represents_edge(h)) {
        heap_.push(zone_.cost(h), h);
      }
    }
  }
}

// Decides edges of equal cost, by tie. Edges that this pushes cost more, so the group is sorted once. An entry is stale
// if its edge has gone, moved to another half-edge or got another key.
void Queue::decide_group() {
  if (group_.size() > 1) {
    std::sort(group_.begin(), group_.end(),
              [&](RadixHeap::Entry a, RadixHeap::Entry b) { return zone_.tie(a.edge) < zone_.tie(b.edge); });
  }
  for (const auto [cost, h] : group_) {
    if (!zone_.alive(h) || zone_.cost(h) != cost || !zone_.represents_edge(h)) continue;
    if (!decider_.look_at(h, [&](const Star& star) { return !flagged(star); })) {
      flags_[zone_.origin(h)] = 1;
      flags_[zone_.destination(h)] = 1;
      continue;
    }
    removed_by_key_.around(cost, decider_.counts(), [&] { decider_.decide(); });
    if (decider_.deferred()) {
      flags_[zone_.origin(h)] = 1;
      flags_[zone_.destination(h)] = 1;
      continue;
    }
    if (removed() >= most_removed_) return;
    for (int n = 0; n < decider_.changed_count(); ++n) {
      const Index changed = decider_.changed()[static_cast<std::size_t>(n)];
      if (zone_.cost(changed) > zone_.limit) continue;
      const Index other = zone_.twin(changed);
      heap_.push(zone_.cost(changed), exists(other) ? std::min(changed, other) : changed);
    }
  }
}

bool Queue::flagged(const Star& star) const {
  return flags_[star.vertex] != 0 || !star.each_neighbour(zone_, [&](Index w) { return flags_[w] == 0; });
}

}  // namespace isoweave
