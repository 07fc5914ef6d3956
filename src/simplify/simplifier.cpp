#include "simplify/simplifier.hpp"

#include <algorithm>

#include "isoweave/error.hpp"
#include "parallel/collect.hpp"
#include "simplify/local_minima.hpp"
#include "simplify/queue.hpp"
#include "simplify/rounds.hpp"

namespace isoweave {

namespace {

constexpr std::int64_t kBlock = 8192;

std::unique_ptr<Driver> make_driver(Schedule schedule, Zone& zone, Quality quality, const Executor& executor) {
  switch (schedule) {
    case Schedule::kQueue:
      return std::make_unique<Queue>(zone, quality);
    case Schedule::kRounds:
      return std::make_unique<Rounds>(zone, quality, executor);
    default:
      return std::make_unique<LocalMinima>(zone, quality, executor);
  }
}

}  // namespace

Simplifier::Simplifier(const SimplifierOptions& options, const Executor& executor, const std::atomic<bool>* stop)
    : zone_(options.zone),
      executor_(executor),
      stop_(stop),
      schedule_(options.schedule == Schedule::kAutomatic ? Schedule::kLocal : options.schedule),
      driver_(make_driver(schedule_, zone_, options.quality, executor)) {}

void Simplifier::decide() {
  driver_->run(stop_);
  if (stop_ != nullptr && stop_->load()) throw Interrupted("interrupted");
}

std::vector<Index> Simplifier::final_triangles() {
  mark_undecided();
  inspect(name_final_vertices());
  std::vector<Index> triangles;
  collect(
      executor_, zone_.triangle_count(), kBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        for (auto t = static_cast<Index>(begin); t < static_cast<Index>(end); ++t) {
          const auto& [a, b, c] = zone_.triangles[t].sides;
          if (a.vertex == kNone) continue;
          if (!undecided_[a.vertex] && !undecided_[b.vertex] && !undecided_[c.vertex]) list.push_back(t);
        }
      },
      triangles);
  return triangles;
}

void Simplifier::mark_undecided() {
  const CostBits retire = zone_.options().retire;
  undecided_.assign(zone_.vertices.size(), 0);
  const auto mark = [&](Index v) {
    const std::atomic_ref flag(undecided_[v]);
    if (flag.load(std::memory_order_relaxed) == 0) flag.store(1, std::memory_order_relaxed);
  };
  executor_.for_each(zone_.triangle_count(), kBlock, [&](std::int64_t t) {
    const Triangle& triangle = zone_.triangles[static_cast<std::size_t>(t)];
    if (triangle.sides[0].vertex == kNone) return;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& [v, twin, key] = triangle.sides[c];
      if (zone_.states[v] == VertexState::kIncomplete) mark(v);
      if (cost_of(key) > retire) continue;
      mark(v);
      mark(triangle.sides[(c + 1) % 3].vertex);
    }
  });
}

// Vertices that have become final; those of them whose star can be walked.
std::vector<Index> Simplifier::name_final_vertices() {
  std::vector<Index> walkable;
  collect(
      executor_, static_cast<std::int64_t>(zone_.vertices.size()), kBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        for (auto v = static_cast<Index>(begin); v < static_cast<Index>(end); ++v) {
          VertexState& state = zone_.states[v];
          if (undecided_[v] || state == VertexState::kIncomplete || state == VertexState::kFinal) continue;
          if (zone_.walkable(v)) list.push_back(v);
          state = VertexState::kFinal;
        }
      },
      walkable);
  return walkable;
}

// The faces that name a vertex must be the one fan that is found by walking around it, and its neighbours must differ.
void Simplifier::inspect(const std::vector<Index>& vertices) {
  std::vector<std::uint32_t> corners(zone_.vertices.size(), 0);
  executor_.for_each(zone_.triangle_count(), kBlock, [&](std::int64_t t) {
    const Triangle& triangle = zone_.triangles[static_cast<std::size_t>(t)];
    if (triangle.sides[0].vertex == kNone) return;
    for (const HalfEdge& side : triangle.sides) {
      const Index v = side.vertex;
      if (!undecided_[v]) std::atomic_ref(corners[v]).fetch_add(1, std::memory_order_relaxed);
    }
  });
  std::atomic<std::uint64_t> bad_vertices{0};
  std::atomic<std::uint64_t> bad_edges{0};
  executor_.for_blocks(static_cast<std::int64_t>(vertices.size()), kBlock, [&](std::int64_t begin, std::int64_t end) {
    std::vector<Index> neighbours;
    for (std::int64_t n = begin; n < end; ++n) {
      const Index v = vertices[static_cast<std::size_t>(n)];
      if (list_neighbours(v, corners[v], neighbours) != corners[v]) ++bad_vertices;
      std::sort(neighbours.begin(), neighbours.end());
      for (std::size_t m = 1; m < neighbours.size(); ++m) {
        if (neighbours[m] == neighbours[m - 1] && v < neighbours[m]) ++bad_edges;
      }
    }
  });
  defects_.nonmanifold_vertices += bad_vertices;
  defects_.nonmanifold_edges += bad_edges;
}

// Walks around v over at most `most` + 1 faces, and tells how many there are.
std::uint32_t Simplifier::list_neighbours(Index v, std::uint32_t most, std::vector<Index>& neighbours) const {
  neighbours.clear();
  const Index first = zone_.vertices[v].half_edge;
  std::uint32_t faces = 0;
  for (Index h = first; exists(h); h = zone_.rotate(h)) {
    neighbours.push_back(zone_.destination(h));
    const Index back = zone_.rotate(h);
    if (!exists(back)) neighbours.push_back(zone_.origin(previous(h)));
    if (++faces > most || back == first) break;
  }
  return faces;
}

}  // namespace isoweave
