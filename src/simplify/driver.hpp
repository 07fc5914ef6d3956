// The interface of every schedule: a driver decides all edges of a zone that can be decided.
#pragma once

#include <atomic>
#include <cstdint>

#include "parallel/parallel.hpp"
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
};

// Gives all vertices their turns.
void give_all_turns(const Zone& zone);

// Gives turns to the vertices whose edges got keys with the last append.
void give_turns(const Zone& zone, const Executor& executor);

}  // namespace isoweave
