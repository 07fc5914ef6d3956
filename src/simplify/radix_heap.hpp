// Monotone priority queue of edges (radix heap: Ahuja, Mehlhorn, Orlin and Tarjan, 1990).
//
// No entry is pushed below the last cost popped. So an entry only moves to lower buckets, at most 32 times, and a push
// is an append. Entries come out in groups of equal cost, which the caller orders by tie.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace isoweave {

class RadixHeap {
 public:
  struct Entry {
    std::uint32_t cost;
    std::uint32_t edge;
  };

  // Forgets all entries and starts again from cost 0. Keeps its memory.
  void clear() {
    for (auto& bucket : buckets_) bucket.clear();
    last_ = 0;
  }

  // cost must not be below the cost of the last group popped.
  void push(std::uint32_t cost, std::uint32_t edge) { buckets_[bucket_of(cost)].push_back({cost, edge}); }

  // Moves all entries of the least cost into `group`. Returns false when there are none left.
  bool pop_group(std::vector<Entry>& group) {
    group.clear();
    if (buckets_[0].empty() && !refill()) return false;
    group.swap(buckets_[0]);
    return true;
  }

 private:
  // 0 for the last cost itself, else one more than the position of the highest bit that differs from it.
  std::size_t bucket_of(std::uint32_t cost) const { return static_cast<std::size_t>(std::bit_width(cost ^ last_)); }

  bool refill() {
    std::size_t source = 1;
    while (source < buckets_.size() && buckets_[source].empty()) ++source;
    if (source == buckets_.size()) return false;
    auto& entries = buckets_[source];
    last_ = std::min_element(entries.begin(), entries.end(), [](Entry a, Entry b) { return a.cost < b.cost; })->cost;
    for (const Entry entry : entries) push(entry.cost, entry.edge);
    entries.clear();
    return true;
  }

  std::array<std::vector<Entry>, 33> buckets_;
  std::uint32_t last_ = 0;
};

}  // namespace isoweave
