// The undecided zone: the part of the surface that is held, as half-edge arrays.
//
// Half-edge h = 4 * triangle + corner runs from its vertex to the vertex of next(h); twin(h) runs back. A collapse
// writes the triangles and vertices of the two stars only, so collapses whose stars share no triangle can run at the
// same time. Nothing is freed between compactions: indices stay valid while edges are decided.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "extract/surface_piece.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"
#include "simplify/quadric.hpp"
#include "simplify/rules.hpp"

namespace isoweave {

using Index = std::uint32_t;  // of a vertex, triangle or half-edge in the zone; a zone holds fewer than 2^30 triangles

inline constexpr Index kNone = 0xffffffffu;     // no half-edge: a border
inline constexpr Index kWritten = 0xfffffffeu;  // the other side is final and gone

inline Index half_edge(Index triangle, Index corner) { return 4 * triangle + corner; }

// Without branches: the corner that a walk comes by cannot be predicted.
inline Index next(Index h) { return h + 1 - 3 * (h >> 1 & 1); }
inline Index previous(Index h) { return h - 1 + 3 * (~(h | h >> 1) & 1); }

inline bool exists(Index h) { return h < kWritten; }

enum class VertexState : std::uint8_t {
  kIncomplete,  // later pieces give it more triangles: no quadric yet, blocks everything near
  kComplete,
  kFinal,   // all its edges are retired
  kLocked,  // stays where it is; all its edges are retired from the start
};

inline constexpr std::uint64_t kNotWritten = ~std::uint64_t{0};

struct alignas(64) Vertex {
  Vec3 position;
  std::uint64_t id = 0;
  Quadric quadric;                     // relative to position
  std::uint64_t output = kNotWritten;  // number in the output
  Index half_edge = kNone;  // one that starts here; on a border the one without a twin; kNone: the vertex is gone
  Index component = 0;      // of the written surface, once written
};

static_assert(sizeof(Vertex) == 128, "two cache lines");

// The key is what the safe rule compares: the bits of the cost above the upper half of the tie. It is equal on both
// half-edges of an edge.
using Key = std::uint64_t;

inline Key make_key(CostBits cost, std::uint64_t tie) { return Key{cost} << 32 | tie >> 32; }
inline CostBits cost_of(Key key) { return static_cast<CostBits>(key >> 32); }

struct HalfEdge {
  Index vertex = kNone;  // where it starts
  Index twin = kNone;
  Key key = 0;
};

// One cache line holds what a walk around a vertex reads. Half-edge h is the h-th sixteen bytes.
struct alignas(64) Triangle {
  std::array<HalfEdge, 3> sides;
  std::array<std::uint32_t, 3> tie_low{};  // lower halves of the ties, for keys that are equal
};

static_assert(sizeof(HalfEdge) == 16 && sizeof(Triangle) == 64);

// Whose turn it is at a vertex, and who waits for that to change. The key of its least edge is kept apart: it is what
// neighbours look at.
struct Turn {
  Index edge = kNone;  // half-edge of the least edge; kNone: unknown, or none
  Index first_waiter = kNone;
  Index next_waiter = kNone;  // in the list of the vertex waited for
  Index waits_for = kNone;
};

// Vertices whose edges may have got keys: some that were there before, and all new ones.
struct SettledVertices {
  std::vector<Index> old;
  Index first_new = 0;
  Index end = 0;

  std::size_t size() const { return old.size() + (end - first_new); }
  Index operator[](std::size_t n) const {
    return n < old.size() ? old[n] : first_new + static_cast<Index>(n - old.size());
  }
  void clear() {
    old.clear();
    first_new = end = 0;
  }
};

struct ZoneOptions {
  EdgeNumbering numbering;
  double a0 = 1;        // mean voxel face, length squared
  CostBits retire = 0;  // edges with a higher cost are retired
};

struct Star;

class Zone {
 public:
  explicit Zone(const ZoneOptions& options) : options_(options), limit_(options.retire) {}

  Array<Vertex> vertices;
  Array<VertexState> states;   // parallel to vertices
  std::vector<Point> normals;  // parallel to vertices, or empty: sum of the unit normals merged into each
  Array<Key> turn_keys;        // parallel to vertices: least key of the edges; kept by the schedule
  Array<Turn> turns;           // parallel to vertices; kept by the schedules that use them
  Array<Triangle> triangles;
  SettledVertices settled;  // with the last piece

  const ZoneOptions& options() const { return options_; }

  // Edges with a higher cost wait until it is raised: what is decided is what a run with that error would decide.
  CostBits limit() const { return limit_; }

