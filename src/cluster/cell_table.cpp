#include "cluster/cell_table.hpp"

#include "isoweave/error.hpp"
#include "lattice/splitmix64.hpp"

namespace isoweave {
namespace {

constexpr std::uint32_t kEmpty = ~std::uint32_t{0};
constexpr std::size_t kFirstSlots = 1024;

}  // namespace

std::uint32_t CellTable::number(std::uint64_t key) {
  if (2 * (keys_.size() + 1) > slots_.size()) grow();
  const std::size_t slot = slot_of(key);
  if (slots_[slot] == kEmpty) {
    if (keys_.size() == kEmpty) throw OverMemory("the surface occupies 2^32 cells, expected fewer: take larger ones");
    slots_[slot] = static_cast<std::uint32_t>(keys_.size());
    keys_.push_back(key);
  }
  return slots_[slot];
}

// The slot of a cell, or the empty one where it belongs.
std::size_t CellTable::slot_of(std::uint64_t key) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = measure::splitmix64(key) & mask;
  while (slots_[slot] != kEmpty && keys_[slots_[slot]] != key) slot = (slot + 1) & mask;
  return slot;
}

void CellTable::grow() {
  slots_.assign(slots_.empty() ? kFirstSlots : 2 * slots_.size(), kEmpty);
  for (std::uint32_t n = 0; n < keys_.size(); ++n) slots_[slot_of(keys_[n])] = n;
}

}  // namespace isoweave
