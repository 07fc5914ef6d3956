// Deciding one edge: collapse it, or raise its key.
#pragma once

#include <array>
#include <cstdint>

#include "extract/gradient.hpp"
#include "isoweave/simplify_options.hpp"
#include "lattice/value_rules.hpp"
#include "parallel/atomics.hpp"
#include "parallel/prefetch.hpp"
#include "simplify/kernels.hpp"
#include "simplify/reach.hpp"
#include "simplify/simplify_totals.hpp"
#include "simplify/star.hpp"
#include "simplify/zone_rules.hpp"

namespace isoweave {

// Decides edges of a zone, one after the other. A decision reads and writes the two stars of its edge only, so deciders
// in different threads may work on the same zone as long as the stars of their edges share no triangle. Arithmetic
// computes several faces or edges at once. Every kind of arithmetic gives the same bits.
template <class Arithmetic>
class BasicDecider {
 public:
  ISOWEAVE_HD explicit BasicDecider(const ZoneView& zone) : zone_(zone) {}

  // Gathers the stars of the edge's ends, one after the other, and shows each to see(star) until see() answers false.
  // Returns whether see() never answered false. Then the stars stay for decide().
  template <class See>
  ISOWEAVE_HD bool look_at(Index half_edge, const See& see) {
    edge_ = half_edge;
    const Index to_v = half_edge;
    Index to_u = zone_.twin(half_edge);
    const Index u = zone_.origin(half_edge);
    const Index v = zone_.destination(half_edge);
    if (!exists(to_u)) to_u = zone_.vertices[v].half_edge;
    const Index ends[2] = {u, v};
    const Index starts[2] = {to_v, to_u};
    const std::size_t first = zone_.vertices[v].id < zone_.vertices[u].id ? 1 : 0;
    u_.gather(zone_, ends[first], starts[first]);
    if (!see(u_)) return false;
    v_.gather(zone_, ends[1 - first], starts[1 - first]);
    return see(v_);
  }

  ISOWEAVE_HD void look_at(Index half_edge) {
    look_at(half_edge, [](const Star&) { return true; });
  }

  ISOWEAVE_HD const Star& first() const { return u_; }
  ISOWEAVE_HD const Star& second() const { return v_; }

  // Decides the edge whose stars have been gathered. Its key must be the smallest of all live edges that conflict with
  // it. Afterwards changed() lists the edges whose keys changed.
  ISOWEAVE_HD void decide();

  ISOWEAVE_HD const std::array<Index, Star::kRoom>& changed() const { return changed_; }
  ISOWEAVE_HD int changed_count() const { return changed_count_; }

  // After a collapse, for the n-th changed edge: the end that is not the merged vertex, and the key before the
  // collapse. Where two edges have become one, that is the smaller of the two keys.
  ISOWEAVE_HD Index changed_end(std::size_t n) const { return changed_end_[n]; }
  ISOWEAVE_HD Key key_before(std::size_t n) const { return before_[n]; }

  ISOWEAVE_HD bool collapsed() const {
    return collapsed_;
  }  // second()'s vertex is gone then, and first()'s has the merged star
  ISOWEAVE_HD const Star& merged() const { return merged_; }

  // Whether nothing has been decided, as the part of the surface that the decision needs has not been extracted yet.
  // Both ends are deferred then.
  ISOWEAVE_HD bool deferred() const { return deferred_; }

  // Whether a speck has vanished: the tetrahedron of first()'s vertex and its three neighbours.
  ISOWEAVE_HD bool vanished() const { return vanished_; }
  ISOWEAVE_HD const DecisionCounts& counts() const { return counts_; }

 private:
  using Fan = typename Arithmetic::Fan;

  static constexpr CostBits kTried = 0xffffffffu;  // above every limit

  // The face of a star of three faces that does not hold `other`.
  ISOWEAVE_HD static Index far_face(const Star& star, Index other) {
    return star.out[(star.place_of(other) + 1) % 3] >> 2;
  }

  // Drops the faces that hold both ends of the edge: they vanish when the edge collapses.
  ISOWEAVE_HD static void drop_shared_faces(const Star& star, Index other, Fan& fan) {
    const std::size_t place = star.place_of(other);
    fan.drop(place);
    fan.drop(place > 0 ? place - 1 : star.count() - 1);
  }

