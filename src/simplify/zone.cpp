#include "simplify/zone.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kBlock = 2048;

// Grows by a quarter where std::vector would double: the zone is what bounds the memory of a run.
template <class T>
void grow(std::vector<T>& vector, std::size_t size, const T& value = T()) {
  if (size > vector.capacity()) vector.reserve(std::max(size, vector.capacity() + vector.capacity() / 4));
  vector.resize(size, value);
}

}  // namespace

CostBits edge_cost(const Vertex& u, const Vertex& v) {
  const Vec3 middle = midpoint(u.position, v.position);
  const Quadric q = moved(u.quadric, middle - u.position) + moved(v.quadric, middle - v.position);
  const Vec3 x = solve(factorise(q), -q.b);
  return to_cost(evaluate(q, x));
}

void Zone::append(const SurfacePiece& piece, const Executor& executor) {
  const std::uint64_t triangle_total = triangles.size() + piece.triangles.size();
  if (triangle_total >= kWritten / 4) {
    throw OverMemory("the undecided zone would hold " + std::to_string(triangle_total) +
                     " triangles, expected fewer than 2^30: choose thinner slabs or a smaller error");
  }
  const auto first_vertex = static_cast<Index>(vertices.size());
  const Index first_triangle = triangle_count();
  grow(vertices, vertices.size() + piece.positions.size());
  grow(states, vertices.size(), VertexState::kIncomplete);
  grow(turns, vertices.size());
  grow(triangles, triangle_total);
  normals.insert(normals.end(), piece.normals.begin(), piece.normals.end());
  executor.for_each(static_cast<std::int64_t>(piece.positions.size()), kBlock, [&](std::int64_t n) {
    Vertex& vertex = vertices[first_vertex + static_cast<Index>(n)];
    vertex.position = piece.positions[static_cast<std::size_t>(n)];
    vertex.id = piece.ids[static_cast<std::size_t>(n)];
  });
  executor.for_each(static_cast<std::int64_t>(piece.triangles.size()), kBlock, [&](std::int64_t t) {
    Triangle& triangle = triangles[first_triangle + static_cast<Index>(t)];
    for (Index c = 0; c < 3; ++c) {
      triangle.vertex[c] = piece_vertex(piece, first_vertex, piece.triangles[static_cast<std::size_t>(t)][c]);
    }
  });
  for (const Index n : piece.locked) states[piece_vertex(piece, first_vertex, n)] = VertexState::kLocked;
  link(piece, first_triangle, executor);
  settle_front(piece, first_vertex, executor);
  key_edges(first_triangle, executor);
}

// Finds twins among the new half-edges and the open ones: lists the half-edges that start at each vertex and
// looks for (b, a) in the list of b.
void Zone::link(const SurfacePiece& piece, Index first_triangle, const Executor& executor) {
  std::vector<Index> candidates = std::move(open_half_edges_);
  const std::size_t open = candidates.size();
  candidates.reserve(open + 3 * std::size_t{triangle_count() - first_triangle});
  for (Index t = first_triangle; t < triangle_count(); ++t) {
    for (Index c = 0; c < 3; ++c) candidates.push_back(half_edge(t, c));
  }

  // Only front and new vertices have candidates: number them densely, the front first.
  const auto new_vertices = static_cast<Index>(piece.positions.size());
  const Index first_new = static_cast<Index>(vertices.size()) - new_vertices;
  std::vector<std::pair<Index, Index>> old_vertices;  // (vertex, dense number), sorted
  for (std::size_t n = 0; n < open; ++n) old_vertices.emplace_back(origin(candidates[n]), 0);
  for (const Index v : front_) old_vertices.emplace_back(v, 0);
  std::sort(old_vertices.begin(), old_vertices.end());
  old_vertices.erase(std::unique(old_vertices.begin(), old_vertices.end()), old_vertices.end());
  for (std::size_t n = 0; n < old_vertices.size(); ++n) old_vertices[n].second = static_cast<Index>(n);
  const auto old_count = static_cast<Index>(old_vertices.size());
  const auto dense = [&](Index v) {
    if (v >= first_new) return old_count + (v - first_new);
    return std::lower_bound(old_vertices.begin(), old_vertices.end(), std::pair<Index, Index>(v, 0))->second;
  };

  const auto count = static_cast<std::int64_t>(candidates.size());
  std::vector<Index> start(old_count + std::size_t{new_vertices} + 1, 0);
  executor.for_each(count, kBlock, [&](std::int64_t n) {
    const Index slot = dense(origin(candidates[static_cast<std::size_t>(n)])) + 1;
    std::atomic_ref(start[slot]).fetch_add(1, std::memory_order_relaxed);
  });
  for (std::size_t n = 1; n < start.size(); ++n) start[n] += start[n - 1];
  std::vector<Index> fill(start.begin(), start.end() - 1);
  std::vector<Index> outgoing(candidates.size());
  executor.for_each(count, kBlock, [&](std::int64_t n) {
    const Index h = candidates[static_cast<std::size_t>(n)];
    outgoing[std::atomic_ref(fill[dense(origin(h))]).fetch_add(1, std::memory_order_relaxed)] = h;
  });

  // Each pair is written once, from its half-edge that starts at the smaller vertex. Edges between locked vertices may
  // have any number of triangles and stay unlinked: nobody walks around their ends.
  executor.for_each(count, kBlock, [&](std::int64_t n) {
    const Index h = candidates[static_cast<std::size_t>(n)];
    const Index a = origin(h);
    const Index b = destination(h);
    if (a > b || (states[a] == VertexState::kLocked && states[b] == VertexState::kLocked)) return;
    const bool listed =
        b >= first_new || std::binary_search(old_vertices.begin(), old_vertices.end(), std::pair<Index, Index>(b, 0),
                                             [](const auto& p, const auto& q) { return p.first < q.first; });
    if (!listed) return;
    const Index bucket = dense(b);
    for (Index m = start[bucket]; m < start[bucket + 1]; ++m) {
      const Index back = outgoing[m];
      if (destination(back) != a) continue;
      set_twin(h, back);
      set_twin(back, h);
      return;
    }
  });

  // A vertex starts its walks at the border if it has one, else at its first half-edge.
  executor.for_each(static_cast<std::int64_t>(old_count) + new_vertices, kBlock, [&](std::int64_t n) {
    const auto slot = static_cast<Index>(n);
    const Index v = slot < old_count ? old_vertices[slot].first : first_new + (slot - old_count);
    Index& first = vertices[v].half_edge;
    for (Index m = start[slot]; m < start[slot + 1]; ++m) first = std::min(first, outgoing[m]);
    for (Index m = start[slot]; m < start[slot + 1]; ++m) {
      if (twin(outgoing[m]) == kNone) first = outgoing[m];
    }
  });
  open_half_edges_ = std::move(candidates);
}

