// Connected components of a surface that is seen piece by piece.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "files/state_file.hpp"

namespace isoweave {

// Union-find over labels. compact() forgets labels that are no longer needed, so memory follows the vertices held.
class ComponentCounter {
 public:
  // Adds components of one vertex each. Returns the first of their consecutive labels.
  std::uint32_t add(std::size_t count);

  // Makes two labels name the same component. Returns whether they named two components before; such joins must be
  // counted below. May be called by several threads at the same time.
  bool join(std::uint32_t a, std::uint32_t b);

  // Counts joins that made one component of two. May be called by several threads at the same time.
  void count_joins(std::uint64_t count) { joined_.fetch_add(count, std::memory_order_relaxed); }

  // The number of components so far.
  std::uint64_t count() const { return added_ - joined_; }

  // The number of labels held.
  std::size_t labels() const { return parent_.size(); }

  // Renumbers the labels of the vertices still held, in place; all other labels become invalid.
  void compact(std::span<std::uint32_t*> labels);

  // The labels that are held: written, and read. Throws BadInput.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state);

 private:
  std::vector<std::uint32_t> parent_;
  std::uint64_t added_ = 0;
  std::atomic<std::uint64_t> joined_{0};
};

}  // namespace isoweave
