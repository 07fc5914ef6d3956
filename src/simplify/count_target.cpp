#include "simplify/count_target.hpp"

#include <algorithm>
#include <mutex>
#include <vector>

#include "simplify/turns.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 8192;
constexpr std::uint64_t kInOrder = 4000;  // the last triangles are left to one queue

// A histogram of the costs of items, in steps of a 256th.
class CostHistogram {
 public:
  CostHistogram() : counts_(kSteps, 0) {}

  void add(CostBits cost) { ++counts_[cost >> kShift]; }

  void merge(const CostHistogram& other) {
    for (std::size_t n = 0; n < kSteps; ++n) counts_[n] += other.counts_[n];
  }

  // The highest cost with no more than `most` items up to it; kUnknownCost if there is none.
  CostBits highest_with_below(std::uint64_t most) const {
    std::uint64_t sum = 0;
    std::size_t step = 0;
    while (step < kSteps && sum + counts_[step] <= most) sum += counts_[step++];
    return step == 0 ? kUnknownCost : static_cast<CostBits>(step << kShift) - 1;
  }

  // The highest cost with at least `least` items beyond it; kUnknownCost if there is none.
  CostBits highest_with_beyond(std::uint64_t least) const {
    std::uint64_t sum = 0;
    std::size_t step = kSteps;
    while (step > 0 && sum < least) sum += counts_[--step];
    return sum < least || step == 0 ? kUnknownCost : static_cast<CostBits>(step << kShift) - 1;
  }

 private:
  static constexpr int kShift = 16;
  static constexpr std::size_t kSteps = std::size_t{1} << (31 - kShift);  // costs have no sign

  std::vector<std::uint64_t> counts_;
};

// The histogram of all live triangles: add(triangle, histogram) adds the costs of one of them.
template <class Add>
CostHistogram histogram_of(const Zone& zone, const Executor& executor, const Add& add) {
  CostHistogram sum;
  std::mutex merging;
  executor.for_blocks(zone.triangle_count(), 16 * kBlock, [&](std::int64_t begin, std::int64_t end) {
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

CountTarget::CountTarget(Simplifier& simplifier, const Executor& executor, std::uint64_t triangles,
                         std::uint64_t most_held)
    : simplifier_(simplifier), executor_(executor), target_(triangles), most_held_(most_held) {
  simplifier_.zone().limit = kUnknownCost;
}

void CountTarget::thin_out() {
  for (std::uint64_t held = simplifier_.triangles(); held > most_held_;) {
    const CostBits limit = limit_that_leaves(target_);
    if (limit <= simplifier_.zone().limit) return;
    raise_limit(limit);
    const std::uint64_t before = held;
    held = simplifier_.triangles();
    if (held > before - before / 32) return;  // the next slab tells more
  }
}

void CountTarget::finish() {
  while (simplifier_.triangles() > target_ + kInOrder) {
    const std::uint64_t removed_each = simplifier_.zone().options.drop_specks ? 4 : 2;  // at most, by one decision
    const CostBits limit = limit_within((simplifier_.triangles() - target_) / removed_each);
    if (limit <= simplifier_.zone().limit) break;
    raise_limit(limit);
    simplifier_.close_gaps();
  }
  simplifier_.zone().limit = simplifier_.zone().options.retire;
  simplifier_.decide_in_order(target_);
  simplifier_.zone().retire_all();
}

// The highest limit that leaves so many triangles: the final ones and those that are held.
CostBits CountTarget::limit_that_leaves(std::uint64_t triangles) const {
  const Zone& zone = simplifier_.zone();
  const std::uint64_t gone = simplifier_.triangles() - simplifier_.live_triangles();
  if (triangles <= gone) return zone.options.retire;
  const CostHistogram histogram = histogram_of(zone, executor_, [&](Index t, CostHistogram& own) {
    CostBits least = kRetiredCost;
    for (const HalfEdge& side : zone.triangles[t].sides) {
      least = std::min(least, cost_of(zone.turn_keys[side.vertex]));
    }
    own.add(least);
  });
  return std::min(histogram.highest_with_beyond(triangles - gone), zone.options.retire);
}

// The highest limit within which so many edges lie.
CostBits CountTarget::limit_within(std::uint64_t edges) const {
  const Zone& zone = simplifier_.zone();
  const CostHistogram histogram = histogram_of(zone, executor_, [&](Index t, CostHistogram& own) {
    for (Index h = half_edge(t, 0); h <= half_edge(t, 2); ++h) {
      if (zone.represents_edge(h)) own.add(std::min(zone.cost(h), kRetiredCost));
    }
  });
  return std::min(histogram.highest_with_below(edges), zone.options.retire);
}

void CountTarget::raise_limit(CostBits limit) {
  simplifier_.zone().limit = limit;
  simplifier_.decide();
}

}  // namespace isoweave
