// Simplifying to a number of triangles: exactly the mesh at which the sequential queue would stop.
#pragma once

#include <cstdint>

#include "parallel/parallel.hpp"
#include "simplify/cost_histogram.hpp"
#include "simplify/simplifier.hpp"
#include "simplify/triangle_goal.hpp"

namespace isoweave {

// The costs that a run to a number of triangles begins with.
struct HeadStart {
  CostBits cost = kUnknownCost;  // everything up to it is decided at once; kUnknownCost: nothing is
  // A cost up to which the number is known to be met, or the run is not to go further; kUnknownCost: no such cost is
  // known. What no decision up to it changes need not be held.
  CostBits met = kUnknownCost;
  // The runs that have counted and made no mesh, to find the head start of one that does, with this one; 0: this run
  // makes the mesh.
  std::uint32_t counts = 0;
  std::uint64_t of = 0;      // the triangles of the surface, where they have been counted; else 0
  std::uint64_t number = 0;  // the number that a share is, where it is known; else 0

  // The head start of a run that counts what is removed up to a cost.
  static HeadStart counting(CostBits cost, std::uint32_t counts = 1) { return {cost, cost, counts}; }
};

// Raises the limit on costs step by step. Keys never decrease. So a limit leaves every triangle all of whose vertices
// have dearer edges only, and it lets no more edges collapse than have keys within it. These two bounds tell how far
// the limit can be raised before anything is decided. The cost at which the number is met is never overtaken.
class CountTarget {
 public:
  // The target must be made before anything is appended to the simplifier. The cost of a head start is a guess, unless
  // it was counted: where it was too high, has_overshot() tells.
  CountTarget(Simplifier& simplifier, const Executor& executor, const TriangleGoal& goal, const HeadStart& head_start)
      : CountTarget(simplifier, executor, goal, most_held(goal.triangles), head_start) {}
  CountTarget(Simplifier& simplifier, const Executor& executor, const TriangleGoal& goal, std::uint64_t most_held,
              const HeadStart& head_start);

  // For a surface of which more will come, after decide(): while the zone holds more than `most_held` triangles,
  // decides more edges if that is possible. A share is no number before the surface is complete.
  void thin_out();

  // The most triangles that the zone should hold between two slabs when so many triangles are wanted in the end.
  static std::uint64_t most_held(std::uint64_t triangles) { return triangles + triangles / 4 + 50'000; }

  // For a surface of which more will come: whether so many triangles are final that the head start cannot overshoot.
  // Until then nothing may be handed out.
  bool leaves_enough();

  // For a complete surface, before finish(): whether the head start may have gone beyond the collapse that meets the
  // number, or was there to count. Then this run is of no use, and next_head_start() is that of the one in its place.
  bool has_overshot();
  HeadStart next_head_start() const;

  // The head start. begin_with(): goes on with that of a saved run.
  const HeadStart& head_start() const { return head_start_; }
  void begin_with(const HeadStart& head_start);

  // For a complete surface: the number to stop at.
  std::uint64_t number() const { return goal_.of(simplifier_.triangles() + simplifier_.counts().removed); }

  // For a complete surface: decides edges in order until no more than the number of triangles is left, or until all
  // edges are retired. Then everything is final.
  void finish();

 private:
  CostBits limit_that_leaves(std::uint64_t triangles) const;
  CostBits limit_within(std::uint64_t edges, const CostHistogram& costs) const;
  CostHistogram costs_of_edges() const;
  void raise_limit(CostBits limit);
  bool decide_at_once(std::uint64_t number, std::uint64_t in_order, const CostHistogram& edges);
  void decide_last(std::uint64_t number, std::uint64_t shown, const CostHistogram& edges);
  bool is_counted() const { return head_start_.met != kUnknownCost; }

  Simplifier& simplifier_;
  const Executor& executor_;
  const TriangleGoal goal_;
  std::uint64_t most_held_;
  CostBits asked_;  // the cost above which edges are retired, where no head start lowers it
  HeadStart head_start_;
  bool enough_ = false;  // triangles are final
};

}  // namespace isoweave
