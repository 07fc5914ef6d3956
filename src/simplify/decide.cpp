#include "simplify/decide.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace isoweave {
namespace {

// An edge goes back when its full cost exceeds its key by this factor.
constexpr float refinement_limit(Quality quality) { return quality == Quality::kFine ? 1.0F : 4.0F; }

// Faces that hold both ends of the edge: they go when it collapses.
void drop_shared_faces(const Star& star, Index other, Fan& fan) {
  const std::size_t place = star.place_of(other);
  fan.drop(place);
  fan.drop(place > 0 ? place - 1 : star.count() - 1);
}

}  // namespace

void Decider::decide() {
  changed_count_ = 0;
  collapsed_ = false;
  const CostBits key = zone_.cost(edge_);
  if (u_.overflow || v_.overflow || !topology_allows()) {
    ++counts_.postponed;
    raise_key(postponed_cost(key));
    return;
  }
  const Vertex& u = zone_.vertices[u_.vertex];
  const Vertex& v = zone_.vertices[v_.vertex];
  edge_vector_ = v.position - u.position;
  measure(zone_, u_, u_fan_);
  measure(zone_, v_, v_fan_);
  drop_shared_faces(v_, u_.vertex, v_fan_);
  Quadric full;
  Vec3 best;
  CostBits limit = key;
  if (quality_ == Quality::kFast) {
    full = u.quadric + moved(v.quadric, -edge_vector_);
    best = minimiser(full, factorise(full), 0.5 * edge_vector_);
  } else {
    const double a0 = zone_.options().a0;
    const double weight = 1 / (2 * a0 * a0);
    const FaceSums u_sums = kernels_.sum_faces(u_fan_, u_.count(), weight);
    const FaceSums v_sums = kernels_.sum_faces(v_fan_, v_.count(), weight);
    full = u.quadric + u_sums.planes + moved(v.quadric + v_sums.planes, -edge_vector_);
    best = best_place(full, u_sums.normal + v_sums.normal, dot(v_sums.normal, edge_vector_));
    limit = cost_bits(refinement_limit(quality_) * cost_value(key));
    const CostBits cost = to_cost(evaluate(full, best));
    if (cost > limit) {
      ++counts_.rekeyed;
      raise_key(cost);
      return;
    }
  }
  drop_shared_faces(u_, v_.vertex, u_fan_);
  Vec3 x;
  if (!place(full, best, limit, x)) {
    ++counts_.postponed;
    raise_key(postponed_cost(key));
    return;
  }
  ++counts_.collapses;
  collapsed_ = true;
  collapse(x);
  update_keys(key);
}

// Link condition (Dey, Edelsbrunner, Guha and Nekhayev, 1999), border and valence rules.
bool Decider::topology_allows() {
  const bool border_edge = !exists(zone_.twin(edge_));
  if (u_.border && v_.border && !border_edge) return false;
  const int opposite = border_edge ? 1 : 2;
  if (u_.neighbours + v_.neighbours - 2 - opposite > kMaxValence) return false;
  v_.pad(kNone);
  const std::span of_u(u_.neighbour.data(), u_.count());
  if (kernels_.count_common(of_u, v_.neighbour.data(), v_.count()) != opposite) return false;
  // What is left to exclude: both ends only see each other and the opposite vertices. Then the surface is a tetrahedron
  // (both stars hold the face over the opposite vertices), or, on a border, a single triangle.
  return !(u_.neighbours == opposite + 1 && v_.neighbours == opposite + 1 && u_.border == v_.border);
}

// Of the faces that are left.
bool Decider::keeps_sides(Vec3 x) const {
  return kernels_.keeps_sides(u_fan_, u_.count(), x) && kernels_.keeps_sides(v_fan_, v_.count(), x - edge_vector_);
}

// Where the full cost is least among the points x (gradient . x = offset) that keep the enclosed volume when the edge
// shrinks to x (Lindstrom and Turk, 1998).
Vec3 Decider::best_place(const Quadric& full, Vec3 gradient, double offset) const {
  const Factors<double> factors = factorise(full);
  const Vec3 best = minimiser(full, factors, 0.5 * edge_vector_);
  const Vec3 response = solve(factors, gradient);
  const double strength = dot(gradient, response);
  return strength > 0 ? best + ((offset - dot(gradient, best)) / strength) * response : best;
}

