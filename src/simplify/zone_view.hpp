// The undecided zone as all deciders see it, on the host and on a device: half-edge arrays that another object owns.
//
// Half-edge h = 4 * triangle + corner runs from its vertex to the vertex of next(h); twin(h) runs back. A collapse
// writes the triangles and vertices of the two stars only, so collapses whose stars share no triangle can run at the
// same time. Nothing is freed between compactions: indices stay valid while edges are decided.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "isoweave/mesh.hpp"
#include "lattice/vertex_numbering.hpp"
#include "parallel/annotations.hpp"
#include "parallel/check.hpp"
#include "simplify/edge_rules.hpp"
#include "simplify/final_piece.hpp"
#include "simplify/normal_quadric.hpp"
#include "simplify/quadric.hpp"

namespace isoweave {

using Index = std::uint32_t;  // of a vertex, triangle or half-edge in the zone; a zone holds fewer than 2^30 triangles

inline constexpr Index kNone = 0xffffffffu;     // no half-edge: a border
inline constexpr Index kWritten = 0xfffffffeu;  // the other side is final and gone, or in another part of the surface

ISOWEAVE_HD inline Index half_edge(Index triangle, Index corner) { return 4 * triangle + corner; }

// next() and previous() have no comparisons, of which compilers make branches: the corner of a walk cannot be
// predicted.
ISOWEAVE_HD inline Index next(Index h) { return h + 1 - 3 * (h >> 1 & 1); }
ISOWEAVE_HD inline Index previous(Index h) { return h - 1 + (((h & 3) - 1) >> 30); }

ISOWEAVE_HD inline bool exists(Index h) { return h < kWritten; }

enum class VertexState : std::uint8_t {
  kIncomplete,  // later pieces give it more triangles: no quadric yet, blocks everything near
  kComplete,
  kDeferred,  // complete; an edge of it cannot be decided before more of the surface is known: blocks as well
  kCut,       // has its quadric; triangles of it are in another part of the surface: blocks as well
  kFinal,     // all its edges are retired
  kLocked,    // stays where it is; all its edges are retired from the start
};

struct alignas(64) Vertex {
  Vec3 position;
  std::uint64_t id = 0;
  Quadric quadric;                        // relative to position
  std::uint64_t number = kNotHandedOver;  // with the label, its receipt
  Index half_edge = kNone;  // one that starts here; on a border the one without a twin; kNone: the vertex is gone
  std::uint32_t label = 0;
};

static_assert(sizeof(Vertex) == 128, "two cache lines");

// A key is what the safe rule compares: the bits of the cost above the upper half of the tie. Both half-edges of an
// edge have the same key.
using Key = std::uint64_t;

ISOWEAVE_HD inline Key make_key(CostBits cost, std::uint64_t tie) { return Key{cost} << 32 | tie >> 32; }
inline constexpr Key kUnknownTurn = 0;  // comes before all others
inline constexpr Key kNoTurn = Key{kRetiredCost} << 32;

ISOWEAVE_HD inline CostBits cost_of(Key key) { return static_cast<CostBits>(key >> 32); }

inline constexpr std::size_t kMostLevels = 255;  // finer than the last one

// A bound on the distance of a face from the extracted surface, at one of its corners. In between bounds are linear.
using CornerBound = std::uint8_t;

inline constexpr CornerBound kBoundUnits = 255;  // in the distance that is allowed, beyond which no face lies

struct HalfEdge {
  Index vertex = kNone;  // where it starts
  Index twin = kNone;
  Key key = 0;
};

// A triangle is one cache line with everything that a walk around a vertex reads. Half-edge h is the h-th sixteen
// bytes.
struct alignas(64) Triangle {
  std::array<HalfEdge, 3> sides;
  std::array<std::uint32_t, 3> tie_low{};  // lower halves of the ties, for keys that are equal
  std::uint8_t levels = 0;                 // meshes of finer levels that have it
  std::array<CornerBound, 3> bounds{};     // where distances from the extracted surface are bounded
};

static_assert(sizeof(HalfEdge) == 16 && sizeof(Triangle) == 64);

// The turn of a vertex: its least edge, and the pairs that wait for that to change. The key of that edge is kept in an
// array of its own, as neighbours read it.
struct Turn {
  Index edge = kNone;  // half-edge of the least edge; kNone: unknown, or none
  Index first_waiter = kNone;
  Index next_waiter = kNone;  // in the list of the vertex waited for
  Index waits_for = kNone;
};

struct ZoneOptions {
  VertexNumbering numbering;
  double a0 = 1;               // mean voxel face, length squared
  CostBits retire = 0;         // edges with a higher cost are retired
  bool drop_specks = false;    // a tetrahedron within its cost vanishes
  double most_distance = 0;    // of any point from the extracted surface; 0: no such bound
  Vec3 cell{};                 // lengths of a box that holds a few triangles, where there is such a bound
  Vec3 largest{};              // lengths of a box that no triangle exceeds, likewise
  bool normals_count = false;  // in costs and places, by quadrics of their own
  Quality quality = Quality::kNormal;
};

class ExtractedSurface;

struct ZoneView {
  std::span<Vertex> vertices;
  std::span<VertexState> states;  // parallel to vertices
  std::span<Point> normals;  // parallel to vertices, or empty: sum of the unit normals merged into each, or the best
  std::span<Key> turn_keys;  // parallel to vertices: least key of the edges; kept by the schedule
  std::span<Turn> turns;     // parallel to vertices; kept by the schedules that use them
  std::span<Triangle> triangles;
  ZoneOptions options;
  // Edges with a higher cost wait until the limit is raised, so a run decides what a run with that error would decide.
  // The limit is at most options.retire. Lowering it leaves the decisions made so far as they are.
  CostBits limit = 0;
  const ExtractedSurface* extracted = nullptr;  // where distances are bounded; on the host only
  std::span<NormalQuadric> normal_quadrics{};   // parallel to vertices, where normals count; on the host only
  std::span<float> values{};                    // parallel to vertices, or empty; on the host only

