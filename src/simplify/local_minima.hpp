// The parallel schedule: every vertex waits for its turn.
//
// An edge is decided where its key is a local minimum (the safe rule); whoever is not yet there waits for a vertex that
// comes earlier, and is woken when that vertex has been served. Jones and Plassmann (1993) colour graphs this way.
// There is no global order and there are no rounds: a worker follows the chain of earlier keys from vertex to vertex,
// decides at its end, and goes on with what that has woken, all within a few rings.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "parallel/bucket.hpp"
#include "parallel/parallel.hpp"
#include "simplify/driver.hpp"

namespace isoweave {

class LocalMinima final : public Driver {
 public:
  LocalMinima(Zone& zone, const Executor& executor);
  ~LocalMinima() override;

  void run(const std::atomic<bool>* stop) override;
  DecisionCounts counts() const override;
  std::uint64_t rounds() const override { return rounds_; }

 private:
  class Worker;
  struct Stretch;

  void give_turns_to_old();
  void list_let_through();
  void wake_waiters_of_settled();
  void group_by_place();
  Index awake(std::size_t n) const;
  bool is_in_pair(Index v) const;
  void share_places(std::span<Stretch> stretches) const;
  void fetch_around(std::uint32_t n) const;
  void serve_place(std::size_t place, Worker& worker, const std::atomic<bool>* stop) const;

  Zone& zone_;
  const Executor& executor_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<std::uint16_t> owners_;  // per vertex: the worker that holds it, 0 for none
  CostBits limit_ = kRetiredCost;      // of the run before
  std::vector<Index> woken_;           // vertices that waited for one that has settled, or for a higher limit
  std::vector<std::uint32_t> place_;   // of those settled and those woken, doubled; odd if there is a pair to serve
  std::vector<Index> triangle_;        // one at each of them that has a place
  Buckets places_;                     // of their numbers
  std::uint64_t rounds_ = 0;
};

}  // namespace isoweave
