// The zone of a surface that is cut: what it holds becomes a part, and a part becomes what it holds.
#include <algorithm>
#include <utility>

#include "simplify/part_copy.hpp"
#include "simplify/zone.hpp"
#include "simplify/zone_rules.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kCutBlock = 2048;

}  // namespace

ZonePart Zone::take_part(const std::function<bool(std::uint64_t, std::uint64_t)>& is_border, const Executor& executor) {
  compact(executor);
  const auto is_cut = [&](Index h) {
    const Index a = origin(h);
    const Index b = destination(h);
    return states[a] == VertexState::kIncomplete && states[b] == VertexState::kIncomplete &&
           !is_border(vertices[a].id, vertices[b].id);
  };
  executor.for_each(static_cast<std::int64_t>(triangle_count()), kCutBlock, [&](std::int64_t t) {
    for (Index h = half_edge(static_cast<Index>(t), 0); h <= half_edge(static_cast<Index>(t), 2); ++h) {
      if (exists(twin(h)) || (twin(h) == kNone && is_cut(h))) set_twin(h, kWritten);
    }
  });
  ZonePart part;
  part.vertices = std::move(vertex_array_);
  part.states = std::move(state_array_);
  part.normals = std::move(normal_array_);
  part.normal_quadrics = std::move(normal_quadric_array_);
  part.values = std::move(value_array_);
  part.triangles = std::move(triangle_array_);
  part.levels = std::move(levels);
  return part;
}

ZonePart Zone::copy_settled(const std::vector<Index>& gone) {
  std::vector<Index> place(vertices.size(), kNone);
  ZonePart part = copy_some(*this, gone, place);
  std::fill(part.states.begin(), part.states.end(), VertexState::kComplete);
  for (Triangle& triangle : part.triangles) {
    for (HalfEdge& side : triangle.sides) {
      if (exists(side.twin)) set_twin(side.twin, kWritten);
      if (side.twin != kNone) side.twin = kWritten;
    }
  }
  return part;
}

void Zone::put_part(ZonePart part, const Executor& executor) {
  const std::vector<Index> completed = std::move(part.completed);
  take_arrays(part);
  countdown.begin(vertices.size());
  executor.for_each(static_cast<std::int64_t>(completed.size()), kCutBlock, [&](std::int64_t n) {
    const Index v = completed[static_cast<std::size_t>(n)];
    start_fan(*this, v);
    Star star;
    star.gather(*this, v);
    initial_quadric(star);
  });
  settle_waiting_edges(executor);
  settle_all();
}

}  // namespace isoweave
