// The sequential schedule: one priority queue with flags.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/decide.hpp"
#include "simplify/radix_heap.hpp"

namespace isoweave {

// One flag per vertex of a zone: set where an edge that comes earlier could not be decided.
using Flags = std::vector<std::uint8_t>;

// Flags the incomplete vertices of a zone and their neighbours: the keys of the edges there are not known yet.
void flag_front(const Zone& zone, Flags& flags);

class Queue {
 public:
  Queue(Zone& zone, Quality quality) : zone_(zone), decider_(zone, quality) {}

  // Decides, in the order of their keys, those of `edges` and of the edges that follow from them whose keys are at
  // most `limit` and whose stars hold no flagged vertex. An edge that meets a flag flags its own ends and stays.
  // Edges outside `edges` that conflict with them must have both ends flagged. Stops early when *stop becomes true.
  void run(std::span<const Index> edges, CostBits limit, Flags& flags, const std::atomic<bool>* stop);

  const DecisionCounts& counts() const { return decider_.counts(); }

 private:
  void decide_group(CostBits limit, Flags& flags);
  bool flagged(const Star& star, const Flags& flags) const;

  Zone& zone_;
  Decider decider_;
  RadixHeap heap_;
  std::vector<RadixHeap::Entry> group_;
};

}  // namespace isoweave
