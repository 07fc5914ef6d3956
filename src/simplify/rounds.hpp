// The parallel schedule: rounds over spatial parts.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "parallel/bucket.hpp"
#include "parallel/parallel.hpp"
#include "simplify/queue.hpp"

namespace isoweave {

struct RoundsOptions {
  std::size_t small_zone = 20000;  // below this many live edges one queue is quicker than cutting
  double side = 1;                 // factor on the sides of the cubes
};

// Each round cuts the zone into cubes, flags both ends of the edges that cross a cut, and runs one queue per cube,
// all at the same time. Rounds shift the cuts and climb a ladder of errors: levels nest, and at a small error the
// blocked rim along a cut is thin. What the cuts have blocked to the end is left to one queue.
class Rounds {
 public:
  Rounds(Zone& zone, Quality quality, const Executor& executor, const RoundsOptions& options = {});
  ~Rounds();

  // Decides every edge that can be decided. Stops early when *stop becomes true.
  void run(const std::atomic<bool>* stop);

  DecisionCounts counts() const;
  std::uint64_t rounds() const { return rounds_; }

 private:
  void round(CostBits limit, double side, double shift, const std::atomic<bool>* stop);
  void mark_active(CostBits limit);
  std::size_t assign_parts(double side, double shift);
  void flag_cuts();

  Zone& zone_;
  const Executor& executor_;
  RoundsOptions options_;
  std::vector<std::unique_ptr<Queue>> queues_;
  std::vector<std::uint8_t> active_;  // per vertex: an edge is live at this level
  std::vector<std::uint32_t> part_;   // per vertex
  Flags flags_;
  Buckets parts_;
  std::uint64_t rounds_ = 0;
};

// All live edges of a zone with keys up to `limit`, in memory order.
void list_live_edges(const Zone& zone, CostBits limit, const Executor& executor, Buckets& out);

}  // namespace isoweave
