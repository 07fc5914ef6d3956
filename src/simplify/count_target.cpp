#include "simplify/count_target.hpp"

#include <algorithm>
#include <mutex>
#include <vector>

#include "simplify/cost_histogram.hpp"
#include "simplify/turns.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kCountBlock = 32768;  // triangles, at least: every block clears a histogram
constexpr std::uint64_t kInOrder = 4000;     // the last triangles, or a small part of all, are left to one queue
constexpr std::uint64_t kPartInOrder = 256;
constexpr std::uint64_t kShown = 8;  // edges that the queue is shown first, for each of these triangles

// The head start of the run that counts after one that left too many triangles: up to an error twice as large the first
// time, then eight times, 512 times and so on, as the number may be out of reach.
HeadStart counting_further(const HeadStart& before) {
  std::uint32_t doublings = 1;
  for (std::uint32_t n = 1; n < before.counts && doublings < 64; ++n) doublings *= 3;
  const std::uint32_t more = 2 * doublings << 23;  // in the exponent of a cost
  return HeadStart::counting(std::min(before.cost + more, kRetiredCost - 1), before.counts + 1);
}

// The histogram of all live triangles: add(triangle, histogram) adds the costs of one of them.
template <class Add>
CostHistogram histogram_of(const Zone& zone, const Executor& executor, const Add& add) {
  CostHistogram sum;
  std::mutex merging;
  const std::int64_t count = zone.triangle_count();
  executor.for_blocks(count, std::max(kCountBlock, count / executor.threads() + 1),
                      [&](std::int64_t begin, std::int64_t end) {
                        CostHistogram own;
                        for (auto t = static_cast<Index>(begin); t < static_cast<Index>(end); ++t) {
                          if (zone.alive(half_edge(t, 0))) add(t, own);
                        }
                        const std::lock_guard guard(merging);
                        sum.merge(own);
                      });
  return sum;
}

}  // namespace

CountTarget::CountTarget(Simplifier& simplifier, const Executor& executor, const TriangleGoal& goal,
                         std::uint64_t most_held, const HeadStart& head_start)
    : simplifier_(simplifier),
      executor_(executor),
      goal_(goal),
      most_held_(most_held),
      asked_(simplifier.zone().options.retire) {
  simplifier_.zone().limit = kUnknownCost;
  begin_with(head_start);
}

void CountTarget::begin_with(const HeadStart& head_start) {
  Zone& zone = simplifier_.zone();
  head_start_ = head_start;
  if (is_counted()) zone.options.retire = std::min(zone.options.retire, head_start.met);
  if (head_start.cost == kUnknownCost) return;
  head_start_.cost = std::min(head_start.cost, zone.options.retire);
  zone.limit = std::max(zone.limit, head_start_.cost);
  simplifier_.count_removed();
}

void CountTarget::thin_out() {
  if (is_counted()) return;     // what is held does not grow with the number
  if (goal_.share > 0) return;  // the number is not known yet
  for (std::uint64_t held = simplifier_.triangles(); held > most_held_;) {
    const CostBits limit = limit_that_leaves(goal_.triangles);
    if (limit <= simplifier_.zone().limit) return;
    raise_limit(limit);
    const std::uint64_t before = held;
    held = simplifier_.triangles();
    if (held > before - before / 32) return;  // the next slab tells more
  }
}

bool CountTarget::leaves_enough() {
  if (is_counted()) return true;
  if (goal_.share > 0) return false;
  const Zone& zone = simplifier_.zone();
  if (!enough_) {
    enough_ = zone.limit == zone.options.retire && limit_that_leaves(goal_.triangles) == zone.options.retire;
  }
  return enough_;
}

bool CountTarget::has_overshot() {
  if (is_counted()) return head_start_.counts > 0;
  return simplifier_.triangles() <= number() && simplifier_.counts().removed > 0 && !leaves_enough();
}

