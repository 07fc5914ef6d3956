// Disjoint sets that several threads join at the same time (Anderson and Woll 1991, Wait-free parallel algorithms for
// the union-find problem). The root of a set is its smallest member, whatever the order of the joins.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>

#include "parallel/check.hpp"

namespace isoweave {

// The root of the set that holds `member`. Halves the path that it walks.
inline std::uint32_t find_root(std::span<std::uint32_t> parents, std::uint32_t member) {
  const auto parent = [&](std::uint32_t of) { return std::atomic_ref(parents[of]); };
  std::uint32_t above = parent(member).load(std::memory_order_relaxed);
  while (above != member) {
    ISOWEAVE_CHECK(above < member);
    const std::uint32_t next = parent(above).load(std::memory_order_relaxed);
    if (next != above) parent(member).store(next, std::memory_order_relaxed);
    member = above;
    above = next;
  }
  return member;
}

// Joins two sets. Returns false when they are one already. The larger root comes under the smaller one, unless another
// thread has just moved it.
inline bool join_sets(std::span<std::uint32_t> parents, std::uint32_t a, std::uint32_t b) {
  while (true) {
    a = find_root(parents, a);
    b = find_root(parents, b);
    if (a == b) return false;
    if (a > b) std::swap(a, b);
    std::uint32_t found = b;
    if (std::atomic_ref(parents[b]).compare_exchange_strong(found, a, std::memory_order_relaxed)) return true;
  }
}

}  // namespace isoweave
