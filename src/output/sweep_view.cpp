#include "output/sweep_view.hpp"

#include "parallel/collect.hpp"

namespace isoweave {

void view_zone(const Zone& zone, const World& world, const Executor& executor, const SweepObserver::Visitor& visitor) {
  std::vector<TriangleCorners> block;
  const auto corner = [&](Index t, std::size_t c) { return zone.vertices[zone.triangles[t].sides[c].vertex].position; };
  for (std::size_t first = 0; first < zone.triangle_count(); first += kViewBlock) {
    const std::size_t count = std::min(kViewBlock, zone.triangle_count() - first);
    collect(
        executor, static_cast<std::int64_t>(count), kViewBlock / 16,
        [&](std::int64_t begin, std::int64_t end, std::vector<TriangleCorners>& list) {
          for (std::int64_t n = begin; n < end; ++n) {
            const auto t = static_cast<Index>(first + static_cast<std::size_t>(n));
            if (!zone.alive(half_edge(t, 0))) continue;
            list.push_back(world.triangle({corner(t, 0), corner(t, 1), corner(t, 2)}));
          }
        },
        block);
    if (!block.empty()) visitor(block);
  }
}

}  // namespace isoweave
