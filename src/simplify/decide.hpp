// Deciding one edge: collapse it, or raise its key.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "isoweave/simplify_options.hpp"
#include "simplify/kernels.hpp"
#include "simplify/star.hpp"

namespace isoweave {

struct DecisionCounts {
  std::uint64_t collapses = 0;
  std::uint64_t postponed = 0;  // decided, and illegal at the time
  std::uint64_t rekeyed = 0;    // decided, and dearer than the key said
  std::uint64_t removed = 0;    // triangles

  void operator+=(const DecisionCounts& other) {
    collapses += other.collapses;
    postponed += other.postponed;
    rekeyed += other.rekeyed;
    removed += other.removed;
  }
};

// Decides edges of a zone, one after the other. Reads and writes the two stars of an edge only: deciders in different
// threads may work on the same zone as long as the stars of their edges share no triangle.
class Decider {
 public:
  Decider(Zone& zone, Quality quality) : zone_(zone), quality_(quality) {}

  // Gathers the stars of the edge's ends, one after the other, and shows them to see(star) until that answers false.
  // Tells whether it never did; then the stars stay for decide().
  template <class See>
  bool look_at(Index half_edge, const See& see) {
    edge_ = half_edge;
    Index to_v = half_edge;
    Index to_u = zone_.twin(half_edge);
    Index u = zone_.origin(half_edge);
    Index v = zone_.destination(half_edge);
    if (!exists(to_u)) to_u = zone_.vertices[v].half_edge;
    if (zone_.vertices[v].id < zone_.vertices[u].id) {
      std::swap(u, v);
      std::swap(to_u, to_v);
    }
    u_.gather(zone_, u, to_v);
    if (!see(u_)) return false;
    v_.gather(zone_, v, to_u);
    return see(v_);
  }

  void look_at(Index half_edge) {
    look_at(half_edge, [](const Star&) { return true; });
  }

  const Star& first() const { return u_; }
  const Star& second() const { return v_; }

  // Decides the edge looked at, whose key must be the smallest of all live edges that conflict with it. Afterwards
  // changed() lists the edges whose keys changed.
  void decide();

  const std::array<Index, Star::kRoom>& changed() const { return changed_; }
  int changed_count() const { return changed_count_; }

  // After a collapse: the key that the n-th of them had, the smaller one where two edges have become one.
  Key key_before(std::size_t n) const { return before_[n]; }

  bool collapsed() const { return collapsed_; }  // second()'s vertex is gone then, and first()'s has the merged star
  const Star& merged() const { return merged_; }
  const DecisionCounts& counts() const { return counts_; }

 private:
  bool topology_allows();
  bool keeps_sides(Vec3 x) const;
  Vec3 best_place(const Quadric& full, Vec3 gradient, double offset) const;
  bool place(const Quadric& q, Vec3 best, CostBits limit, Vec3& x) const;
  void raise_key(CostBits cost);
  void collapse(Vec3 x);
  void join_rings();
  void merge_sides(Index h);
  void update_keys(CostBits collapse_cost);

  Zone& zone_;
  Quality quality_;
  const Kernels& kernels_ = kernels();
  Index edge_ = kNone;
  Star u_, v_;  // u_ is the end with the smaller id: sums never depend on memory order
  Star merged_;
  Fan u_fan_, v_fan_;
  Vec3 edge_vector_;  // from u to v; places are measured from u
  std::array<Index, Star::kRoom> changed_;
  std::array<Key, Star::kRoom> before_;
  int changed_count_ = 0;
  bool collapsed_ = false;
  DecisionCounts counts_;
};

}  // namespace isoweave
