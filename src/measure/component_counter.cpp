#include "measure/component_counter.hpp"

#include <numeric>

#include "parallel/union_find.hpp"

namespace isoweave {

std::uint32_t ComponentCounter::add(std::size_t count) {
  const auto first = static_cast<std::uint32_t>(parent_.size());
  parent_.resize(parent_.size() + count);
  std::iota(parent_.begin() + first, parent_.end(), first);
  added_ += count;
  return first;
}

bool ComponentCounter::join(std::uint32_t a, std::uint32_t b) { return join_sets(parent_, a, b); }

void ComponentCounter::serialize(StateWriter& state) const {
  state.list(parent_);
  state.value(added_);
  state.value(joined_.load());
}

void ComponentCounter::serialize(StateReader& state) {
  state.list(parent_);
  for (std::size_t label = 0; label < parent_.size(); ++label) {
    state.require(parent_[label] <= label, "labels below which there are none but smaller ones");
  }
  std::uint64_t joined = 0;
  state.value(added_);
  state.value(joined);
  joined_ = joined;
}

void ComponentCounter::compact(std::span<std::uint32_t*> labels) {
  constexpr std::uint32_t kUnused = 0xffffffffu;
  std::vector<std::uint32_t> renumbered(parent_.size(), kUnused);
  std::uint32_t roots = 0;
  for (std::uint32_t* label : labels) {
    std::uint32_t& number = renumbered[find_root(parent_, *label)];
    if (number == kUnused) number = roots++;
    *label = number;
  }
  parent_.resize(roots);
  for (std::uint32_t label = 0; label < roots; ++label) parent_[label] = label;
}

}  // namespace isoweave
