#include "simplify/simplifier.hpp"

#include <algorithm>

#include "isoweave/error.hpp"
#include "simplify/local_minima.hpp"
#include "simplify/queue.hpp"
#include "simplify/rounds.hpp"

namespace isoweave {

namespace {

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
  const CostBits retire = zone_.options().retire;
  std::vector<std::uint8_t> undecided(zone_.vertices.size(), 0);
  std::vector<std::uint32_t> corners(zone_.vertices.size(), 0);
  for (Index v = 0; v < undecided.size(); ++v) undecided[v] = zone_.states[v] == VertexState::kIncomplete;
  for (const Triangle& triangle : zone_.triangles) {
    if (triangle.vertex[0] == kNone) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      ++corners[triangle.vertex[c]];
      if (triangle.cost[c] > retire) continue;
      undecided[triangle.vertex[c]] = 1;
      undecided[triangle.vertex[(c + 1) % 3]] = 1;
    }
  }
  for (Index v = 0; v < undecided.size(); ++v) {
    if (undecided[v] || corners[v] == 0 || zone_.states[v] == VertexState::kFinal) continue;
    if (zone_.states[v] == VertexState::kComplete) inspect_final_vertex(v, corners[v]);
    zone_.states[v] = VertexState::kFinal;
  }
  std::vector<Index> triangles;
  for (Index t = 0; t < zone_.triangle_count(); ++t) {
    const auto& [a, b, c] = zone_.triangles[t].vertex;
    if (a != kNone && !undecided[a] && !undecided[b] && !undecided[c]) triangles.push_back(t);
  }
  return triangles;
}

// The faces that name v must be the one fan that is found by walking around it, and its neighbours must differ.
void Simplifier::inspect_final_vertex(Index v, std::uint32_t corners) {
  std::vector<Index> neighbours;
  const Index first = zone_.vertices[v].half_edge;
  std::uint32_t faces = 0;
  for (Index h = first; exists(h); h = zone_.rotate(h)) {
    neighbours.push_back(zone_.destination(h));
    const Index back = zone_.rotate(h);
    if (!exists(back)) neighbours.push_back(zone_.origin(previous(h)));
    if (++faces > corners || back == first) break;
  }
  if (faces != corners) ++defects_.nonmanifold_vertices;
  std::sort(neighbours.begin(), neighbours.end());
  for (std::size_t n = 1; n < neighbours.size(); ++n) {
    if (neighbours[n] == neighbours[n - 1] && v < neighbours[n]) ++defects_.nonmanifold_edges;
  }
}

}  // namespace isoweave
