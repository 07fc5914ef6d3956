#include "measure/component_counter.hpp"

#include <numeric>
#include <utility>

namespace isoweave {

std::uint32_t ComponentCounter::add(std::size_t count) {
  const auto first = static_cast<std::uint32_t>(parent_.size());
  parent_.resize(parent_.size() + count);
  std::iota(parent_.begin() + first, parent_.end(), first);
  added_ += count;
  return first;
}

// The larger root comes under the smaller one, unless another thread has just moved it.
void ComponentCounter::join(std::uint32_t a, std::uint32_t b) {
  while (true) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (a > b) std::swap(a, b);
    std::uint32_t found = b;
    if (std::atomic_ref(parent_[b]).compare_exchange_strong(found, a, std::memory_order_relaxed)) {
      joined_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
  }
}

void ComponentCounter::compact(std::span<std::uint32_t*> labels) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> renumbered(parent_.size(), kUnused);
  std::uint32_t roots = 0;
  for (std::uint32_t* label : labels) {
    std::uint32_t& number = renumbered[root(*label)];
    if (number == kUnused) number = roots++;
    *label = number;
  }
  parent_.resize(roots);
  for (std::uint32_t label = 0; label < roots; ++label) parent_[label] = label;
}

// Halves the paths that it walks.
std::uint32_t ComponentCounter::root(std::uint32_t label) {
  const auto parent = [&](std::uint32_t of) { return std::atomic_ref(parent_[of]); };
  std::uint32_t above = parent(label).load(std::memory_order_relaxed);
  while (above != label) {
    const std::uint32_t next = parent(above).load(std::memory_order_relaxed);
    if (next != above) parent(label).store(next, std::memory_order_relaxed);
    label = above;
    above = next;
  }
  return label;
}

}  // namespace isoweave
