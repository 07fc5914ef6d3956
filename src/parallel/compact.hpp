// Closing the gaps in an array, in place: every block closes its own, then the blocks move together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "parallel/parallel.hpp"

namespace isoweave {

// Where the elements of an array go when those that are not kept are left out; the others keep their order.
class Compaction {
 public:
  static constexpr std::uint32_t kDropped = 0xffffffffu;

  template <class Keep>
  Compaction(const Executor& executor, std::size_t size, const Keep& keep)
      : executor_(executor), start_(size / kBlock + 2, 0), to_(size) {
    blocks(size, [&](std::size_t block, std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) start_[block + 1] += std::size_t{keep(n)};
    });
    for (std::size_t block = 1; block < start_.size(); ++block) start_[block] += start_[block - 1];
    blocks(size, [&](std::size_t block, std::size_t begin, std::size_t end) {
      std::size_t next = start_[block];
      for (std::size_t n = begin; n < end; ++n) to_[n] = keep(n) ? static_cast<std::uint32_t>(next++) : kDropped;
    });
  }

  std::size_t kept() const { return start_.back(); }

  // The new index of an element, or kDropped.
  std::uint32_t operator[](std::size_t n) const { return to_[n]; }

  // Moves the elements; change(element) is called for each that is kept.
  template <class T, class Change>
  void apply(std::vector<T>& array, const Change& change) const {
    blocks(array.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
      std::size_t next = begin;
      for (std::size_t n = begin; n < end; ++n) {
        if (to_[n] == kDropped) continue;
        if (next != n) array[next] = array[n];
        change(array[next++]);
      }
    });
    for (std::size_t block = 1; block * kBlock < array.size(); ++block) {
      const auto from = array.begin() + static_cast<std::ptrdiff_t>(block * kBlock);
      std::copy(from, from + static_cast<std::ptrdiff_t>(start_[block + 1] - start_[block]),
                array.begin() + static_cast<std::ptrdiff_t>(start_[block]));
    }
    array.resize(kept());
  }

  template <class T>
  void apply(std::vector<T>& array) const {
    apply(array, [](T&) {});
  }

 private:
  static constexpr std::size_t kBlock = 1 << 14;

  template <class Body>
  void blocks(std::size_t size, const Body& body) const {
    executor_.for_blocks(static_cast<std::int64_t>(size), kBlock, [&](std::int64_t begin, std::int64_t end) {
      body(static_cast<std::size_t>(begin) / kBlock, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    });
  }

  const Executor& executor_;
  std::vector<std::size_t> start_;  // of the kept elements of every block
  std::vector<std::uint32_t> to_;
};

}  // namespace isoweave
