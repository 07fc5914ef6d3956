// Closing the gaps in an array, in place. Every element moves once: the fewer are left, the more blocks move side by
// side.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "parallel/array.hpp"
#include "parallel/parallel.hpp"

namespace isoweave {

// The new places of the elements of an array when some are left out. The others keep their order.
class Compaction {
 public:
  static constexpr std::uint32_t kDropped = 0xffffffffu;

  // keep(n) is called once for every element, by any thread.
  template <class Keep>
  Compaction(const Executor& executor, std::size_t size, const Keep& keep)
      : executor_(executor), start_(size / kBlock + 2, 0) {
    within_.resize(size);
    blocks(size, [&](std::size_t block, std::size_t begin, std::size_t end) {
      std::uint32_t kept = 0;
      for (std::size_t n = begin; n < end; ++n) within_[n] = keep(n) ? kept++ : kDropped;
      start_[block + 1] = kept;
    });
    for (std::size_t block = 1; block < start_.size(); ++block) start_[block] += start_[block - 1];
    while ((dense_ + 1) * kBlock <= size && start_[dense_ + 1] == (dense_ + 1) * kBlock) ++dense_;
  }

  std::size_t kept() const { return start_.back(); }

  // Whether an element is known to stay where it is, as all before it do. References to such elements need not be
  // looked up and written again.
  bool stays(std::size_t n) const { return n < dense_ * kBlock; }

  // The new index of an element, or kDropped.
  std::uint32_t operator[](std::size_t n) const {
    return within_[n] == kDropped ? kDropped : static_cast<std::uint32_t>(start_[n / kBlock]) + within_[n];
  }

  // Moves the elements; change(element) is called for each that is kept.
  template <class Container, class Change>
  void apply(Container& array, const Change& change) const {
    move_from(0, array, change);
  }

  template <class Container>
  void apply(Container& array) const {
    move_from(dense_, array, [](auto&) {});
  }

 private:
  static constexpr std::size_t kBlock = 1 << 12;

  template <class Container, class Change>
  void move_from(std::size_t block, Container& array, const Change& change) const {
    static_assert(std::is_trivially_copyable_v<std::remove_reference_t<decltype(array[0])>>);
    const auto move_block = [&](std::size_t moved) {
      std::size_t next = start_[moved];
      for (std::size_t n = moved * kBlock; n < std::min((moved + 1) * kBlock, array.size()); ++n) {
        if (within_[n] == kDropped) continue;
        if (next != n) array[next] = array[n];
        change(array[next++]);
      }
    };
    // Side by side go blocks that stay where they are, and blocks that end up below the first of them.
    while (block * kBlock < array.size()) {
      std::size_t end = std::max(block + 1, dense_);
      while (end * kBlock < array.size() && start_[end + 1] <= block * kBlock) ++end;
      executor_.for_each(static_cast<std::int64_t>(end - block), 1,
                         [&](std::int64_t n) { move_block(block + static_cast<std::size_t>(n)); });
      block = end;
    }
    array.resize(kept());
  }

  template <class Body>
  void blocks(std::size_t size, const Body& body) const {
    executor_.for_blocks(static_cast<std::int64_t>(size), kBlock, [&](std::int64_t begin, std::int64_t end) {
      body(static_cast<std::size_t>(begin) / kBlock, static_cast<std::size_t>(begin), static_cast<std::size_t>(end));
    });
  }

  const Executor& executor_;
  std::size_t dense_ = 0;           // blocks at the beginning of which nothing is left out
  std::vector<std::size_t> start_;  // of the kept elements of every block
  Array<std::uint32_t> within_;     // place among the kept elements of its block
};

}  // namespace isoweave
