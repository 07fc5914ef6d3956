// Simplifying to a number of triangles: exactly the mesh at which the sequential queue would stop.
#pragma once

#include <cstdint>

#include "parallel/parallel.hpp"
#include "simplify/simplifier.hpp"

namespace isoweave {

// Raises the limit on costs step by step. Keys never decrease. So a limit leaves every triangle all of whose vertices
// have dearer edges only, and it lets no more edges collapse than have keys within it. These two bounds tell how far
// the limit can be raised before anything is decided. The cost at which the number is met is never overtaken.
class CountTarget {
 public:
  // The target must be made before anything is appended to the simplifier. head_start: a cost up to which everything is
  // decided at once. It is a guess: where it was too high, has_overshot() tells.
  CountTarget(Simplifier& simplifier, const Executor& executor, std::uint64_t triangles, CostBits head_start)
      : CountTarget(simplifier, executor, triangles, most_held(triangles), head_start) {}
  CountTarget(Simplifier& simplifier, const Executor& executor, std::uint64_t triangles, std::uint64_t most_held,
              CostBits head_start);

  // For a surface of which more will come, after decide(): while the zone holds more than `most_held` triangles,
  // decides more edges if that is possible.
  void thin_out();

  // The most triangles that the zone should hold between two slabs when so many triangles are wanted in the end.
  static std::uint64_t most_held(std::uint64_t triangles) { return triangles + triangles / 4 + 50'000; }

  // For a surface of which more will come: whether so many triangles are final that the head start cannot overshoot.
  // Until then nothing may be handed out.
  bool leaves_enough();

  // For a complete surface, before finish(): whether the head start may have gone beyond the collapse that meets the
  // number. Then this run is of no use, and one with safe_head_start() makes the mesh.
  bool has_overshot();
  CostBits safe_head_start() const;

  // The head start; kUnknownCost if there is none. begin_with(): goes on with that of a saved run.
  CostBits head_start() const { return head_start_; }
  void begin_with(CostBits head_start);

  // For a complete surface: decides edges in order until no more than the number of triangles is left, or until all
  // edges are retired. Then everything is final.
  void finish();

 private:
  CostBits limit_that_leaves(std::uint64_t triangles) const;
  CostBits limit_within(std::uint64_t edges) const;
  void raise_limit(CostBits limit);
  void decide_last();

  Simplifier& simplifier_;
  const Executor& executor_;
  std::uint64_t target_;
  std::uint64_t most_held_;
  CostBits head_start_ = kUnknownCost;
  bool enough_ = false;  // triangles are final
};

}  // namespace isoweave
