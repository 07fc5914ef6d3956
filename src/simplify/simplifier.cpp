#include "simplify/simplifier.hpp"

#include <algorithm>

#include "isoweave/error.hpp"

namespace isoweave {

Simplifier::Simplifier(const SimplifierOptions& options, const Executor& executor, const std::atomic<bool>* stop)
    : zone_(options.zone), executor_(executor), stop_(stop) {
  const bool parallel =
      options.schedule == Schedule::kRounds || (options.schedule == Schedule::kAutomatic && executor.threads() > 1);
  if (parallel) {
    rounds_ = std::make_unique<Rounds>(zone_, options.quality, executor, options.rounds);
  } else {
    queue_ = std::make_unique<Queue>(zone_, options.quality);
  }
}

void Simplifier::decide() {
  if (rounds_) {
    rounds_->run(stop_);
  } else {
    Buckets edges;
    list_live_edges(zone_, zone_.options().retire, executor_, edges);
    Flags flags(zone_.vertices.size(), 0);
    flag_front(zone_, flags);
    queue_->run(edges.items, zone_.options().retire, flags, stop_);
    ++runs_;
  }
  if (stop_ != nullptr && stop_->load()) throw Interrupted("interrupted");
}

DecisionCounts Simplifier::counts() const { return rounds_ ? rounds_->counts() : queue_->counts(); }

std::vector<Index> Simplifier::final_triangles() {
  const CostBits retire = zone_.options().retire;
  std::vector<std::uint8_t> undecided(zone_.vertices.size(), 0);
  std::vector<std::uint32_t> corners(zone_.vertices.size(), 0);
  for (Index v = 0; v < undecided.size(); ++v) undecided[v] = zone_.states[v] == VertexState::kIncomplete;
  for (Index h = 0; h < zone_.half_edges.size(); ++h) {
    if (!zone_.alive(h)) continue;
    ++corners[zone_.origin(h)];
    if (zone_.cost[h] > retire) continue;
    undecided[zone_.origin(h)] = 1;
    undecided[zone_.destination(h)] = 1;
  }
  for (Index v = 0; v < undecided.size(); ++v) {
    if (undecided[v] || corners[v] == 0 || zone_.states[v] == VertexState::kFinal) continue;
    if (zone_.states[v] == VertexState::kComplete) inspect_final_vertex(v, corners[v]);
    zone_.states[v] = VertexState::kFinal;
  }
  std::vector<Index> triangles;
  for (Index t = 0; t < zone_.triangles(); ++t) {
    const Index h = 3 * t;
    if (!zone_.alive(h)) continue;
    if (!undecided[zone_.origin(h)] && !undecided[zone_.origin(h + 1)] && !undecided[zone_.origin(h + 2)]) {
      triangles.push_back(t);
    }
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
