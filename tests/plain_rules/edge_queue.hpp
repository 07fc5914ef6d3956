// Costs of edges, their keys, and the queue of those that are to be decided.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace isoweave::plain {

inline constexpr float kLeastCost = 1e-20F;
inline constexpr float kNever = std::numeric_limits<float>::infinity();

inline float cost_of(double error) {
  const auto cost = static_cast<float>(error);
  if (cost != cost) return kNever;
  return cost <= kLeastCost ? kLeastCost : cost;
}

inline float step_above(float cost) { return std::nextafter(cost, kNever); }

using Key = std::pair<float, std::uint64_t>;  // cost and tie
using Edge = std::pair<std::size_t, std::size_t>;

inline Edge edge_between(std::size_t a, std::size_t b) { return {std::min(a, b), std::max(a, b)}; }

class EdgeQueue {
 public:
  // Edges whose cost is above `retire` are not in the queue.
  explicit EdgeQueue(float retire) : retire_(retire) {}

  float retire() const { return retire_; }
  bool empty() const { return queue_.empty(); }
  std::pair<Key, Edge> first() const { return *queue_.begin(); }
  bool has(const Edge& edge) const { return keys_.contains(edge); }
  const Key& key(const Edge& edge) const { return keys_.at(edge); }

  void set(const Edge& edge, const Key& key) {
    forget(edge);
    keys_[edge] = key;
    if (key.first <= retire_) queue_.insert({key, edge});
  }

  void raise(const Edge& edge, float cost) { set(edge, {cost, key(edge).second}); }

  void forget(const Edge& edge) {
    const auto found = keys_.find(edge);
    if (found == keys_.end()) return;
    queue_.erase({found->second, edge});
    keys_.erase(found);
  }

 private:
  const float retire_;
  std::map<Edge, Key> keys_;
  std::set<std::pair<Key, Edge>> queue_;
};

}  // namespace isoweave::plain
