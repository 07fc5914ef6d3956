#include "output/final_output.hpp"

#include <array>
#include <span>

#include "parallel/collect.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 4096;

}  // namespace

void FinalOutput::take(Simplifier& simplifier) {
  Zone& zone = simplifier.zone();
  const std::vector<Index> triangles = simplifier.final_triangles(level_);
  number_vertices(zone, triangles);
  const auto vertex = [&](std::size_t n, std::size_t c) { return zone.triangles[triangles[n]].sides[c].vertex; };
  output_.add_triangles(
      [&]<class Number>(std::size_t n, std::span<std::array<Number, 3>> out) {
        for (auto& triangle : out) {
          for (std::size_t c = 0; c < 3; ++c) triangle[c] = static_cast<Number>(number(zone, vertex(n, c)));
          ++n;
        }
      },
      [&](std::size_t n, std::size_t c) {
        const Index v = vertex(n, c);
        return OutputCorner{number(zone, v), component(zone, v), output_.point(zone.vertices[v].position)};
      });
  if (zone.locked > 0) keep_locked(zone, triangles);
  const bool last = simplifier.is_last(level_);
  executor_.for_each(static_cast<std::int64_t>(triangles.size()), kBlock, [&](std::int64_t n) {
    const Index t = triangles[static_cast<std::size_t>(n)];
    last ? close_sides(zone, t) : keep(zone, t);
  });
  if (last) simplifier.drop(triangles);
  if (output_.components().labels() > zone.vertices.size()) forget_components(zone);
}

// Numbers the vertices that these triangles are the first to name, in memory order.
void FinalOutput::number_vertices(Zone& zone, const std::vector<Index>& triangles) {
  marks_.assign(zone.vertices.size(), 0);
  executor_.for_each(static_cast<std::int64_t>(triangles.size()), kBlock, [&](std::int64_t n) {
    for (const HalfEdge& side : zone.triangles[triangles[static_cast<std::size_t>(n)]].sides) {
      if (number(zone, side.vertex) != kNotWritten) continue;
      std::atomic_ref(marks_[side.vertex]).store(1, std::memory_order_relaxed);
    }
  });
  collect(
      executor_, static_cast<std::int64_t>(marks_.size()), kBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
          if (marks_[v] != 0) list.push_back(v);
        }
      },
      new_vertices_);
  const std::uint64_t first = output_.vertices();
  const std::uint32_t label = output_.add_vertices(
      {new_vertices_.size(), triangles.size(), !zone.normals.empty(), !zone.values.empty()},
      [&](std::size_t n) { return zone.vertices[new_vertices_[n]].position; },
      [&](std::size_t n) { return zone.normals[new_vertices_[n]]; },
      [&](std::size_t n) { return zone.values[new_vertices_[n]]; });
  executor_.for_each(static_cast<std::int64_t>(new_vertices_.size()), kBlock, [&](std::int64_t n) {
    const Index v = new_vertices_[static_cast<std::size_t>(n)];
    number(zone, v) = first + static_cast<std::uint64_t>(n);
    component(zone, v) = label + static_cast<std::uint32_t>(n);
  });
}

// Keeps the triangles around locked vertices.
void FinalOutput::keep_locked(Zone& zone, const std::vector<Index>& triangles) {
  for (const Index t : triangles) {
    std::array<std::uint64_t, 3> numbers{};
    std::array<bool, 3> locked{};
    for (std::size_t c = 0; c < 3; ++c) {
      const Index v = zone.triangles[t].sides[c].vertex;
      numbers[c] = number(zone, v);
      locked[c] = zone.states[v] == VertexState::kLocked;
    }
    if (locked[0] || locked[1] || locked[2]) locked_part_.add(numbers, locked);
  }
}

void FinalOutput::count_open(const Zone& zone, const HalfEdge& side, const HalfEdge& next_side) {
  const bool locked =
      zone.states[side.vertex] == VertexState::kLocked || zone.states[next_side.vertex] == VertexState::kLocked;
  if (!locked) open_edges_.fetch_add(1, std::memory_order_relaxed);
}

// Counts that a finer level has the triangle, which stays for the coarser levels.
void FinalOutput::keep(Zone& zone, Index triangle) {
  ++zone.triangles[triangle].levels;
  const auto& sides = zone.triangles[triangle].sides;
  for (std::size_t c = 0; c < 3; ++c) {
    if (sides[c].twin == kNone) count_open(zone, sides[c], sides[(c + 1) % 3]);
  }
}

// Tells the triangles beside this one that it is gone. Neighbours may leave at the same time.
void FinalOutput::close_sides(Zone& zone, Index triangle) {
  auto& sides = zone.triangles[triangle].sides;
  for (std::size_t c = 0; c < 3; ++c) {
    const Index twin = std::atomic_ref(sides[c].twin).load(std::memory_order_relaxed);
    if (twin == kNone) count_open(zone, sides[c], sides[(c + 1) % 3]);
    if (exists(twin)) std::atomic_ref(zone.half(twin).twin).store(kWritten, std::memory_order_relaxed);
  }
}

void FinalOutput::forget_components(Zone& zone) {
  std::vector<std::uint32_t*> labels;
  for (Index v = 0; v < zone.vertices.size(); ++v) {
    if (number(zone, v) != kNotWritten) labels.push_back(&component(zone, v));
  }
  output_.components().compact(labels);
}

}  // namespace isoweave
