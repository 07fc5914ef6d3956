#include "simplify/decide.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

namespace isoweave {
namespace {

// An edge goes back when its full cost exceeds its key by this factor.
constexpr float refinement_limit(Quality quality) { return quality == Quality::kFine ? 1.0F : 4.0F; }

}  // namespace

void Star::gather(const Zone& zone, Index v) {
  vertex = v;
  overflow = false;
  const Index first = zone.vertices[v].half_edge;
  Index h = first;
  std::size_t n = 0;
  do {
    if (n == kCapacity) {
      faces = neighbours = kCapacity;
      overflow = true;
      return;
    }
    const Triangle& triangle = zone.triangles[h >> 2];
    out[n] = h;
    neighbour[n++] = triangle.vertex[next(h) & 3];
    h = triangle.twin[previous(h) & 3];
  } while (h != first && exists(h));
  faces = static_cast<int>(n);
  border = h != first;
  neighbours = faces + (border ? 1 : 0);
  if (border) neighbour[n] = zone.origin(previous(out[n - 1]));
}

void Fan::measure(const Zone& zone, const Star& star) {
  const Vec3 from = zone.vertices[star.vertex].position;
  const auto neighbours = static_cast<std::size_t>(star.neighbours);
  for (std::size_t n = 0; n < neighbours; ++n) to[n] = zone.vertices[star.neighbour[n]].position - from;
  for (std::size_t n = 0; n + 1 < neighbours; ++n) normals[n] = cross(to[n], to[n + 1]);
  if (!star.border) normals[neighbours - 1] = cross(to[neighbours - 1], to[0]);
}

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
  u_fan_.measure(zone_, u_);
  v_fan_.measure(zone_, v_);
  Quadric full;
  Vec3 best;
  CostBits limit = key;
  if (quality_ == Quality::kFast) {
    full = u.quadric + moved(v.quadric, -edge_vector_);
    best = minimiser(full, factorise(full), 0.5 * edge_vector_);
  } else {
    Vec3 u_normals;
    Vec3 v_normals;
    full = u.quadric + current_faces(u_, u_fan_, nullptr, u_normals) +
           moved(v.quadric + current_faces(v_, v_fan_, &u_, v_normals), -edge_vector_);
    best = best_place(full, u_normals + v_normals, dot(v_normals, edge_vector_));
    limit = cost_bits(refinement_limit(quality_) * cost_value(key));
    const CostBits cost = to_cost(evaluate(full, best));
    if (cost > limit) {
      ++counts_.rekeyed;
      raise_key(cost);
      return;
    }
  }
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
bool Decider::topology_allows() const {
  const bool border_edge = !exists(zone_.twin(edge_));
  if (u_.border && v_.border && !border_edge) return false;
  const int opposite = border_edge ? 1 : 2;
  if (u_.neighbours + v_.neighbours - 2 - opposite > kMaxValence) return false;
  int common = 0;
  for (int i = 0; i < u_.neighbours; ++i) {
    const Index w = u_.neighbour[static_cast<std::size_t>(i)];
    for (int j = 0; j < v_.neighbours; ++j) common += w == v_.neighbour[static_cast<std::size_t>(j)];
  }
  if (common != opposite) return false;
  // What is left to exclude: both ends only see each other and the opposite vertices. Then the surface is a tetrahedron
  // (both stars hold the face over the opposite vertices), or, on a border, a single triangle.
  return !(u_.neighbours == opposite + 1 && v_.neighbours == opposite + 1 && u_.border == v_.border);
}

bool Decider::keeps_sides(Vec3 x) const {
  const auto star_keeps = [](const Star& star, const Fan& fan, Index other, Vec3 move) {
    const auto faces = static_cast<std::size_t>(star.faces);
    const auto neighbours = static_cast<std::size_t>(star.neighbours);
    for (std::size_t n = 0; n < faces; ++n) {
      const std::size_t following = n + 1 < neighbours ? n + 1 : 0;
      if (star.neighbour[n] == other || star.neighbour[following] == other) continue;
      if (!keeps_side(fan.normals[n], cross(fan.to[n] - move, fan.to[following] - move))) return false;
    }
    return true;
  };
  return star_keeps(u_, u_fan_, v_.vertex, x) && star_keeps(v_, v_fan_, u_.vertex, x - edge_vector_);
}

// Planes of the faces of a star as they are now, weighted by area, measured from its vertex, and the sum of their
// normals. Leaves out the faces that hold skip's vertex. Goes around from the neighbour with the smallest id.
Quadric Decider::current_faces(const Star& star, const Fan& fan, const Star* skip, Vec3& normal_sum) const {
  const auto faces = static_cast<std::size_t>(star.faces);
  const auto neighbours = static_cast<std::size_t>(star.neighbours);
  std::size_t start = 0;
  if (!star.border) {
    for (std::size_t n = 1; n < faces; ++n) {
      if (zone_.vertices[star.neighbour[n]].id < zone_.vertices[star.neighbour[start]].id) start = n;
    }
  }
  const double a0 = zone_.options().a0;
  const double weight = 1 / (2 * a0 * a0);
  Quadric q;
  std::size_t face = start;
  for (std::size_t n = 0; n < faces; ++n, face = face + 1 < faces ? face + 1 : 0) {
    const std::size_t following = face + 1 < neighbours ? face + 1 : 0;
    if (skip != nullptr && (star.neighbour[face] == skip->vertex || star.neighbour[following] == skip->vertex))
      continue;
    const Vec3 normal = fan.normals[face];
    const double size = std::sqrt(dot(normal, normal));  // twice the area
    if (!(size > 0)) continue;
    add_plane(q, normal, weight / size);
    normal_sum = normal_sum + normal;
  }
  return q;
}

// Where the full cost is least among the points x (gradient . x = offset) that keep the enclosed volume when the edge
// shrinks to x (Lindstrom and Turk, 1998).
Vec3 Decider::best_place(const Quadric& full, Vec3 gradient, double offset) const {
  const Factors factors = factorise(full);
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
  const CostBits cost_a = zone_.cost(a);
  const CostBits cost_b = zone_.cost(b);
  const bool a_first = cost_a != cost_b ? cost_a < cost_b : zone_.tie(a) < zone_.tie(b);
  const CostBits cost = a_first ? cost_a : cost_b;
  const std::uint64_t tie = zone_.tie(a_first ? a : b);
  for (const Index outer : {outer_a, outer_b}) {
    if (!exists(outer)) continue;
    Triangle& triangle = zone_.triangles[outer >> 2];
    triangle.twin[outer & 3] = outer == outer_a ? outer_b : outer_a;
    triangle.cost[outer & 3] = cost;
    triangle.tie[outer & 3] = tie;
  }
  // The opposite vertex may have started its walks here. Another collapse may look at the same vertex from its side.
  const std::atomic_ref<Index> start(zone_.vertices[zone_.origin(b)].half_edge);
  if (start.load(std::memory_order_relaxed) == b) start.store(outer_a, std::memory_order_relaxed);
  zone_.remove_triangle(h >> 2);
}

// Merges the two ends into the vertex of u_, x away from where that was.
void Decider::collapse(Vec3 x) {
  const Index back = zone_.twin(edge_);
  for (int n = 0; n < v_.faces; ++n) {
    const Index h = v_.out[static_cast<std::size_t>(n)];
    zone_.triangles[h >> 2].vertex[h & 3] = u_.vertex;
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
  merged.half_edge = kNone;
  for (const Star* star : {&u_, &v_}) {
    for (int n = 0; n < star->faces; ++n) {
      const Index h = star->out[static_cast<std::size_t>(n)];
      if (!zone_.alive(h)) continue;
      if (merged.half_edge == kNone || !exists(zone_.twin(h))) merged.half_edge = h;
    }
  }
}

// Keys of the edges around the merged vertex. Keys never decrease: an edge keeps at least the smaller key it
// replaces, and lies behind the collapse that made it.
void Decider::update_keys(CostBits collapse_cost) {
  const Index merged = u_.vertex;
  u_.gather(zone_, merged);
  for (int n = 0; n < u_.neighbours; ++n) {
    const bool last_on_border = n == u_.faces;
    const Index h =
        last_on_border ? previous(u_.out[static_cast<std::size_t>(n - 1)]) : u_.out[static_cast<std::size_t>(n)];
    const CostBits before = zone_.cost(h);
    if (before > zone_.options().retire) continue;
    const CostBits own = edge_cost(zone_.vertices[merged], zone_.vertices[u_.neighbour[static_cast<std::size_t>(n)]]);
    zone_.set_cost(h, std::max({own, collapse_cost + 1, before}));
    changed_[static_cast<std::size_t>(changed_count_++)] = h;
  }
}

}  // namespace isoweave
