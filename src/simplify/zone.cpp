#include "simplify/zone.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "isoweave/error.hpp"
#include "parallel/collect.hpp"
#include "parallel/compact.hpp"
#include "parallel/prefetch.hpp"
#include "parallel/touch.hpp"
#include "simplify/kernels.hpp"
#include "simplify/star.hpp"
#include "simplify/zone_rules.hpp"

namespace isoweave {
namespace {

constexpr std::int64_t kZoneBlock = 2048;
constexpr Index kAhead = 12;  // triangles whose corners are fetched before their edges get keys

}  // namespace

Zone::Zone(const ZoneOptions& zone_options, std::size_t finer_levels) : levels(finer_levels) {
  options = zone_options;
  limit = zone_options.retire;
  if (options.most_distance > 0) {
    extracted_surface_ = std::make_unique<ExtractedSurface>(options.most_distance, options.cell, options.largest);
    extracted = extracted_surface_.get();
  }
}

void Zone::append(const SurfacePiece& piece, const Executor& executor) {
  const std::uint64_t triangle_total = triangles.size() + piece.triangles.size();
  if (triangle_total >= kWritten / 4) {
    throw OverMemory("the undecided zone would hold " + std::to_string(triangle_total) +
                     " triangles, expected fewer than 2^30: choose thinner slabs or a smaller error");
  }
  const std::uint64_t vertex_total = vertices.size() + piece.inherited + piece.positions.size();
  if (vertex_total >= EdgeSide::kBackwards) {
    throw OverMemory("the undecided zone would hold " + std::to_string(vertex_total) +
                     " vertices, expected fewer than 2^31: choose thinner slabs or a smaller error");
  }
  if constexpr (kChecks) check_piece(piece);
  order_.sort(piece, view(), front_, executor);
  const Index first_triangle = triangle_count();
  list_settled(static_cast<Index>(vertices.size() + piece.positions.size()));
  add_vertices(piece, executor);
  add_triangles(executor);
  std::vector<Index> front(piece.incomplete.size());
  std::vector<std::uint8_t> on_front(vertices.size(), 0);
  for (std::size_t n = 0; n < front.size(); ++n) {
    front[n] = index_of(order_.number(piece.incomplete[n]));
    on_front[front[n]] = 1;
  }
  link(piece, first_triangle, on_front, executor);
  if (extracted_surface_) know_more(piece, executor);
  first_unsettled_ = first_triangle;
  column_starts_.assign(order_.column_starts().begin(), order_.column_starts().end());
  if (piece.incomplete.empty()) {  // no later piece links to this one
    order_ = {};
    first_side_ = {};
    next_side_ = {};
  }
  front_ = std::move(front);
  settle_vertices(on_front, executor);
}

void Zone::serialize(StateWriter& state) const {
  write_part(state, view(), levels, front_);
  state.value(limit);
  if (extracted_surface_) extracted_surface_->serialize(state);
}

void Zone::serialize(StateReader& state, const PartShape& shape) {
  ZonePart part = read_part(state, shape);
  state.value(limit);
  state.require(limit <= options.retire, "a limit of costs that the run has");
  if (extracted_surface_) extracted_surface_->serialize(state, shape.farthest);
  take_arrays(part);
}

void Zone::take_arrays(ZonePart& part) {
  vertex_array_ = std::move(part.vertices);
  state_array_ = std::move(part.states);
  normal_array_ = std::move(part.normals);
  normal_quadric_array_ = std::move(part.normal_quadrics);
  value_array_ = std::move(part.values);
  triangle_array_ = std::move(part.triangles);
  levels = std::move(part.levels);
  front_ = std::move(part.front);
  unkeyed_edges_ = std::move(part.unkeyed_edges);
  forget_turns();
  first_unsettled_ = triangle_count();
}

// Shows the arrays in the view. Must be called when an array has changed its size.
void Zone::show_arrays() {
  const auto show = [](auto& view, auto& array) { view = {array.data(), array.size()}; };
  show(vertices, vertex_array_);
  show(states, state_array_);
  show(normals, normal_array_);
  show(normal_quadrics, normal_quadric_array_);
  show(values, value_array_);
  show(turn_keys, turn_key_array_);
  show(turns, turn_array_);
  show(triangles, triangle_array_);
}

void Zone::forget_turns() {
  turn_key_array_.resize(vertex_array_.size());
  turn_array_.resize(vertex_array_.size());
  show_arrays();
  std::fill(turn_keys.begin(), turn_keys.end(), make_key(kRetiredCost, 0));
  std::fill(turns.begin(), turns.end(), Turn());
  turns_forgotten_ = true;
}

void Zone::settle_all() {
  forget_turns();
  turns_forgotten_ = false;
  settled.clear();
  for (Index v = 0; v < vertices.size(); ++v) {
    if (states[v] != VertexState::kFinal) settled.old.push_back(v);
  }
  settled.first_new = settled.end = static_cast<Index>(vertices.size());
}

// Checks the promises of a source about a piece.
void Zone::check_piece(const SurfacePiece& piece) const {
  const std::size_t known = piece.inherited + piece.positions.size();
  ISOWEAVE_CHECK(piece.inherited == front_.size());
  ISOWEAVE_CHECK(piece.ids.size() == piece.positions.size());
  ISOWEAVE_CHECK(piece.normals.empty() || piece.normals.size() == piece.positions.size());
  ISOWEAVE_CHECK(piece.values.empty() || piece.values.size() == piece.positions.size());
  for (const auto& triangle : piece.triangles) {
    for (const std::uint32_t corner : triangle) ISOWEAVE_CHECK(corner < known);
  }
  for (const std::uint32_t v : piece.incomplete) ISOWEAVE_CHECK(v < known);
}

// Lists the settled vertices: those that were incomplete, those beside them, those that were deferred, and the new ones
// up to `end`.
void Zone::list_settled(Index end) {
  settled.clear();
  settled.first_new = static_cast<Index>(vertices.size());
  settled.end = end;
  std::vector<std::uint8_t> listed(vertices.size(), 0);
  const auto list = [&](Index v) {
    if (std::exchange(listed[v], 1) == 0) settled.old.push_back(v);
  };
  for (const Index v : front_) list(v);
  for (const Index h : unkeyed_edges_) {
    list(origin(h));
    list(destination(h));
  }
  for (Index v = 0; extracted_surface_ && v < vertices.size(); ++v) {
    if (states[v] != VertexState::kDeferred) continue;
    states[v] = VertexState::kComplete;
    list(v);
  }
  for (Index v = 0; turns_forgotten_ && v < vertices.size(); ++v) {
    if (states[v] == VertexState::kComplete) list(v);
  }
  turns_forgotten_ = false;
}

void Zone::add_vertices(const SurfacePiece& piece, const Executor& executor) {
  const std::size_t first = vertices.size();
  const std::size_t end = first + piece.positions.size();
  vertex_array_.resize(end);
  state_array_.resize(end);
  turn_key_array_.resize(end);
  turn_array_.resize(end);
  for (Array<LevelVertex>& level : levels) level.resize(end);
  normal_array_.resize(normal_array_.size() + piece.normals.size());
  value_array_.resize(value_array_.size() + piece.values.size());
  if (options.normals_count) normal_quadric_array_.resize(end);
  if (!piece.manifold) corner_array_.resize(end);
  show_arrays();
  touch(std::span(vertex_array_.begin() + first, vertex_array_.end()), executor);
  executor.for_each(static_cast<std::int64_t>(piece.positions.size()), kZoneBlock, [&](std::int64_t n) {
    const std::size_t from = order_.place_of_vertex(static_cast<std::size_t>(n));
    const std::size_t v = first + static_cast<std::size_t>(n);
    vertices[v] = Vertex();
    vertices[v].position = piece.positions[from];
    vertices[v].id = piece.ids[from];
    if (!piece.normals.empty()) normals[v] = piece.normals[from];
    if (!piece.values.empty()) values[v] = piece.values[from];
    states[v] = VertexState::kIncomplete;
    turn_keys[v] = 0;
    turns[v] = Turn();
    if (options.normals_count) normal_quadrics[v] = NormalQuadric();
    if (!piece.manifold) corner_array_[v] = 0;
    for (Array<LevelVertex>& level : levels) level[v] = LevelVertex();
  });
  countdown.begin(end);
}

// Makes room for the new triangles. Their half-edges are written where their vertices are linked.
void Zone::add_triangles(const Executor& executor) {
  const Index first = triangle_count();
  triangle_array_.resize(first + order_.triangles().size());
  show_arrays();
  touch(std::span(triangle_array_.begin() + first, triangle_array_.end()), executor);
}

// Shows the new triangles to the extracted surface, which forgets the triangles too far below everything that is held.
void Zone::know_more(const SurfacePiece& piece, const Executor& executor) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vertex& vertex : vertices) {
    if (exists(vertex.half_edge)) lowest = std::min(lowest, vertex.position.z);
  }
  extracted_surface_->forget_below(lowest);
  Array<Vec3> positions;
  positions.resize(piece.inherited + piece.positions.size());
  executor.for_each(static_cast<std::int64_t>(positions.size()), kZoneBlock, [&](std::int64_t n) {
    positions[static_cast<std::size_t>(n)] = vertices[index_of(static_cast<Index>(n))].position;
  });
  extracted_surface_->append(std::move(positions), order_.triangles(), piece.complete_below);
}

