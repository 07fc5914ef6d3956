// Tells when a vertex has the keys of all its edges, while the edges of new triangles get theirs column by column.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "parallel/atomics.hpp"
#include "simplify/zone_view.hpp"

namespace isoweave {

// Counts, for every vertex, the new triangles whose edges have no keys yet. If all new triangles of a vertex are in one
// column, one thread passes over them in their order, and the last one is enough to know. Vertices between columns are
// few, and their triangles are counted.
class KeyCountdown {
 public:
  // Begins for so many vertices, none of which waits for anything yet.
  void begin(std::size_t vertices) { awaited_.resize(vertices, kNothing); }

  void expect_nothing() { awaited_.assign(awaited_.size(), kNothing); }
  void expect(Index v, std::uint32_t triangles) { awaited_[v] = kCounted | triangles; }
  void expect_last(Index v, Index triangle) { awaited_[v] = triangle; }

  bool waits(Index v) const { return load_relaxed(awaited_[v]) != kNothing; }

  // Counts off triangle t, which names v. Returns whether v has all its keys now, whichever threads gave them.
  bool count_off(Index v, Index t) {
    const Index awaited = load_relaxed(awaited_[v]);
    if (awaited == t) {
      awaited_[v] = kNothing;
      return true;
    }
    if (awaited < kCounted || awaited == kNothing) return false;
    const std::atomic_ref<Index> count(awaited_[v]);
    if (count.fetch_sub(1, std::memory_order_acq_rel) != (kCounted | 1)) return false;
    awaited_[v] = kNothing;
    return true;
  }

  std::uint64_t bytes() const { return awaited_.capacity() * sizeof(Index); }

 private:
  static constexpr Index kCounted = Index{1} << 31;  // beside a number of triangles; the zone holds fewer than 2^30
  static constexpr Index kNothing = kNone;

  std::vector<Index> awaited_;
};

}  // namespace isoweave
