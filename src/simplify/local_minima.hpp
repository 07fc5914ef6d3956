// The parallel schedule: every vertex waits for its turn.
//
// A worker decides an edge whose key is a local minimum (the safe rule). A pair that is not there yet waits for a
// vertex whose turn comes earlier, and is woken when that vertex has been served. Jones and Plassmann (1993) colour
// graphs this way. There is no global order and there are no rounds: a worker follows the chain of earlier keys from
// vertex to vertex, decides the edge at its end, and goes on with the pairs that this has woken, all within a few
// rings.
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
  void count_removed() override;
  void add_removed(CostHistogram& sum) const override;

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
  CostBits limit_ = kRetiredCost;      // of the last run
  std::vector<Index> woken_;           // vertices that waited for one that has settled, or for a higher limit
  std::vector<std::uint32_t> place_;   // columns of settled and woken vertices, doubled; odd: a pair is to be served
  std::vector<Index> triangle_;        // a triangle at each of these vertices that has a column
  Buckets places_;                     // the numbers of these vertices by column
  std::uint64_t rounds_ = 0;
};

}  // namespace isoweave