// Completes the vertices that later pieces do not add to: they get their quadrics, or are locked.
void Zone::settle_vertices(std::span<const std::uint8_t> on_front, const Executor& executor) {
  std::atomic<std::uint64_t> newly_locked{0};
  executor.for_each(static_cast<std::int64_t>(settled.size()), kZoneBlock, [&](std::int64_t n) {
    const Index v = settled[static_cast<std::size_t>(n)];
    if (states[v] != VertexState::kIncomplete || on_front[v] != 0) return;
    states[v] = VertexState::kComplete;
    if (!exists(vertices[v].half_edge)) {
      turn_keys[v] = kNoTurn;
      return;
    }
    start_fan(*this, v);
    Star star;
    star.gather(*this, v);
    if (!corner_array_.empty() && !is_one_fan(star)) {
      states[v] = VertexState::kLocked;
      newly_locked.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    initial_quadric(star);
  });
  locked += newly_locked;
}

// The quadric of a vertex that has all its faces.
void Zone::initial_quadric(Star& star) {
  const Index v = star.vertex;
  if (star.border || star.overflow) {
    give_initial_quadric(*this, v);
  } else {
    const VectorArithmetic arithmetic;
    Fan fan;
    arithmetic.measure(*this, star, fan);
    vertices[v].quadric = arithmetic.sum_faces(fan, star.count(), initial_weight(options)).planes;
  }
  if (options.normals_count) give_normal_quadric(*this, v);
}

// A batch of edges that get their keys together.
struct Zone::EdgeBatch {
  static constexpr std::size_t kCapacity = 64;

  std::array<Index, kCapacity> half_edges;
  std::array<std::uint64_t, kCapacity> ties;
  std::array<EdgeEnds, kCapacity> ends;
  std::size_t count = 0;
};

void Zone::settle_edges(const Executor& executor) {
  settle_waiting_edges(executor);
  std::vector<Index> unkeyed;
  collect(
      executor, triangle_count() - first_unsettled_, kZoneBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        settle_edges({first_unsettled_ + static_cast<Index>(begin), first_unsettled_ + static_cast<Index>(end)}, list);
      },
      unkeyed);
  set_aside(unkeyed);
  countdown.expect_nothing();
}