  ISOWEAVE_HD bool is_tetrahedron() const;
  ISOWEAVE_HD void decide_tetrahedron(CostBits key);
  ISOWEAVE_HD bool topology_allows();
  ISOWEAVE_HD bool keeps_sides(Vec3 x) const;
  ISOWEAVE_HD Vec3 best_place(const Quadric& full, Vec3 gradient, double offset) const;
  ISOWEAVE_HD double memory() const;
  ISOWEAVE_HD Quadric full_quadric(const Star& star, const Quadric& faces) const;
  ISOWEAVE_HD Quadric with_normals(const Quadric& full) const;
  ISOWEAVE_HD Reach reach(Vec3 x);
  ISOWEAVE_HD Reach place(const Quadric& q, Vec3 best, CostBits limit, Vec3& x);
  ISOWEAVE_HD static CostBits cost_as_made(const Quadric& full, Vec3 x, CostBits key);
  ISOWEAVE_HD void defer();
  ISOWEAVE_HD void raise_key(CostBits cost);
  ISOWEAVE_HD void collapse(Vec3 x);
  ISOWEAVE_HD void merge_normals(Vec3 x);
  ISOWEAVE_HD void join_rings();
  ISOWEAVE_HD void merge_sides(Index h);
  ISOWEAVE_HD void prefetch_beyond(std::size_t n) const;
  ISOWEAVE_HD void update_keys(CostBits collapse_cost);

  const ZoneView& zone_;
  [[no_unique_address]] Arithmetic arithmetic_;
  Index edge_ = kNone;
  Star u_, v_;  // u_ is the end with the smaller id: sums never depend on memory order
  Star merged_;
  Fan u_fan_, v_fan_;
  Vec3 edge_vector_;  // from u to v; places are measured from u
  std::array<Index, Star::kRoom> changed_;
  std::array<Index, Star::kRoom> changed_end_;
  std::array<Key, Star::kRoom> before_;
  int changed_count_ = 0;
  bool collapsed_ = false;
  bool vanished_ = false;
  bool deferred_ = false;
  DecisionCounts counts_;
  [[no_unique_address]] typename Arithmetic::Bounds bounds_;  // of the faces around the place that was tried last
};

template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::decide() {
  changed_count_ = 0;
  collapsed_ = vanished_ = deferred_ = false;
  const CostBits key = zone_.cost(edge_);
  if (zone_.options.drop_specks && is_tetrahedron()) return decide_tetrahedron(key);
  if (u_.overflow || v_.overflow || !topology_allows()) {
    ++counts_.postponed;
    raise_key(postponed_cost(key));
    return;
  }
  const Vertex& u = zone_.vertices[u_.vertex];
  const Vertex& v = zone_.vertices[v_.vertex];
  edge_vector_ = v.position - u.position;
  arithmetic_.measure(zone_, u_, u_fan_);
  arithmetic_.measure(zone_, v_, v_fan_);
  drop_shared_faces(v_, u_.vertex, v_fan_);
  Quadric full;
  Vec3 best;
  CostBits limit = key;
  if (zone_.options.quality == Quality::kFast) {
    full = with_normals(u.quadric + moved(v.quadric, -edge_vector_));
    best = minimiser(full, factorise(full), 0.5 * edge_vector_);
  } else {
    const double weight = (2 - memory()) * initial_weight(zone_.options);
    const FaceSums u_sums = arithmetic_.sum_faces(u_fan_, u_.count(), weight);
    const FaceSums v_sums = arithmetic_.sum_faces(v_fan_, v_.count(), weight);
    full = with_normals(full_quadric(u_, u_sums.planes) + moved(full_quadric(v_, v_sums.planes), -edge_vector_));
    best = best_place(full, u_sums.normal + v_sums.normal, dot(v_sums.normal, edge_vector_));
    limit = scaled(key, key_factors(zone_.options.quality).limit);
    const CostBits cost = to_cost(evaluate(full, best));
    if (cost > limit) {
      ++counts_.rekeyed;
      raise_key(cost);
      return;
    }
  }
  drop_shared_faces(u_, v_.vertex, u_fan_);
  Vec3 x;
  const Reach placed = place(full, best, limit, x);
  if (placed == Reach::kUnknown) return defer();
  if (placed == Reach::kBeyond) {
    ++counts_.postponed;
    raise_key(postponed_cost(key));
    return;
  }
  ++counts_.collapses;
  counts_.note_cost(cost_as_made(full, x, key));
  collapsed_ = true;
  if constexpr (Arithmetic::kBoundsDistances) {
    if (zone_.extracted != nullptr) keep_bounds(zone_, u_, v_, bounds_);
  }
  collapse(x);
  update_keys(key);
}

// Whether the two stars form a closed tetrahedron: both ends have the same two neighbours beside each other, and no
// border.
template <class Arithmetic>
ISOWEAVE_HD bool BasicDecider<Arithmetic>::is_tetrahedron() const {
  if (u_.border || v_.border || u_.neighbours != 3 || v_.neighbours != 3) return false;
  for (std::size_t n = 0; n < 3; ++n) {
    const Index w = u_.neighbour[n];
    if (w != v_.vertex && w != v_.neighbour[0] && w != v_.neighbour[1] && w != v_.neighbour[2]) return false;
  }
  return true;
}

// Decides an edge of a tetrahedron. A speck vanishes at a cost of its own: half its longest edge, squared. An edge with
// a smaller key goes back with that cost, so that levels nest.
template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::decide_tetrahedron(CostBits key) {
  double longest = 0;
  const Index corners[4] = {u_.vertex, u_.neighbour[0], u_.neighbour[1], u_.neighbour[2]};
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < a; ++b) {
      const Vec3 edge = zone_.vertices[corners[a]].position - zone_.vertices[corners[b]].position;
      const double length = dot(edge, edge);
      longest = length > longest ? length : longest;
    }
  }
  const CostBits cost = to_cost(longest / (4 * zone_.options.a0));
  if (cost > key) {
    ++counts_.rekeyed;
    raise_key(cost);
    return;
  }
  for (int n = 0; n < 3; ++n) zone_.remove_triangle(u_.out[static_cast<std::size_t>(n)] >> 2);
  zone_.remove_triangle(far_face(v_, u_.vertex));
  for (const Index corner : corners) zone_.vertices[corner].half_edge = kNone;
  counts_.removed += 4;
  counts_.note_cost(cost);
  ++counts_.specks;
  vanished_ = true;
}

