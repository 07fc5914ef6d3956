// The undecided zone: the part of the surface that is held, as half-edge arrays.
//
// Half-edge h = 3 * triangle + corner runs from its vertex to the vertex of next(h); twin(h) runs back. A collapse
// writes half-edges and keys inside the two stars only, so collapses whose stars share no triangle can run at the
// same time. Nothing is freed between compactions: indices stay valid while edges are decided.
#pragma once

#include <cstdint>
#include <vector>

#include "extract/surface_piece.hpp"
#include "parallel/parallel.hpp"
#include "simplify/quadric.hpp"
#include "simplify/rules.hpp"

namespace isoweave {

using Index = std::uint32_t;  // of a vertex, triangle or half-edge in the zone; a zone holds fewer than 2^32 half-edges

inline constexpr Index kNone = 0xffffffffu;     // no half-edge: a border
inline constexpr Index kWritten = 0xfffffffeu;  // the other side is final and gone

inline Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline Index previous(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
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
  Quadric quadric;  // relative to position
  std::uint64_t id = 0;
  std::uint64_t output = kNotWritten;  // number in the output
  Index half_edge = kNone;  // one that starts here; on a border the one without a twin; kNone: the vertex is gone
  Index component = 0;      // of the written surface, once written
};

static_assert(sizeof(Vertex) == 128, "two cache lines");

struct HalfEdge {
  Index vertex;  // kNone in a triangle that is gone
  Index twin;
};

struct ZoneOptions {
  EdgeNumbering numbering;
  double a0 = 1;        // mean voxel face, length squared
  CostBits retire = 0;  // edges with a higher cost are retired
};

class Zone {
 public:
  explicit Zone(const ZoneOptions& options) : options_(options) {}

  std::vector<Vertex> vertices;
  std::vector<VertexState> states;  // parallel to vertices
  std::vector<Point> normals;       // parallel to vertices, or empty: sum of the unit normals merged into each
  std::vector<HalfEdge> half_edges;
  std::vector<CostBits> cost;      // of the edge, equal on both half-edges
  std::vector<std::uint64_t> tie;  // likewise

  const ZoneOptions& options() const { return options_; }
  Index triangles() const { return static_cast<Index>(half_edges.size() / 3); }
  Index live_triangles() const { return triangles() - dead_triangles_; }
  Index origin(Index h) const { return half_edges[h].vertex; }
  Index destination(Index h) const { return half_edges[next(h)].vertex; }
  Index twin(Index h) const { return half_edges[h].twin; }
  bool alive(Index h) const { return half_edges[h].vertex != kNone; }

  // The half-edge that stands for its edge.
  bool represents_edge(Index h) const { return h < half_edges[h].twin || !exists(half_edges[h].twin); }

  // The next half-edge around the origin of h, counter-clockwise; kNone past a border.
  Index rotate(Index h) const { return half_edges[previous(h)].twin; }

  void set_cost(Index h, CostBits c) {
    cost[h] = c;
    if (exists(twin(h))) cost[twin(h)] = c;
  }

  // Takes a piece in: links it to the front, then gives quadrics to the vertices and keys to the edges that are
  // complete now. Throws OverMemory when the zone would hold 2^32 half-edges.
  void append(const SurfacePiece& piece, const Executor& executor);

  // Marks a triangle as gone.
  void remove_triangle(Index t);

  // Drops what is gone once it is at least an eighth of what is held. Keeps the order of triangles.
  void compact();

  std::uint64_t bytes() const;

 private:
  void link(const SurfacePiece& piece, Index first_half_edge, const Executor& executor);
  void settle_front(const SurfacePiece& piece, Index first_vertex, const Executor& executor);
  void key_edges(Index first_half_edge, const Executor& executor);
  void initial_quadric(Index v);
  Index piece_vertex(const SurfacePiece& piece, Index first_vertex, Index n) const {
    return n < piece.inherited ? front_[n] : first_vertex + (n - piece.inherited);
  }

  ZoneOptions options_;
  std::vector<Index> front_;            // incomplete vertices, in the order of the piece that named them
  std::vector<Index> open_half_edges_;  // without twin, an end incomplete: the next piece may bring it
  std::vector<Index> unkeyed_edges_;    // an end incomplete
  Index dead_triangles_ = 0;
};

// Cost of collapsing the edge (u, v): least value of the sum of the two quadrics.
CostBits edge_cost(const Vertex& u, const Vertex& v);

}  // namespace isoweave