  ISOWEAVE_HD Index triangle_count() const { return static_cast<Index>(triangles.size()); }

  ISOWEAVE_HD HalfEdge& half(Index h) const {
    ISOWEAVE_CHECK(h == 0 || ((h >> 2) < triangles.size() && (h & 3) < 3));
    return reinterpret_cast<HalfEdge*>(triangles.data())[h];
  }
  ISOWEAVE_HD Index origin(Index h) const { return half(h).vertex; }
  ISOWEAVE_HD Index destination(Index h) const { return origin(next(h)); }
  ISOWEAVE_HD Index twin(Index h) const { return half(h).twin; }
  ISOWEAVE_HD Key key(Index h) const { return half(h).key; }
  ISOWEAVE_HD CostBits cost(Index h) const { return cost_of(key(h)); }
  ISOWEAVE_HD std::uint32_t tie_low(Index h) const { return triangles[h >> 2].tie_low[h & 3]; }
  ISOWEAVE_HD std::uint64_t tie(Index h) const { return key(h) << 32 | tie_low(h); }
  ISOWEAVE_HD bool alive(Index h) const { return origin(h) != kNone; }  // the triangle of h is there

  // Whether edge a is decided before edge b.
  ISOWEAVE_HD bool comes_before(Index a, Index b) const {
    return key(a) != key(b) ? key(a) < key(b) : tie_low(a) < tie_low(b);
  }

  // Whether the star of v is one fan that can be walked around.
  ISOWEAVE_HD bool walkable(Index v) const {
    const VertexState state = states[v];
    return state != VertexState::kIncomplete && state != VertexState::kCut && state != VertexState::kLocked &&
           exists(vertices[v].half_edge);
  }

  // Whether a half-edge represents its edge: the smaller of two does, and a single one, as numbers that stand for no
  // half-edge are greater.
  ISOWEAVE_HD bool represents_edge(Index h) const { return h < twin(h); }

  // The next half-edge around the origin of h, counter-clockwise; kNone past a border.
  ISOWEAVE_HD Index rotate(Index h) const { return twin(previous(h)); }

  ISOWEAVE_HD void set_twin(Index h, Index other) const { half(h).twin = other; }
  ISOWEAVE_HD void set_key(Index h, Key key) const {
    half(h).key = key;
    if (exists(twin(h))) half(twin(h)).key = key;
  }
  ISOWEAVE_HD void set_cost(Index h, CostBits cost) const {
    set_key(h, Key{cost} << 32 | static_cast<std::uint32_t>(key(h)));
  }

  // Marks a triangle as gone.
  ISOWEAVE_HD void remove_triangle(Index t) const {
    for (HalfEdge& side : triangles[t].sides) side.vertex = kNone;
  }
};

}  // namespace isoweave