// A run that has passed the number, or was to, has counted how many triangles each lower cost leaves: the highest cost
// that leaves more than the number lies in the step of the histogram before the one in which the number is met.
HeadStart CountTarget::next_head_start() const {
  const CostBits reached = simplifier_.zone().limit;
  const std::uint64_t removed = simplifier_.counts().removed;
  const std::uint64_t all = simplifier_.triangles() + removed;
  const std::uint64_t number = goal_.of(all);
  if (simplifier_.triangles() > number && reached < asked_) return counting_further(head_start_);
  if (simplifier_.triangles() > number) return {reached, reached};
  const CostBits below =
      all <= number ? kUnknownCost : simplifier_.removed_by_key().highest_with_below(all - number - 1);
  return {below, CostHistogram::end_of_next_step(below)};
}

void CountTarget::finish() {
  const std::uint64_t number = this->number();
  simplifier_.close_gaps(2);  // what is left leaves soon
  const std::uint64_t in_order = std::max(kInOrder, number / kPartInOrder);
  while (simplifier_.triangles() > number) {
    const CostHistogram edges = costs_of_edges();
    if (decide_at_once(number, in_order, edges)) continue;
    decide_last(number, kShown * in_order, edges);
    break;
  }
  simplifier_.zone().retire_all();
}

// Decides those of the edges, which have such costs, that can be decided at once, while more than so many triangles are
// beyond the number. Returns whether there were any.
bool CountTarget::decide_at_once(std::uint64_t number, std::uint64_t in_order, const CostHistogram& edges) {
  const std::uint64_t beyond = simplifier_.triangles() - number;
  if (beyond <= in_order) return false;
  const std::uint64_t removed_each = simplifier_.zone().options.drop_specks ? 4 : 2;  // at most, by one decision
  const CostBits limit = limit_within(beyond / removed_each, edges);
  if (limit <= simplifier_.zone().limit) return false;
  raise_limit(limit);
  simplifier_.close_gaps(2);
  return true;
}

// Decides the last edges, which have such costs, in order. The queue is shown so many of them, which are likely to do,
// then more.
void CountTarget::decide_last(std::uint64_t number, std::uint64_t shown, const CostHistogram& edges) {
  Zone& zone = simplifier_.zone();
  for (; simplifier_.triangles() > number; shown *= 8) {
    const CostBits limit = limit_within(shown, edges);
    zone.limit = limit > zone.limit ? limit : zone.options.retire;
    simplifier_.decide_in_order(number);
    if (zone.limit == zone.options.retire) return;
  }
}

// The highest limit that leaves so many triangles: the final ones and those that are held.
CostBits CountTarget::limit_that_leaves(std::uint64_t triangles) const {
  const Zone& zone = simplifier_.zone();
  const std::uint64_t gone = simplifier_.triangles() - simplifier_.live_triangles();
  if (triangles <= gone) return zone.options.retire;
  const CostHistogram histogram =
      histogram_of(zone, executor_, [&](Index t, CostHistogram& own) { own.add(least_cost(zone, t)); });
  return std::min(histogram.highest_with_beyond(triangles - gone), zone.options.retire);
}

// The highest limit within which so many edges lie, where all edges have such costs.
CostBits CountTarget::limit_within(std::uint64_t edges, const CostHistogram& costs) const {
  return std::min(costs.highest_with_below(edges), simplifier_.zone().options.retire);
}

CostHistogram CountTarget::costs_of_edges() const {
  const Zone& zone = simplifier_.zone();
  return histogram_of(zone, executor_, [&](Index t, CostHistogram& own) {
    for (Index h = half_edge(t, 0); h <= half_edge(t, 2); ++h) {
      own.add(std::min(zone.cost(h), kRetiredCost), zone.represents_edge(h) ? 1 : 0);  // no jump: half of them do
    }
  });
}

void CountTarget::raise_limit(CostBits limit) {
  simplifier_.zone().limit = limit;
  simplifier_.decide();
}

}  // namespace isoweave