void Zone::settle_waiting_edges(const Executor& executor) {
  std::vector<Index> waiting;
  collect(
      executor, static_cast<std::int64_t>(unkeyed_edges_.size()), kZoneBlock,
      [&](std::int64_t begin, std::int64_t end, std::vector<Index>& list) {
        EdgeBatch batch;
        for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
          if (!settle_edge(unkeyed_edges_[n], batch)) list.push_back(unkeyed_edges_[n]);
        }
        give_keys(batch);
      },
      waiting);
  unkeyed_edges_ = std::move(waiting);
}

TriangleRange Zone::unsettled(std::size_t column) const {
  if (first_unsettled_ == triangle_count()) return {};
  return {first_unsettled_ + static_cast<Index>(column_starts_[column]),
          first_unsettled_ + static_cast<Index>(column_starts_[column + 1])};
}

void Zone::prefetch_corners(Index triangle) const {
  for (const HalfEdge& side : triangles[triangle].sides) prefetch(&vertices[side.vertex]);
}

void Zone::settle_edges(TriangleRange range, std::vector<Index>& unkeyed) {
  EdgeBatch batch;
  for (Index t = range.begin; t < range.end; ++t) {
    triangles[t].levels = 0;
    triangles[t].bounds = {};
    if (t + kAhead < range.end) prefetch_corners(t + kAhead);
    // The sides that represent their edges cannot be predicted. So every side is written, and the next one overwrites
    // it if it does not represent its edge.
    Index edges[3];
    std::size_t count = 0;
    for (Index c = 0; c < 3; ++c) {
      edges[count] = half_edge(t, c);
      count += static_cast<std::size_t>(represents_edge(edges[count]));
    }
    for (std::size_t n = 0; n < count; ++n) {
      if (!settle_edge(edges[n], batch)) unkeyed.push_back(edges[n]);
    }
  }
  give_keys(batch);
}

void Zone::set_aside(std::span<const Index> unkeyed) {
  const auto end = static_cast<std::ptrdiff_t>(unkeyed_edges_.size());
  unkeyed_edges_.insert(unkeyed_edges_.end(), unkeyed.begin(), unkeyed.end());
  std::sort(unkeyed_edges_.begin() + end, unkeyed_edges_.end());
  first_unsettled_ = triangle_count();
}