// Vertices that the piece does not name as incomplete are complete now and get their quadrics.
void Zone::settle_front(const SurfacePiece& piece, Index first_vertex, const Executor& executor) {
  settled = front_;
  std::vector<Index> front(piece.incomplete.size());
  for (std::size_t n = 0; n < front.size(); ++n) front[n] = piece_vertex(piece, first_vertex, piece.incomplete[n]);
  for (Index v = first_vertex; v < vertices.size(); ++v) settled.push_back(v);
  for (const Index v : settled) {
    if (states[v] != VertexState::kLocked) states[v] = VertexState::kComplete;
  }
  for (const Index v : front) states[v] = VertexState::kIncomplete;
  executor.for_each(static_cast<std::int64_t>(settled.size()), kBlock, [&](std::int64_t n) {
    const Index v = settled[static_cast<std::size_t>(n)];
    if (states[v] == VertexState::kComplete && exists(vertices[v].half_edge)) initial_quadric(v);
  });
  front_ = std::move(front);
  std::erase_if(open_half_edges_, [&](Index h) {
    const bool incomplete =
        states[origin(h)] == VertexState::kIncomplete || states[destination(h)] == VertexState::kIncomplete;
    return twin(h) != kNone || !incomplete;
  });
}

// Planes of the faces around v in the order of the faces, weighted by area / 3; then, on an open border, planes
// through the two border edges perpendicular to their faces, weighted by squared length.
void Zone::initial_quadric(Index v) {
  std::vector<Index> faces;
  const Index first = vertices[v].half_edge;
  Index last = first;
  for (Index h = first; exists(h); h = rotate(h)) {
    faces.push_back(h);
    last = h;
    if (rotate(h) == first) break;
  }
  std::sort(faces.begin(), faces.end());
  const Vec3 p = vertices[v].position;
  const auto face_normal = [&](Index h) {
    return cross(vertices[destination(h)].position - p, vertices[origin(previous(h))].position - p);
  };
  const double a0 = options_.a0;
  Quadric q;
  for (const Index h : faces) {
    const Vec3 normal = face_normal(h);
    const double size = std::sqrt(dot(normal, normal));  // twice the area
    if (size > 0) add_plane(q, normal, {}, size / (6 * a0 * a0));
  }
  const auto add_border = [&](Vec3 edge, Vec3 normal) {
    const Vec3 side = cross(edge, normal);
    if (dot(side, side) > 0) add_plane(q, side, {}, dot(edge, edge) / (a0 * a0));
  };
  if (twin(first) == kNone) {
    add_border(vertices[destination(first)].position - p, face_normal(first));
    add_border(p - vertices[origin(previous(last))].position, face_normal(last));
  }
  vertices[v].quadric = q;
}

