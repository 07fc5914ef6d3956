// The parallel schedule: every vertex waits for its turn.
//
// An edge is decided where its key is a local minimum (the safe rule); whoever is not yet there waits for a vertex that
// comes earlier, and is woken when that vertex has been served. Jones and Plassmann (1993) colour graphs this way.
// There is no global order and there are no rounds: a worker follows the chain of earlier keys from vertex to vertex,
// decides at its end, and goes on with what that has woken, all within a few rings.
#pragma once

#include <memory>
#include <vector>

#include "parallel/bucket.hpp"
#include "parallel/parallel.hpp"
#include "simplify/driver.hpp"

namespace isoweave {

class LocalMinima final : public Driver {
 public:
  LocalMinima(Zone& zone, Quality quality, const Executor& executor);
  ~LocalMinima() override;

  void run(const std::atomic<bool>* stop) override;
  DecisionCounts counts() const override;
  std::uint64_t rounds() const override { return rounds_; }

 private:
  class Worker;

  void wake_neighbourhood();
  void group_by_place();

  Zone& zone_;
  const Executor& executor_;
  std::vector<std::unique_ptr<Worker>> workers_;
  std::vector<std::uint16_t> owners_;  // per vertex: the worker that holds it, 0 for none
  std::vector<Index> awake_;           // vertices to serve
  Buckets places_;                     // of awake_
  std::uint64_t rounds_ = 0;
};

}  // namespace isoweave
