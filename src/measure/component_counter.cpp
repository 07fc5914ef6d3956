#include "measure/component_counter.hpp"

#include <utility>

namespace isoweave {

std::uint32_t ComponentCounter::add() {
  const auto label = static_cast<std::uint32_t>(parent_.size());
  parent_.push_back(label);
  ++added_;
  return label;
}

void ComponentCounter::join(std::uint32_t a, std::uint32_t b) {
  a = root(a);
  b = root(b);
  if (a == b) return;
  parent_[b > a ? b : a] = b > a ? a : b;
  ++joined_;
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

std::uint32_t ComponentCounter::root(std::uint32_t label) {
  while (parent_[label] != label) {
    parent_[label] = parent_[parent_[label]];
    label = parent_[label];
  }
  return label;
}

}  // namespace isoweave
