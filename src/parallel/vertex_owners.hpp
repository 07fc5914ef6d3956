// Passes over triangles that write to their vertices, without atomic operations: every thread has vertices of its own,
// and visits whatever may name them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/parallel.hpp"

namespace isoweave {

class VertexOwners {
 public:
  using Triangles = std::span<const std::array<std::uint32_t, 3>>;

  // Vertices of one thread.
  struct Part {
    const VertexOwners& owners;
    std::uint32_t first;
    std::uint32_t size;

    bool has(std::uint32_t vertex) const { return vertex - first < size; }

    // Calls visit(n) in increasing order for the triangles that name any of them, among others.
    template <class Visit>
    void each_triangle(const Visit& visit) const {
      for (std::size_t block = 0; block < owners.named_.size(); ++block) {
        const Range& named = owners.named_[block];
        if (named.largest < first || named.least >= std::uint64_t{first} + size) continue;
        const std::size_t begin = block * kBlock;
        const std::size_t end = std::min(begin + kBlock, owners.triangles_.size());
        for (std::size_t n = begin; n < end; ++n) visit(n);
      }
    }
  };

  // Looks at all triangles once. Triangles and executor must outlive this object.
  VertexOwners(const Executor& executor, Triangles triangles)
      : executor_(executor), triangles_(triangles), named_((triangles.size() + kBlock - 1) / kBlock) {
    executor.for_blocks(static_cast<std::int64_t>(triangles.size()), kBlock, [&](std::int64_t begin, std::int64_t end) {
      Range named;
      for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
        for (const std::uint32_t vertex : triangles[n]) named.include(vertex);
      }
      named_[static_cast<std::size_t>(begin) / kBlock] = named;
    });
  }

  // The largest vertex that a triangle names; 0 where there are no triangles.
  std::uint32_t largest_vertex() const {
    std::uint32_t largest = 0;
    for (const Range& named : named_) largest = std::max(largest, named.largest);
    return largest;
  }

  // Calls body(part) for each thread; the parts cover [0, vertices).
  template <class Body>
  void for_parts(std::size_t vertices, const Body& body) const {
    const auto count = static_cast<std::int64_t>(vertices);
    executor_.for_blocks(count, count / executor_.threads() + 1, [&](std::int64_t begin, std::int64_t end) {
      body(Part{*this, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)});
    });
  }

 private:
  static constexpr std::size_t kBlock = 2048;

  // The range of the vertices that a block of triangles names. Triangles that lie together name vertices that do.
  struct Range {
    std::uint32_t least = 0xffffffffU;
    std::uint32_t largest = 0;

    void include(std::uint32_t vertex) {
      least = std::min(least, vertex);
      largest = std::max(largest, vertex);
    }
  };

  const Executor& executor_;
  Triangles triangles_;
  std::vector<Range> named_;
};

}  // namespace isoweave
