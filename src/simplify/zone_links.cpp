// How triangles come together: twins, and vertices around which they do not form one fan.
#include <algorithm>
#include <array>
#include <atomic>
#include <span>
#include <utility>
#include <vector>

#include "simplify/zone.hpp"
#include "simplify/zone_rules.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 2048;
constexpr std::uint32_t kNoFan = std::uint32_t{1} << 31;  // beside a number of triangles

// By insertion where there are few, in a fan's hub by std::sort.
template <class T, class Less>
void sort_few(std::span<T> items, const Less& less) {
  constexpr std::size_t kFew = 32;
  if (items.size() > kFew) return std::sort(items.begin(), items.end(), less);
  for (std::size_t n = 1; n < items.size(); ++n) {
    const T item = items[n];
    std::size_t at = n;
    for (; at > 0 && less(item, items[at - 1]); --at) items[at] = items[at - 1];
    items[at] = item;
  }
}

}  // namespace

// Finds twins: puts every side of an edge into the list of the end that has the smaller number in the piece, and pairs
// the sides of each list. The ends of a bad edge are marked: what its sides are linked to is of no matter. A side of a
// new triangle has the number of its half-edge, counted from the first of them; those that are known follow.
void Zone::link(const SurfacePiece& piece, Index first_triangle, const Executor& executor) {
  const auto known_sides = known_sides_of(piece);
  const auto known = static_cast<std::int64_t>(known_sides.size());
  const auto count = static_cast<std::int64_t>(piece.triangles.size());
  const Index first_known = half_edge(static_cast<Index>(count), 0);
  const auto ends_of = [&](Index side) -> std::array<Index, 2> {
    if (side >= first_known) return {known_sides[side - first_known][0], known_sides[side - first_known][1]};
    const auto& corners = piece.triangles[side >> 2];
    return {corners[side & 3], corners[next(side) & 3]};
  };
  const auto half_edge_of = [&](Index side) {
    return side < first_known ? half_edge(first_triangle, 0) + side : known_sides[side - first_known][2];
  };

  const std::size_t ends = piece.inherited + piece.positions.size();
  first_side_.resize(ends);
  next_side_.resize(first_known + known_sides.size());
  executor.for_blocks(static_cast<std::int64_t>(ends), kBlock, [&](std::int64_t begin, std::int64_t end) {
    std::fill(first_side_.data() + begin, first_side_.data() + end, kNone);
  });
  const bool alone = executor.threads() == 1;
  const auto list = [&](Index side, Index a, Index b) {
    Index& first = first_side_[std::min(a, b)];
    next_side_[side] =
        alone ? std::exchange(first, side) : std::atomic_ref(first).exchange(side, std::memory_order_relaxed);
  };
  executor.for_each(count + known, kBlock, [&](std::int64_t n) {
    if (n >= count) {
      const auto& [a, b, h] = known_sides[static_cast<std::size_t>(n - count)];
      return list(first_known + static_cast<Index>(n - count), a, b);
    }
    const auto& corners = piece.triangles[static_cast<std::size_t>(n)];
    for (Index c = 0; c < 3; ++c) list(half_edge(static_cast<Index>(n), c), corners[c], corners[(c + 1) % 3]);
  });
  executor.for_blocks(static_cast<std::int64_t>(ends), kBlock, [&](std::int64_t begin, std::int64_t end) {
    std::vector<EdgeSide> sides;
    for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
      sides.clear();
      for (Index side = first_side_[v]; side != kNone; side = next_side_[side]) {
        const auto [a, b] = ends_of(side);
        sides.emplace_back(a, b, half_edge_of(side));
      }
      sort_few(std::span(sides), [](const EdgeSide& a, const EdgeSide& b) { return a.other_end() < b.other_end(); });
      link_sorted(*this, sides, [&](Index bad) {
        if (piece.manifold) return;
        fetch_or(corner_array_[origin(bad)], kNoFan);
        fetch_or(corner_array_[destination(bad)], kNoFan);
      });
    }
  });
}

// A walk both ways around its vertex meets all faces, and no edge there is bad.
bool Zone::is_one_fan(const Star& star) const {
  const std::uint32_t corners = corner_array_[star.vertex];
  if (!star.border && !star.overflow) return static_cast<std::uint32_t>(star.faces) == corners;
  const Index first = vertices[star.vertex].half_edge;
  std::uint32_t faces = 1;
  for (Index h = rotate(first); h != first; h = rotate(h), ++faces) {
    if (exists(h)) continue;
    for (h = twin(first); exists(h); h = twin(next(h))) ++faces;
    break;
  }
  return faces == corners;
}

// The half-edges that a piece can bring another side for, with the numbers that it gives to their ends: only a triangle
// between incomplete vertices can. Where they have a twin already, only a piece that is not a manifold.
std::vector<std::array<Index, 3>> Zone::known_sides_of(const SurfacePiece& piece) const {
  Array<Index> number;  // of incomplete vertices
  number.resize(settled.first_new);
  for (Index n = 0; n < piece.inherited; ++n) number[front_[n]] = n;
  std::vector<std::array<Index, 3>> sides;
  for (const Index h : unkeyed_edges_) {
    const Index a = origin(h);
    const Index b = destination(h);
    if (states[a] != VertexState::kIncomplete || states[b] != VertexState::kIncomplete) continue;
    if (twin(h) == kNone) {
      sides.push_back({number[a], number[b], h});
    } else if (!piece.manifold) {
      sides.push_back({number[a], number[b], h});
      sides.push_back({number[b], number[a], twin(h)});
    }
  }
  return sides;
}

}  // namespace isoweave
