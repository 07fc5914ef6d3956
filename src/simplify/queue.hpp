// The sequential reference: one priority queue with flags.
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/driver.hpp"
#include "simplify/radix_heap.hpp"

namespace isoweave {

// Offers all live edges in the order of their keys. An edge whose stars hold a flagged vertex flags its own ends and is
// set aside; every other edge is decided. A flag at a vertex says that an edge there comes earlier and could not be
// decided. The first such edges are those whose keys are not known yet.
class Queue final : public Driver {
 public:
  // Stops when at least `most_removed` triangles have been removed.
  Queue(Zone& zone, std::uint64_t most_removed = ~std::uint64_t{0})
      : zone_(zone), decider_(zone), most_removed_(most_removed) {}

  void run(const std::atomic<bool>* stop) override;

  // A run without its end, where no other driver goes on: turns are not renewed.
  void decide(const std::atomic<bool>* stop);

  DecisionCounts counts() const override { return decider_.counts(); }
  std::uint64_t rounds() const override { return rounds_; }
  void count_removed() override { removed_by_key_.begin(); }
  void add_removed(CostHistogram& sum) const override { removed_by_key_.add_to(sum); }

 private:
  void offer_live_edges();
  void decide_group();
  bool flagged(const Star& star) const;
  std::uint64_t removed() const { return decider_.counts().removed; }

  Zone& zone_;
  Decider decider_;
  std::uint64_t most_removed_;
  RadixHeap heap_;
  std::vector<RadixHeap::Entry> group_;
  std::vector<std::uint8_t> flags_;  // per vertex
  std::uint64_t rounds_ = 0;
  RemovedByKey removed_by_key_;
};

}  // namespace isoweave