// Keys of the edges whose two ends are complete now.
void Zone::key_edges(Index first_triangle, const Executor& executor) {
  std::vector<Index> edges = std::move(unkeyed_edges_);
  for (const Index h : edges) {
    for (const Index v : {origin(h), destination(h)}) settled.push_back(v);
  }
  std::sort(settled.begin(), settled.end());
  settled.erase(std::unique(settled.begin(), settled.end()), settled.end());
  for (Index t = first_triangle; t < triangle_count(); ++t) {
    for (Index c = 0; c < 3; ++c) {
      if (represents_edge(half_edge(t, c))) edges.push_back(half_edge(t, c));
    }
  }
  executor.for_each(static_cast<std::int64_t>(edges.size()), kBlock, [&](std::int64_t n) {
    const Index h = edges[static_cast<std::size_t>(n)];
    const Vertex& u = vertices[origin(h)];
    const Vertex& v = vertices[destination(h)];
    const VertexState u_state = states[origin(h)];
    const VertexState v_state = states[destination(h)];
    if (u_state == VertexState::kIncomplete || v_state == VertexState::kIncomplete) return;
    const bool locked = u_state == VertexState::kLocked || v_state == VertexState::kLocked;
    set_cost(h, locked ? kRetiredCost : edge_cost(u, v));
    const std::uint64_t mixed = mix_bits(options_.numbering.edge_id(u.id, v.id));
    for (const Index side : {h, twin(h)}) {
      if (exists(side)) triangles[side >> 2].tie[side & 3] = mixed;
    }
  });
  std::erase_if(edges, [&](Index h) { return cost(h) != kUnknownCost || !represents_edge(h); });
  unkeyed_edges_ = std::move(edges);
}

void Zone::remove_triangle(Index t) { triangles[t].vertex = {kNone, kNone, kNone}; }

void Zone::compact() {
  Index dead = 0;
  for (const Triangle& triangle : triangles) dead += triangle.vertex[0] == kNone;
  dead_triangles_ = dead;
  if (8 * std::uint64_t{dead} < triangles.size()) return;

  // A vertex is held as long as a triangle uses it, or will.
  std::vector<Index> new_vertex(vertices.size(), kNone);
  std::vector<Index> new_triangle(triangles.size(), kNone);
  Index kept = 0;
  for (Index t = 0; t < triangle_count(); ++t) {
    if (!alive(half_edge(t, 0))) continue;
    new_triangle[t] = kept++;
    for (const Index v : triangles[t].vertex) new_vertex[v] = 0;
  }
  for (const Index v : front_) new_vertex[v] = 0;
  const auto moved_half_edge = [&](Index h) {
    if (!exists(h)) return h;
    return new_triangle[h >> 2] == kNone ? kNone : half_edge(new_triangle[h >> 2], h & 3);
  };

  Index count = 0;
  for (Index v = 0; v < vertices.size(); ++v) {
    if (new_vertex[v] == kNone) continue;
    vertices[count] = vertices[v];
    vertices[count].half_edge = moved_half_edge(vertices[v].half_edge);
    states[count] = states[v];
    turns[count] = turns[v];
    if (!normals.empty()) normals[count] = normals[v];
    new_vertex[v] = count++;
  }
  vertices.resize(count);
  states.resize(count);
  turns.resize(count);
  if (!normals.empty()) normals.resize(count);
  for (Turn& turn : turns) {
    turn.edge = moved_half_edge(turn.edge);
    for (Index* v : {&turn.first_waiter, &turn.next_waiter, &turn.waits_for}) {
      if (*v != kNone) *v = new_vertex[*v];
    }
  }

  for (Index t = 0; t < new_triangle.size(); ++t) {
    if (new_triangle[t] == kNone) continue;
    Triangle moved = triangles[t];
    for (Index c = 0; c < 3; ++c) {
      moved.vertex[c] = new_vertex[moved.vertex[c]];
      moved.twin[c] = moved_half_edge(moved.twin[c]);
    }
    triangles[new_triangle[t]] = moved;
  }
  triangles.resize(kept);
  for (Index& v : front_) v = new_vertex[v];
  for (Index& h : open_half_edges_) h = moved_half_edge(h);
  for (Index& h : unkeyed_edges_) h = moved_half_edge(h);
  settled.clear();
  dead_triangles_ = 0;
}

std::uint64_t Zone::bytes() const {
  return vertices.capacity() * (sizeof(Vertex) + sizeof(VertexState)) + turns.capacity() * sizeof(Turn) +
         normals.capacity() * sizeof(Point) + triangles.capacity() * sizeof(Triangle) +
         (front_.capacity() + open_half_edges_.capacity() + unkeyed_edges_.capacity() + settled.capacity()) *
             sizeof(Index);
}

}  // namespace isoweave
