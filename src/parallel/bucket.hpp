// Stable grouping of indices by a small key: count per fixed block, scan, fill.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "parallel/parallel.hpp"

namespace isoweave {

struct Buckets {
  std::vector<std::uint32_t> items;  // grouped by bucket, in increasing order within each
  std::vector<std::size_t> start;    // bucket b: items[start[b]] ... items[start[b + 1] - 1]
};

// Puts every n in [0, count) with key(n) < buckets into bucket key(n), and leaves out the others. key must give the
// same answer twice. Same result for any number of threads.
template <class Key>
void fill_buckets(const Executor& executor, std::uint32_t count, std::size_t buckets, const Key& key, Buckets& out) {
  constexpr std::int64_t kBlock = 1 << 13;
  const std::size_t blocks = (static_cast<std::size_t>(count) + kBlock - 1) / kBlock;
  std::vector<std::size_t> position(blocks * buckets, 0);
  executor.for_blocks(count, kBlock, [&](std::int64_t begin, std::int64_t end) {
    std::size_t* const own = position.data() + static_cast<std::size_t>(begin / kBlock) * buckets;
    for (std::int64_t n = begin; n < end; ++n) {
      const std::size_t bucket = key(static_cast<std::uint32_t>(n));
      if (bucket < buckets) ++own[bucket];
    }
  });
  out.start.assign(buckets + 1, 0);
  std::size_t sum = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    out.start[bucket] = sum;
    for (std::size_t block = 0; block < blocks; ++block) {
      const std::size_t own = position[block * buckets + bucket];
      position[block * buckets + bucket] = sum;
      sum += own;
    }
  }
  out.start[buckets] = sum;
  out.items.resize(sum);
  executor.for_blocks(count, kBlock, [&](std::int64_t begin, std::int64_t end) {
    std::size_t* const own = position.data() + static_cast<std::size_t>(begin / kBlock) * buckets;
    for (std::int64_t n = begin; n < end; ++n) {
      const std::size_t bucket = key(static_cast<std::uint32_t>(n));
      if (bucket < buckets) out.items[own[bucket]++] = static_cast<std::uint32_t>(n);
    }
  });
}

}  // namespace isoweave