  // All vertices count as settled afterwards. At most what retires an edge.
  void raise_limit(CostBits limit);

  // Nothing more is to be decided: all edges are retired.
  void retire_all() { options_.retire = limit_ = kUnknownCost; }

  Index triangle_count() const { return static_cast<Index>(triangles.size()); }

  const HalfEdge& half(Index h) const { return reinterpret_cast<const HalfEdge*>(triangles.data())[h]; }
  HalfEdge& half(Index h) { return reinterpret_cast<HalfEdge*>(triangles.data())[h]; }
  Index origin(Index h) const { return half(h).vertex; }
  Index destination(Index h) const { return origin(next(h)); }
  Index twin(Index h) const { return half(h).twin; }
  Key key(Index h) const { return half(h).key; }
  CostBits cost(Index h) const { return cost_of(key(h)); }
  std::uint32_t tie_low(Index h) const { return triangles[h >> 2].tie_low[h & 3]; }
  std::uint64_t tie(Index h) const { return key(h) << 32 | tie_low(h); }
  bool alive(Index h) const { return origin(h) != kNone; }  // the triangle of h is there

  // The order in which edges are decided.
  bool comes_before(Index a, Index b) const { return key(a) != key(b) ? key(a) < key(b) : tie_low(a) < tie_low(b); }

  // The star of v is one fan that can be walked around.
  bool walkable(Index v) const {
    return (states[v] == VertexState::kComplete || states[v] == VertexState::kFinal) && exists(vertices[v].half_edge);
  }

  // The half-edge that stands for its edge.
  bool represents_edge(Index h) const { return h < twin(h) || !exists(twin(h)); }

  // The next half-edge around the origin of h, counter-clockwise; kNone past a border.
  Index rotate(Index h) const { return twin(previous(h)); }

  void set_twin(Index h, Index other) { half(h).twin = other; }
  void set_key(Index h, Key key) {
    half(h).key = key;
    if (exists(twin(h))) half(twin(h)).key = key;
  }
  void set_cost(Index h, CostBits cost) { set_key(h, Key{cost} << 32 | static_cast<std::uint32_t>(key(h))); }

  // Takes a piece in: links it to the front, then gives quadrics to the vertices and keys to the edges that are
  // complete now. Throws OverMemory when the zone would hold 2^30 triangles.
  void append(const SurfacePiece& piece, const Executor& executor);

  // Marks a triangle as gone.
  void remove_triangle(Index t);

  // Drops what is gone. Keeps the order of triangles.
  void compact(const Executor& executor);

  std::uint64_t bytes() const;

  // The state between two appends. Turns are not part of it: with the next append all undecided vertices count as
  // settled.
  template <class Archive>
  void exchange(Archive& archive) {
    archive.list(vertices);
    archive.list(states);
    archive.list(normals);
    archive.list(triangles);
    archive.list(front_);
    archive.list(unkeyed_edges_);
    archive.value(limit_);
    if constexpr (Archive::kReads) forget_turns();
  }

 private:
  struct EdgeBatch;

  // One side of an edge, in the list of the end with the smaller number.
  struct EdgeSide {
    Index other;  // number of the other end, and the direction
    Index half_edge;
  };

  void forget_turns();
  void list_settled(Index end);
  void add_vertices(const SurfacePiece& piece, const Executor& executor);
  void add_triangles(const SurfacePiece& piece, const Executor& executor);
  void start_at(Index v, Index h);
  void link(const SurfacePiece& piece, Index first_triangle, const Executor& executor);
  void pair_sides(std::span<EdgeSide> sides);
  void lock(Index v);
  void lock_split_vertices(const Executor& executor);
  std::uint32_t count_fan(Index v) const;
  std::vector<std::array<Index, 3>> open_sides_of(const SurfacePiece& piece) const;
  void settle_vertices(const Executor& executor);
  void start_at_border(Index v);
  void initial_quadric(Index v);
  Quadric face_planes(Star& star) const;
  Quadric face_planes_one_by_one(Index v) const;
  double initial_weight() const { return 1 / (6 * options_.a0 * options_.a0); }  // per twice the area of a face
  Vec3 face_normal(Index h) const;
  Quadric border_plane(Index v, Index other, Index face) const;
  void settle_edges(Index first_triangle, const Executor& executor);
  bool settle_edge(Index h, EdgeBatch& batch);
  void give_keys(EdgeBatch& batch);

  ZoneOptions options_;
  CostBits limit_;
  std::vector<Index> front_;          // incomplete vertices, in the order of the piece that named them
  std::vector<Index> unkeyed_edges_;  // an end incomplete
  bool turns_forgotten_ = false;
};

}  // namespace isoweave