// Returns false when an end is incomplete. Else gives the edge its tie, and its key now or with the rest of the batch.
bool Zone::settle_edge(Index h, EdgeBatch& batch) {
  const Index a = origin(h);
  const Index b = destination(h);
  if (states[a] == VertexState::kIncomplete || states[b] == VertexState::kIncomplete) return false;
  const EdgeEnds ends = ends_in_order(*this, a, b);
  const std::uint64_t tie = give_tie(*this, h, ends);
  if (states[a] == VertexState::kLocked || states[b] == VertexState::kLocked) {
    set_key(h, make_key(kRetiredCost, tie));
    return true;
  }
  if (batch.count == EdgeBatch::kCapacity) give_keys(batch);
  batch.half_edges[batch.count] = h;
  batch.ties[batch.count] = tie;
  batch.ends[batch.count++] = ends;
  return true;
}

void Zone::give_keys(EdgeBatch& batch) {
  std::array<CostBits, EdgeBatch::kCapacity> costs;
  edge_costs(*this, VectorArithmetic(), std::span(batch.ends).first(batch.count), costs.data());
  const float first = key_factors(options.quality).first;
  for (std::size_t n = 0; n < batch.count; ++n)
    set_key(batch.half_edges[n], make_key(scaled(costs[n], first), batch.ties[n]));
  batch.count = 0;
}

void Zone::compact(const Executor& executor) {
  // A vertex stays as long as a triangle uses it, or a later piece will.
  std::vector<std::uint8_t> used(vertices.size(), 0);
  const auto use = [&](Index v) { std::atomic_ref(used[v]).store(1, std::memory_order_relaxed); };
  for (const Index v : front_) use(v);
  const Compaction new_triangle(executor, triangles.size(), [&](std::size_t t) {
    if (triangles[t].sides[0].vertex == kNone) return false;
    for (const HalfEdge& side : triangles[t].sides) use(side.vertex);
    return true;
  });
  const Compaction new_vertex(executor, vertices.size(), [&](std::size_t v) { return used[v] != 0; });
  const auto move_half_edge = [&](Index& h) {
    if (!exists(h) || new_triangle.stays(h >> 2)) return;
    const Index t = new_triangle[h >> 2];
    h = t == kNone ? kNone : half_edge(t, h & 3);
  };
  const auto move_vertex = [&](Index& v) {
    if (v != kNone && !new_vertex.stays(v)) v = new_vertex[v];
  };
  new_triangle.apply(triangle_array_, [&](Triangle& triangle) {
    for (HalfEdge& side : triangle.sides) {
      move_vertex(side.vertex);
      move_half_edge(side.twin);
    }
  });
  new_vertex.apply(vertex_array_, [&](Vertex& vertex) { move_half_edge(vertex.half_edge); });
  new_vertex.apply(turn_key_array_);
  new_vertex.apply(turn_array_, [&](Turn& turn) {
    move_half_edge(turn.edge);
    for (Index* v : {&turn.first_waiter, &turn.next_waiter, &turn.waits_for}) move_vertex(*v);
  });
  new_vertex.apply(state_array_);
  for (Array<LevelVertex>& level : levels) new_vertex.apply(level);
  if (!corner_array_.empty()) new_vertex.apply(corner_array_);
  if (!normal_array_.empty()) new_vertex.apply(normal_array_);
  if (!normal_quadric_array_.empty()) new_vertex.apply(normal_quadric_array_);
  if (!value_array_.empty()) new_vertex.apply(value_array_);
  show_arrays();
  for (Index& v : front_) move_vertex(v);
  for (Index& h : unkeyed_edges_) move_half_edge(h);
  first_unsettled_ = triangle_count();
  settled.clear();
}

std::uint64_t Zone::bytes() const {
  std::uint64_t level_bytes = 0;
  for (const Array<LevelVertex>& level : levels) level_bytes += level.capacity() * sizeof(LevelVertex);
  return level_bytes + (extracted_surface_ ? extracted_surface_->bytes() : 0) +
         vertex_array_.capacity() * (sizeof(Vertex) + sizeof(VertexState)) +
         turn_array_.capacity() * (sizeof(Turn) + sizeof(Key)) + normal_array_.capacity() * sizeof(Point) +
         normal_quadric_array_.capacity() * sizeof(NormalQuadric) + value_array_.capacity() * sizeof(float) +
         order_.bytes() + countdown.bytes() + triangle_array_.capacity() * sizeof(Triangle) +
         corner_array_.capacity() * sizeof(std::uint32_t) +
         (front_.capacity() + unkeyed_edges_.capacity() + settled.old.capacity()) * sizeof(Index);
}

}  // namespace isoweave
