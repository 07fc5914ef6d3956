// The bulk schedule: rounds of passes over lists, as a device with thousands of threads runs them.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/parallel.hpp"
#include "simplify/driver.hpp"

namespace isoweave {

// Each round looks at the vertices near which a turn has changed, picks the edges that are local minima there, decides
// them all at the same time, and renews the turns that this has changed. Nothing is held exclusively: the stars of
// local minima share no triangle.
class Rounds final : public Driver {
 public:
  Rounds(Zone& zone, Quality quality, const Executor& executor);

  void run(const std::atomic<bool>* stop) override;
  DecisionCounts counts() const override { return counts_; }
  std::uint64_t rounds() const override { return rounds_; }

 private:
  void list_candidates();
  void pick_minima();
  void decide_minima();
  void renew_turns();

  Zone& zone_;
  Quality quality_;
  const Executor& executor_;
  std::vector<std::uint8_t> marks_;  // per vertex: is in the list that is being made
  std::vector<Index> changed_;       // vertices whose turn has changed
  std::vector<Index> candidates_;    // those and their neighbours
  std::vector<Index> minima_;        // half-edges
  DecisionCounts counts_;
  std::uint64_t rounds_ = 0;
};

}  // namespace isoweave