// The first position that keeps every face on its side: the best one, then the two ends and the midpoint, cheapest
// first, as long as they cost no more than the limit.
bool Decider::place(const Quadric& q, Vec3 best, CostBits limit, Vec3& x) const {
  x = best;
  if (keeps_sides(x)) return true;
  struct Candidate {
    CostBits cost;
    int rank;
    Vec3 at;
  };
  std::array<Candidate, 3> candidates{{{0, 0, Vec3{}}, {0, 1, edge_vector_}, {0, 2, 0.5 * edge_vector_}}};
  for (Candidate& candidate : candidates) candidate.cost = to_cost(evaluate(q, candidate.at));
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.rank < b.rank;
  });
  for (const Candidate& candidate : candidates) {
    if (candidate.cost > limit) return false;
    x = candidate.at;
    if (keeps_sides(x)) return true;
  }
  return false;
}

void Decider::raise_key(CostBits cost) {
  zone_.set_cost(edge_, cost);
  changed_[static_cast<std::size_t>(changed_count_++)] = edge_;
}

// Takes out the triangle of half-edge h, one of the two at the edge: its two other edges become one, which keeps
// the identity of the one with the smaller key.
void Decider::merge_sides(Index h) {
  const Index a = next(h);
  const Index b = previous(h);
  const Index outer_a = zone_.twin(a);
  const Index outer_b = zone_.twin(b);
  const Index least = zone_.comes_before(a, b) ? a : b;
  const Key key = zone_.key(least);
  const std::uint32_t tie_low = zone_.tie_low(least);
  for (const Index outer : {outer_a, outer_b}) {
    if (!exists(outer)) continue;
    zone_.half(outer).twin = outer == outer_a ? outer_b : outer_a;
    zone_.half(outer).key = key;
    zone_.triangles[outer >> 2].tie_low[outer & 3] = tie_low;
  }
  // The opposite vertex may have started its walks here. Another collapse may look at the same vertex from its side.
  const std::atomic_ref<Index> start(zone_.vertices[zone_.origin(b)].half_edge);
  if (start.load(std::memory_order_relaxed) == b) start.store(outer_a, std::memory_order_relaxed);
  zone_.remove_triangle(h >> 2);
  ++counts_.removed;
}

// Merges the two ends into the vertex of u_, x away from where that was.
void Decider::collapse(Vec3 x) {
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
  if (!zone_.normals.empty()) {
    Point& normal = zone_.normals[u_.vertex];
    for (std::size_t c = 0; c < 3; ++c) normal[c] += zone_.normals[v_.vertex][c];
  }
  join_rings();
}

// The star of the merged vertex: around u_ from the first opposite vertex to the second, and around v_ back to the
// first.
void Decider::join_rings() {
  Index& start = zone_.vertices[u_.vertex].half_edge;
  if (u_.border || v_.border) {
    start = kNone;
    for (const Star* star : {&u_, &v_}) {
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

// Keys of the edges around the merged vertex. Keys never decrease: an edge keeps at least the smaller key it
// replaces, and lies behind the collapse that made it.
void Decider::update_keys(CostBits collapse_cost) {
  const Star& star = merged_;
  const Vertex& merged = zone_.vertices[star.vertex];
  std::array<EdgeEnds, Star::kRoom> ends;
  std::array<CostBits, Star::kRoom> costs;
  std::size_t count = 0;
  for (std::size_t n = 0; n < star.count(); ++n) {
    const Index h = n == static_cast<std::size_t>(star.faces) ? previous(star.out[n - 1]) : star.out[n];
    const Key before = zone_.key(h);
    const std::array<const Vertex*, 2> both{&merged, &zone_.vertices[star.neighbour[n]]};
    const std::size_t first = both[1]->id < merged.id;
    changed_[count] = h;
    before_[count] = before;
    ends[count] = {both[first], both[1 - first]};
    count += cost_of(before) <= zone_.options().retire;
  }
  changed_count_ = static_cast<int>(count);
  kernels_.edge_costs(std::span(ends).first(count), costs.data());
  for (std::size_t n = 0; n < count; ++n) {
    const Index h = changed_[n];
    zone_.set_cost(h, std::max({costs[n], collapse_cost + 1, cost_of(before_[n])}));
  }
}

}  // namespace isoweave
