// The instruction sets that the kernels use.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <span>

namespace isoweave {

inline constexpr std::size_t kAllInstructions = std::numeric_limits<std::size_t>::max();

// The newest set in use, counted from the one that every processor has. Results do not depend on it; tests lower it to
// see that.
inline std::atomic<std::size_t> newest_instructions{kAllInstructions};

// Chooses among kernels for one set each, the oldest first.
template <class Kernels>
const Kernels& newest_of(std::span<const Kernels* const> all) {
  return *all[std::min(newest_instructions.load(std::memory_order_relaxed), all.size() - 1)];
}

}  // namespace isoweave