// Link condition (Dey, Edelsbrunner, Guha and Nekhayev, 1999), border and valence rules.
template <class Arithmetic>
ISOWEAVE_HD bool BasicDecider<Arithmetic>::topology_allows() {
  const bool border_edge = !exists(zone_.twin(edge_));
  if (u_.border && v_.border && !border_edge) return false;
  const int opposite = border_edge ? 1 : 2;
  if (u_.neighbours + v_.neighbours - 2 - opposite > kMaxValence) return false;
  if (arithmetic_.count_common(u_, v_) != opposite) return false;
  // One case is left to exclude: both ends have no neighbours but each other and the opposite vertices. Then the
  // surface is a tetrahedron (both stars hold the face over the opposite vertices), or, on a border, a single triangle.
  return !(u_.neighbours == opposite + 1 && v_.neighbours == opposite + 1 && u_.border == v_.border);
}

// Whether the faces that stay after the collapse keep their sides.
template <class Arithmetic>
ISOWEAVE_HD bool BasicDecider<Arithmetic>::keeps_sides(Vec3 x) const {
  return arithmetic_.keeps_sides(u_fan_, u_.count(), x) &&
         arithmetic_.keeps_sides(v_fan_, v_.count(), x - edge_vector_);
}

// The place of least full cost among the points x (gradient . x = offset) that keep the enclosed volume when the edge
// shrinks to x (Lindstrom and Turk, 1998).
template <class Arithmetic>
ISOWEAVE_HD Vec3 BasicDecider<Arithmetic>::best_place(const Quadric& full, Vec3 gradient, double offset) const {
  const Factors<double> factors = factorise(full);
  const Vec3 best = minimiser(full, factors, 0.5 * edge_vector_);
  const Vec3 response = solve(factors, gradient);
  const double strength = dot(gradient, response);
  return strength > 0 ? best + ((offset - dot(gradient, best)) / strength) * response : best;
}

// Whether the faces around the merged vertex stay within the distance that is allowed.
template <class Arithmetic>
ISOWEAVE_HD Reach BasicDecider<Arithmetic>::reach([[maybe_unused]] Vec3 x) {
  if constexpr (Arithmetic::kBoundsDistances) {
    if (zone_.extracted != nullptr) {
      return reach_of_collapse(zone_, u_, v_, zone_.vertices[u_.vertex].position + x, zone_.cost(edge_), bounds_);
    }
  }
  return Reach::kWithin;
}

// Weight of the vertices' quadrics in a full cost, where all weights add up to 2. Only the quadrics know about normals,
// so where normals count the quadrics count as much as the faces.
template <class Arithmetic>
ISOWEAVE_HD double BasicDecider<Arithmetic>::memory() const {
  return zone_.normal_quadrics.empty() ? kMemory : 1;
}

