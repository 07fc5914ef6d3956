#include "simplify/rounds.hpp"

#include <mutex>
#include <utility>

namespace isoweave {
namespace {

constexpr std::int64_t kRoundBlock = 1024;

}  // namespace

void Rounds::run(const std::atomic<bool>* stop) {
  if (zone_.limit > limit_) zone_.settle_all();
  limit_ = zone_.limit;
  give_turns(zone_, executor_);
  marks_.assign(zone_.vertices.size(), 0);
  for (List* list : {&changed_, &candidates_, &minima_}) list->items.resize(zone_.vertices.size());
  changed_.size = static_cast<std::uint32_t>(zone_.settled.size());
  for (std::size_t n = 0; n < changed_.size; ++n) changed_.items[n] = zone_.settled[n];
  const RoundPasses<VectorArithmetic> passes{zone_.view(), marks_.data(), changed_.view(), candidates_.view(),
                                             minima_.view()};
  zone_.settled.clear();
  while (changed_.size > 0 && !(stop != nullptr && stop->load(std::memory_order_relaxed))) run_round(passes);
}

void Rounds::run_round(const RoundPasses<VectorArithmetic>& passes) {
  candidates_.size = minima_.size = 0;
  executor_.for_each(changed_.size, kRoundBlock, [&](std::int64_t n) { passes.list_candidates(n); });
  executor_.for_each(candidates_.size, kRoundBlock, [&](std::int64_t n) { passes.pick_minimum(n); });
  changed_.size = 0;
  std::mutex counting;
  executor_.for_blocks(minima_.size, kRoundBlock / 16, [&](std::int64_t begin, std::int64_t end) {
    DecisionCounts counts;
    std::vector<std::pair<CostBits, std::uint64_t>> removed;  // by the decision of each key, and those before it
    for (std::int64_t n = begin; n < end; ++n) {
      const CostBits key = zone_.cost(minima_.items[static_cast<std::size_t>(n)]);
      passes.decide(n, counts);
      removed.emplace_back(key, counts.removed);
    }
    const std::lock_guard guard(counting);
    counts_ += counts;
    std::uint64_t before = 0;
    for (const auto& [key, with] : removed) removed_by_key_.add(key, with - std::exchange(before, with));
  });
  executor_.for_each(changed_.size, kRoundBlock, [&](std::int64_t n) { passes.renew(n); });
  executor_.for_each(candidates_.size, kRoundBlock, [&](std::int64_t n) { passes.forget_candidate(n); });
  ++rounds_;
}

}  // namespace isoweave
