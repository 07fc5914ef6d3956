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
  faces = 0;
  overflow = false;
  const Index first = zone.vertices[v].half_edge;
  Index h = first;
  do {
    if (faces == kCapacity) {
      overflow = true;
      neighbours = faces;
      return;
    }
    const auto n = static_cast<std::size_t>(faces++);
    out[n] = h;
    neighbour[n] = zone.destination(h);
    h = zone.rotate(h);
  } while (h != first && exists(h));
  border = h != first;
  neighbours = faces + (border ? 1 : 0);
  if (border)
    neighbour[static_cast<std::size_t>(faces)] = zone.origin(previous(out[static_cast<std::size_t>(faces - 1)]));
}

void Decider::look_at(Index half_edge) {
  edge_ = half_edge;
  Index a = zone_.origin(half_edge);
  Index b = zone_.destination(half_edge);
  if (zone_.vertices[b].id < zone_.vertices[a].id) std::swap(a, b);
  u_.gather(zone_, a);
  v_.gather(zone_, b);
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
  const Vec3 origin = midpoint(u.position, v.position);
  const Quadric sum = moved(u.quadric, origin - u.position) + moved(v.quadric, origin - v.position);
  Quadric full = sum;
  Vec3 best;
  CostBits limit = key;
  if (quality_ == Quality::kFast) {
    best = solve(factorise(sum), -sum.b);
  } else {
    Vec3 gradient;
    double offset = 0;
    full = sum + current_faces(origin, gradient, offset);
    const Factors factors = factorise(full);
    best = solve(factors, -full.b);
    const Vec3 response = solve(factors, gradient);
    const double strength = dot(gradient, response);
    if (strength > 0) best = best + ((offset - dot(gradient, best)) / strength) * response;
    limit = cost_bits(refinement_limit(quality_) * cost_value(key));
    const CostBits cost = to_cost(evaluate(full, best));
    if (cost > limit) {
      ++counts_.rekeyed;
      raise_key(cost);
      return;
    }
  }
  Vec3 x;
  if (!place(origin, full, best, limit, x)) {
    ++counts_.postponed;
    raise_key(postponed_cost(key));
    return;
  }
  ++counts_.collapses;
  collapsed_ = true;
  collapse(origin + x, moved(sum, x));
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

bool Decider::star_keeps_sides(const Star& star, const Star& other, Vec3 x) const {
  const Vec3 from = zone_.vertices[star.vertex].position;
  for (int n = 0; n < star.faces; ++n) {
    const Index b = star.neighbour[static_cast<std::size_t>(n)];
    const Index c = star.neighbour[static_cast<std::size_t>((n + 1) % star.neighbours)];
    if (b == other.vertex || c == other.vertex) continue;
    if (!keeps_side(from, x, zone_.vertices[b].position, zone_.vertices[c].position)) return false;
  }
  return true;
}

bool Decider::keeps_sides(Vec3 x) const { return star_keeps_sides(u_, v_, x) && star_keeps_sides(v_, u_, x); }

// Adds the faces of a star from the neighbour with the smallest id on, leaving out those that hold skip's vertex.
void Decider::add_current_faces(const Star& star, const Star* skip, Vec3 origin, Quadric& q, Vec3& gradient,
                                double& offset) const {
  int start = 0;
  if (!star.border) {
    for (int n = 1; n < star.faces; ++n) {
      if (zone_.vertices[star.neighbour[static_cast<std::size_t>(n)]].id <
          zone_.vertices[star.neighbour[static_cast<std::size_t>(start)]].id) {
        start = n;
      }
    }
  }
  const double a0 = zone_.options().a0;
  const Vec3 p = zone_.vertices[star.vertex].position - origin;
  for (int n = 0; n < star.faces; ++n) {
    const int face = (start + n) % star.faces;
    const Index b = star.neighbour[static_cast<std::size_t>(face)];
    const Index c = star.neighbour[static_cast<std::size_t>((face + 1) % star.neighbours)];
    if (skip != nullptr && (b == skip->vertex || c == skip->vertex)) continue;
    const Vec3 normal = cross(zone_.vertices[b].position - origin - p, zone_.vertices[c].position - origin - p);
    const double size = std::sqrt(dot(normal, normal));  // twice the area
    if (!(size > 0)) continue;
    add_plane(q, normal, p, size / (2 * a0 * a0));
    gradient = gradient + normal;
    offset += dot(normal, p);
  }
}

// Planes of the faces around both ends as they are now, weighted by area, and the plane of points x (gradient . x =
// offset) that keep the enclosed volume when the edge shrinks to x (Lindstrom and Turk, 1998).
Quadric Decider::current_faces(Vec3 origin, Vec3& gradient, double& offset) const {
  Quadric q;
  add_current_faces(u_, nullptr, origin, q, gradient, offset);
  add_current_faces(v_, &u_, origin, q, gradient, offset);
  return q;
}

// The first position that keeps every face on its side: the best one, then the two ends and the midpoint, cheapest
// first, as long as they cost no more than the limit.
bool Decider::place(Vec3 origin, const Quadric& q, Vec3 best, CostBits limit, Vec3& x) const {
  x = best;
  if (keeps_sides(origin + x)) return true;
  struct Candidate {
    CostBits cost;
    int rank;
    Vec3 at;
  };
  std::array<Candidate, 3> candidates{{{0, 0, zone_.vertices[u_.vertex].position - origin},
                                       {0, 1, zone_.vertices[v_.vertex].position - origin},
                                       {0, 2, Vec3{}}}};
  for (Candidate& candidate : candidates) candidate.cost = to_cost(evaluate(q, candidate.at));
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.rank < b.rank;
  });
  for (const Candidate& candidate : candidates) {
    if (candidate.cost > limit) return false;
    x = candidate.at;
    if (keeps_sides(origin + x)) return true;
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

// Merges the two ends into the vertex of u_ at `position`.
void Decider::collapse(Vec3 position, const Quadric& quadric) {
  const Index back = zone_.twin(edge_);
  for (int n = 0; n < v_.faces; ++n) {
    const Index h = v_.out[static_cast<std::size_t>(n)];
    zone_.triangles[h >> 2].vertex[h & 3] = u_.vertex;
  }
  merge_sides(edge_);
  if (exists(back)) merge_sides(back);

  Vertex& merged = zone_.vertices[u_.vertex];
  Vertex& gone = zone_.vertices[v_.vertex];
  merged.position = position;
  merged.quadric = quadric;
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
