// Deciding one edge: collapse it, or raise its key.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "isoweave/simplify_options.hpp"
#include "simplify/zone.hpp"

namespace isoweave {

// The faces around a vertex, counter-clockwise: face n lies between neighbours n and n + 1 (modulo the number of
// neighbours in a closed star; an open star has one neighbour more than faces).
struct Star {
  // Stars with more neighbours cannot merge within kMaxValence and are gathered up to here only.
  static constexpr int kCapacity = 28;

  Index vertex = kNone;
  int faces = 0;
  int neighbours = 0;
  bool border = false;
  bool overflow = false;
  std::array<Index, kCapacity + 1> out;  // half-edge of face n that starts at the vertex
  std::array<Index, kCapacity + 1> neighbour;

  void gather(const Zone& zone, Index v);

  // Calls visit(w) for every neighbour, those past the capacity included, until it answers false. Tells whether it
  // never did.
  template <class Visit>
  bool each_neighbour(const Zone& zone, const Visit& visit) const {
    for (int n = 0; n < neighbours; ++n) {
      if (!visit(neighbour[static_cast<std::size_t>(n)])) return false;
    }
    if (!overflow) return true;
    const Index first = zone.vertices[vertex].half_edge;
    Index h = first;
    do {
      if (!visit(zone.destination(h)) || !visit(zone.origin(previous(h)))) return false;
      h = zone.rotate(h);
    } while (h != first && exists(h));
    return true;
  }
};

// Where the faces of a star lie, measured from its vertex.
struct Fan {
  std::array<Vec3, Star::kCapacity + 1> to;   // the neighbours
  std::array<Vec3, Star::kCapacity> normals;  // of the faces, twice as long as their area

  void measure(const Zone& zone, const Star& star);
};

struct DecisionCounts {
  std::uint64_t collapses = 0;
  std::uint64_t postponed = 0;  // decided, and illegal at the time
  std::uint64_t rekeyed = 0;    // decided, and dearer than the key said

  void operator+=(const DecisionCounts& other) {
    collapses += other.collapses;
    postponed += other.postponed;
    rekeyed += other.rekeyed;
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
    Index a = zone_.origin(half_edge);
    Index b = zone_.destination(half_edge);
    if (zone_.vertices[b].id < zone_.vertices[a].id) std::swap(a, b);
    u_.gather(zone_, a);
    if (!see(u_)) return false;
    v_.gather(zone_, b);
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

  const std::array<Index, 2 * Star::kCapacity>& changed() const { return changed_; }
  int changed_count() const { return changed_count_; }
  bool collapsed() const { return collapsed_; }  // first() is the star of the merged vertex then
  const DecisionCounts& counts() const { return counts_; }

 private:
  bool topology_allows() const;
  bool keeps_sides(Vec3 x) const;
  Quadric current_faces(const Star& star, const Fan& fan, const Star* skip, Vec3& normal_sum) const;
  Vec3 best_place(const Quadric& full, Vec3 gradient, double offset) const;
  bool place(const Quadric& q, Vec3 best, CostBits limit, Vec3& x) const;
  void raise_key(CostBits cost);
  void collapse(Vec3 x);
  void merge_sides(Index h);
  void update_keys(CostBits collapse_cost);

  Zone& zone_;
  Quality quality_;
  Index edge_ = kNone;
  Star u_, v_;  // u_ is the end with the smaller id: sums never depend on memory order
  Fan u_fan_, v_fan_;
  Vec3 edge_vector_;  // from u to v; places are measured from u
  std::array<Index, 2 * Star::kCapacity> changed_;
  int changed_count_ = 0;
  bool collapsed_ = false;
  DecisionCounts counts_;
};

}  // namespace isoweave
