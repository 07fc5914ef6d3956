// The interface of every schedule: a driver decides all edges of a zone that can be decided.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "parallel/parallel.hpp"
#include "simplify/cost_histogram.hpp"
#include "simplify/decide.hpp"
#include "simplify/zone.hpp"

namespace isoweave {

class Driver {
 public:
  Driver() = default;
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;
  virtual ~Driver() = default;

  // Must be called after every append to the zone. Leaves the least key of every vertex in zone.turn_keys. Returns
  // early when *stop becomes true; the zone is of no use then.
  virtual void run(const std::atomic<bool>* stop) = 0;

  virtual DecisionCounts counts() const = 0;

  // The number of passes over lists of vertices or edges so far.
  virtual std::uint64_t rounds() const = 0;

  // Counts the triangles that are removed, by the keys of the decisions, from now on.
  virtual void count_removed() = 0;

  // Adds these counts to a histogram.
  virtual void add_removed(CostHistogram& sum) const = 0;
};

// Removed triangles by the keys of decisions. Counts nothing before it begins.
class RemovedByKey {
 public:
  void begin() { histogram_.emplace(); }
  void add_to(CostHistogram& sum) const {
    if (histogram_) sum.merge(*histogram_);
  }

  void add(CostBits key, std::uint64_t removed) {
    if (histogram_) histogram_->add(key, removed);
  }

  // Lets decide() decide an edge of that key, and notes what it adds to the counts of a decider.
  template <class Decide>
  void around(CostBits key, const DecisionCounts& counts, const Decide& decide) {
    if (!histogram_) return decide();
    const std::uint64_t before = counts.removed;
    decide();
    histogram_->add(key, counts.removed - before);
  }

 private:
  std::optional<CostHistogram> histogram_;
};

// Gives all vertices their turns.
void give_all_turns(const Zone& zone);

// Gives turns to the vertices whose edges got keys with the last append.
void give_turns(const Zone& zone, const Executor& executor);

}  // namespace isoweave
