// Lists made in parallel: every block fills its own, then they are put together in the order of the blocks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "parallel/parallel.hpp"

namespace isoweave {

// Calls body(begin, end, list) for the blocks of [0, count) and replaces `out` by their lists. Same result for any
// number of threads.
template <class T, class Body>
void collect(const Executor& executor, std::int64_t count, std::int64_t grain, const Body& body, std::vector<T>& out) {
  std::vector<std::vector<T>> lists(static_cast<std::size_t>((count + grain - 1) / grain));
  executor.for_blocks(count, grain, [&](std::int64_t begin, std::int64_t end) {
    body(begin, end, lists[static_cast<std::size_t>(begin / grain)]);
  });
  std::vector<std::size_t> start(lists.size() + 1, 0);
  for (std::size_t n = 0; n < lists.size(); ++n) start[n + 1] = start[n] + lists[n].size();
  out.resize(start.back());
  executor.for_each(static_cast<std::int64_t>(lists.size()), 1, [&](std::int64_t n) {
    const auto block = static_cast<std::size_t>(n);
    std::copy(lists[block].begin(), lists[block].end(), out.begin() + static_cast<std::ptrdiff_t>(start[block]));
  });
}

}  // namespace isoweave