// The full quadric of a star's vertex: its own quadric, the planes of its faces, and on a border the planes of its
// border edges.
template <class Arithmetic>
ISOWEAVE_HD Quadric BasicDecider<Arithmetic>::full_quadric(const Star& star, const Quadric& faces) const {
  const Quadric sum = memory() * zone_.vertices[star.vertex].quadric + faces;
  if (!star.border) return sum;
  const std::size_t last = star.count() - 1;
  return sum + (2 - memory()) * (border_plane(zone_, star.vertex, star.neighbour[0], star.out[0]) +
                                 border_plane(zone_, star.vertex, star.neighbour[last], star.out[last - 1]));
}

// The quadric of both ends, measured from u, less what the best normal at each place saves where normals count.
template <class Arithmetic>
ISOWEAVE_HD Quadric BasicDecider<Arithmetic>::with_normals(const Quadric& full) const {
  if (zone_.normal_quadrics.empty()) return full;
  const NormalQuadric& u = zone_.normal_quadrics[u_.vertex];
  return with_best_normal(full, u + moved(zone_.normal_quadrics[v_.vertex], -edge_vector_));
}

// Finds the first place that keeps every face on its side and within the distance bound. Tried are the best place, then
// the two ends and the midpoint, cheapest first, as long as they cost no more than the limit.
template <class Arithmetic>
ISOWEAVE_HD Reach BasicDecider<Arithmetic>::place(const Quadric& q, Vec3 best, CostBits limit, Vec3& x) {
  x = best;
  if (keeps_sides(x)) {
    const Reach found = reach(x);
    if (found != Reach::kBeyond) return found;
  }
  const Vec3 places[3] = {Vec3{}, edge_vector_, 0.5 * edge_vector_};
  CostBits costs[3];
  for (int n = 0; n < 3; ++n) costs[n] = to_cost(evaluate(q, places[n]));
  for (int tried = 0; tried < 3; ++tried) {
    int cheapest = 0;
    for (int n = 1; n < 3; ++n) cheapest = costs[n] < costs[cheapest] ? n : cheapest;
    if (costs[cheapest] > limit) return Reach::kBeyond;
    x = places[cheapest];
    if (keeps_sides(x)) {
      const Reach found = reach(x);
      if (found != Reach::kBeyond) return found;
    }
    costs[cheapest] = kTried;
  }
  return Reach::kBeyond;
}

// The cost of the place that was taken. It may be below the key, as the key grows each time the edge goes back. It
// never counts as more than the key, because the key is compared with the error.
template <class Arithmetic>
ISOWEAVE_HD CostBits BasicDecider<Arithmetic>::cost_as_made(const Quadric& full, Vec3 x, CostBits key) {
  const CostBits cost = to_cost(evaluate(full, x));
  return cost < key ? cost : key;
}

// Blocks the edge and all edges that conflict with it.
template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::defer() {
  deferred_ = true;
  for (const Index end : {u_.vertex, v_.vertex}) {
    zone_.states[end] = VertexState::kDeferred;
    publish(zone_.turn_keys[end], kUnknownTurn);
  }
}

template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::raise_key(CostBits cost) {
  ISOWEAVE_CHECK(cost >= zone_.cost(edge_));
  zone_.set_cost(edge_, cost);
  changed_[static_cast<std::size_t>(changed_count_++)] = edge_;
}

// Removes the triangle of half-edge h, one of the two at the edge. The two other edges of the triangle become one,
// which keeps the key and the tie of the edge with the smaller key.
template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::merge_sides(Index h) {
  const Index a = next(h);
  const Index b = previous(h);
  const Index outer_a = zone_.twin(a);
  const Index outer_b = zone_.twin(b);
  const Index least = zone_.comes_before(a, b) ? a : b;
  const Key key = zone_.key(least);
  const std::uint32_t tie_low = zone_.tie_low(least);
  const Index outer[2] = {outer_a, outer_b};
  for (int n = 0; n < 2; ++n) {
    if (!exists(outer[n])) continue;
    zone_.half(outer[n]).twin = outer[1 - n];
    zone_.half(outer[n]).key = key;
    zone_.triangles[outer[n] >> 2].tie_low[outer[n] & 3] = tie_low;
  }
  // The opposite vertex may have its starting half-edge here. Another collapse may change the same vertex from its
  // side.
  Index& start = zone_.vertices[zone_.origin(b)].half_edge;
  if (load_relaxed(start) == b) store_relaxed(start, outer_a);
  zone_.remove_triangle(h >> 2);
  ++counts_.removed;
}

