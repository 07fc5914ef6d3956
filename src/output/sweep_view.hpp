// Triangles on their way to a SweepObserver, in blocks that are filled in parallel.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "output/world.hpp"
#include "parallel/parallel.hpp"
#include "simplify/zone.hpp"

namespace isoweave {

inline constexpr std::size_t kViewBlock = 32768;  // triangles, 36 bytes each

// Hands over `count` triangles. point(n, c) gives corner c of the n-th triangle, and is called by any thread.
template <class PointOf>
void view_triangles(std::size_t count, const PointOf& point, const Executor& executor,
                    const SweepObserver::Visitor& visitor) {
  std::vector<TriangleCorners> block(std::min(count, kViewBlock));
  for (std::size_t first = 0; first < count; first += block.size()) {
    block.resize(std::min(block.size(), count - first));
    executor.for_each(static_cast<std::int64_t>(block.size()), kViewBlock / 16, [&](std::int64_t i) {
      const auto n = static_cast<std::size_t>(i);
      block[n] = {point(first + n, 0), point(first + n, 1), point(first + n, 2)};
    });
    visitor(block);
  }
}

// Hands over the triangles that a zone holds.
void view_zone(const Zone& zone, const World& world, const Executor& executor, const SweepObserver::Visitor& visitor);

}  // namespace isoweave
