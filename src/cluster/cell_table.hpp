// The numbers of occupied cells, in the order in which they were first met.
#pragma once

#include <cstdint>
#include <vector>

namespace isoweave {

// A table with open addresses. It holds occupied cells only.
class CellTable {
 public:
  // The number of a cell, a new one where it was not met before. Throws OverMemory at 2^32 - 1 cells.
  std::uint32_t number(std::uint64_t key);

  // The cells by their numbers.
  const std::vector<std::uint64_t>& keys() const { return keys_; }

  std::uint64_t bytes() const {
    return keys_.capacity() * sizeof(std::uint64_t) + slots_.size() * sizeof(std::uint32_t);
  }

 private:
  std::size_t slot_of(std::uint64_t key) const;
  void grow();

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> slots_;  // numbers; their count is a power of two
};

}  // namespace isoweave