// Merges the two ends into the vertex of u_, which moves by x.
template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::collapse(Vec3 x) {
  const Index back = zone_.twin(edge_);
  for (int n = 0; n < v_.faces; ++n) {
    zone_.half(v_.out[static_cast<std::size_t>(n)]).vertex = u_.vertex;
  }
  merge_sides(edge_);
  if (exists(back)) merge_sides(back);

  Vertex& merged = zone_.vertices[u_.vertex];
  Vertex& gone = zone_.vertices[v_.vertex];
  merged.quadric = moved(merged.quadric, x) + moved(gone.quadric, x - edge_vector_);
  merged.position = merged.position + x;
  gone.half_edge = kNone;
  merge_normals(x);
  if (!zone_.values.empty()) {
    float& value = zone_.values[u_.vertex];
    const double t = place_along(edge_vector_, x);
    value = static_cast<float>(value_between(double{value}, double{zone_.values[v_.vertex]}, t));
  }
  join_rings();
}

// Merges the normals of both ends: their sum, or, where normals count, the best normal at x.
template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::merge_normals(Vec3 x) {
  if (zone_.normals.empty()) return;
  Point& normal = zone_.normals[u_.vertex];
  if (zone_.normal_quadrics.empty()) {
    for (std::size_t c = 0; c < 3; ++c) normal[c] += zone_.normals[v_.vertex][c];
    return;
  }
  NormalQuadric& merged = zone_.normal_quadrics[u_.vertex];
  merged = moved(merged, x) + moved(zone_.normal_quadrics[v_.vertex], x - edge_vector_);
  normal = unit_point(merged.offset);
}

// Gathers the star of the merged vertex: around u_ from the first opposite vertex to the second, then around v_ back to
// the first.
template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::join_rings() {
  Index& start = zone_.vertices[u_.vertex].half_edge;
  if (u_.border || v_.border) {
    start = kNone;
    const Star* const stars[2] = {&u_, &v_};
    for (const Star* star : stars) {
      for (int n = 0; n < star->faces; ++n) {
        const Index h = star->out[static_cast<std::size_t>(n)];
        if (!zone_.alive(h)) continue;
        if (start == kNone || !exists(zone_.twin(h))) start = h;
      }
    }
    merged_.gather(zone_, u_.vertex);
    return;
  }
  merged_.join(u_, v_);
  start = merged_.out[0];
}

// Fetches the triangle beyond the n-th face of the merged star, which a walk around a neighbour begins with.
template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::prefetch_beyond(std::size_t n) const {
  if (n == static_cast<std::size_t>(merged_.faces)) return;
  const Index beyond = zone_.twin(next(merged_.out[n]));
  prefetch(&zone_.half(exists(beyond) ? beyond : 0));
}

// Gives keys to the edges around the merged vertex. Keys never decrease: an edge keeps at least the smaller key of the
// edges that it replaces, and comes after the collapse that made it.
template <class Arithmetic>
ISOWEAVE_HD void BasicDecider<Arithmetic>::update_keys(CostBits collapse_cost) {
  const Star& star = merged_;
  const Vertex& merged = zone_.vertices[star.vertex];
  EdgeEnds ends[Star::kRoom];
  CostBits costs[Star::kRoom];
  std::size_t count = 0;
  for (std::size_t n = 0; n < star.count(); ++n) {
    const Index h = n == static_cast<std::size_t>(star.faces) ? previous(star.out[n - 1]) : star.out[n];
    const Key before = zone_.key(h);
    const Vertex* const both[2] = {&merged, &zone_.vertices[star.neighbour[n]]};
    const std::size_t first = both[1]->id < merged.id;
    prefetch_beyond(n);
    changed_[count] = h;
    changed_end_[count] = star.neighbour[n];
    before_[count] = before;
    ends[count] = {both[first], both[1 - first]};
    count += cost_of(before) <= zone_.options.retire;
  }
  changed_count_ = static_cast<int>(count);
  edge_costs(zone_, arithmetic_, {ends, count}, costs);
  const float merged_factor = key_factors(zone_.options.quality).merged;
  for (std::size_t n = 0; n < count; ++n) {
    CostBits cost = cost_of(before_[n]);
    if (cost < collapse_cost + 1) cost = collapse_cost + 1;
    const CostBits own = scaled(costs[n], merged_factor);
    if (cost < own) cost = own;
    zone_.set_cost(changed_[n], cost);
  }
}

using Decider = BasicDecider<VectorArithmetic>;
extern template class BasicDecider<VectorArithmetic>;

}  // namespace isoweave
