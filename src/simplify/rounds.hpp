// The bulk-synchronous schedule: the rounds of a device, on processors.
#pragma once

#include <vector>

#include "parallel/parallel.hpp"
#include "simplify/driver.hpp"
#include "simplify/round_passes.hpp"

namespace isoweave {

class Rounds final : public Driver {
 public:
  Rounds(Zone& zone, const Executor& executor) : zone_(zone), executor_(executor) {}

  void run(const std::atomic<bool>* stop) override;
  DecisionCounts counts() const override { return counts_; }
  std::uint64_t rounds() const override { return rounds_; }
  void count_removed() override { removed_by_key_.begin(); }
  void add_removed(CostHistogram& sum) const override { removed_by_key_.add_to(sum); }

 private:
  // A list of a round, with room for every vertex.
  struct List {
    std::vector<Index> items;
    std::uint32_t size = 0;

    IndexList view() { return {items.data(), &size}; }
  };

  void run_round(const RoundPasses<VectorArithmetic>& passes);

  Zone& zone_;
  const Executor& executor_;
  std::vector<std::uint32_t> marks_;
  List changed_, candidates_, minima_;
  DecisionCounts counts_;
  CostBits limit_ = kRetiredCost;  // of the last run: turns beyond it have not been kept
  std::uint64_t rounds_ = 0;
  RemovedByKey removed_by_key_;
};

}  // namespace isoweave
