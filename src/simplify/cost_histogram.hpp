// Histograms of costs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "files/state_file.hpp"
#include "simplify/edge_rules.hpp"

namespace isoweave {

// A histogram of the costs of items, in steps of a 128th. Costs have no sign.
class CostHistogram {
 public:
  CostHistogram() : counts_(kSteps, 0) {}

  void add(CostBits cost, std::uint64_t items = 1) { counts_[cost >> kShift] += items; }

  void merge(const CostHistogram& other) {
    for (std::size_t n = 0; n < kSteps; ++n) counts_[n] += other.counts_[n];
  }

  std::uint64_t items() const { return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0}); }

  // The highest cost with no more than `most` items up to it; kUnknownCost if there is none.
  CostBits highest_with_below(std::uint64_t most) const {
    std::uint64_t sum = 0;
    std::size_t step = 0;
    while (step < kSteps && sum + counts_[step] <= most) sum += counts_[step++];
    return step == 0 ? kUnknownCost : static_cast<CostBits>(step << kShift) - 1;
  }

  // The highest cost of the step that follows a cost which highest_with_below() gave.
  static CostBits end_of_next_step(CostBits cost) {
    return cost == kUnknownCost ? (CostBits{1} << kShift) - 1 : cost + (CostBits{1} << kShift);
  }

  // The highest cost with at least `least` items beyond it; kUnknownCost if there is none.
  CostBits highest_with_beyond(std::uint64_t least) const {
    std::uint64_t sum = 0;
    std::size_t step = kSteps;
    while (step > 0 && sum < least) sum += counts_[--step];
    return sum < least || step == 0 ? kUnknownCost : static_cast<CostBits>(step << kShift) - 1;
  }

  // Steps with items: written, and read into an empty histogram. Throws BadInput.
  void serialize(StateWriter& state) const {
    std::vector<Step> steps;
    for (std::size_t n = 0; n < kSteps; ++n) {
      if (counts_[n] > 0) steps.push_back({n, counts_[n]});
    }
    state.list(steps);
  }
  void serialize(StateReader& state) {
    std::vector<Step> steps;
    state.list(steps);
    for (const Step& step : steps) {
      state.require(step.number < kSteps, "costs of collapses");
      counts_[step.number] += step.items;
    }
  }

 private:
  struct Step {
    std::uint64_t number, items;
  };

  static constexpr int kShift = 16;
  static constexpr std::size_t kSteps = std::size_t{1} << (31 - kShift);

  std::vector<std::uint64_t> counts_;
};

}  // namespace isoweave
