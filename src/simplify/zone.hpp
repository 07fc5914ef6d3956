// The undecided zone: the part of the surface that is held in memory.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "extract/surface_piece.hpp"
#include "parallel/array.hpp"
#include "parallel/parallel.hpp"
#include "simplify/extracted_surface.hpp"
#include "simplify/key_countdown.hpp"
#include "simplify/piece_order.hpp"
#include "simplify/star.hpp"
#include "simplify/zone_part.hpp"
#include "simplify/zone_view.hpp"

namespace isoweave {

// The settled vertices, whose edges may have got keys: some older ones, and all new ones.
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

struct TriangleRange {
  Index begin = 0;
  Index end = 0;
};

// The zone owns the arrays that its view shows.
class Zone : public ZoneView {
 public:
  // finer_levels: meshes with smaller errors that come out of the zone as well.
  explicit Zone(const ZoneOptions& zone_options, std::size_t finer_levels = 0);
  Zone(const Zone&) = delete;
  Zone& operator=(const Zone&) = delete;

  // The view, to be copied into passes over the zone.
  const ZoneView& view() const { return *this; }

  SettledVertices settled;                 // with the last piece
  std::uint64_t locked = 0;                // vertices so far, those that are gone included
  std::vector<Array<LevelVertex>> levels;  // before the last one; each parallel to vertices
  KeyCountdown countdown;                  // of the edges of new triangles

  // Forgets all turns: every undecided vertex counts as settled.
  void settle_all();

  // Retires all edges, as nothing more is to be decided.
  void retire_all() { options.retire = limit = kUnknownCost; }

  // Takes a piece in: links it to the front, and gives quadrics to the vertices that are complete now. Throws
  // OverMemory when the zone would hold 2^30 triangles.
  void append(const SurfacePiece& piece, const Executor& executor);

  // Gives keys to the edges both of whose ends are complete now. Must be called after an append.
  void settle_edges(const Executor& executor);

  // The parts of settle_edges(), for a schedule that decides edges meanwhile. The first part is for the edges that have
  // waited for a vertex. The second is for the new triangles of each column, by several threads at once; `unkeyed` gets
  // the edges that wait from now on. The last part takes these edges, of all threads in any order. Meanwhile an edge
  // may be decided once the countdown has named both its ends and all their neighbours.
  void settle_waiting_edges(const Executor& executor);
  TriangleRange unsettled(std::size_t column) const;
  void settle_edges(TriangleRange range, std::vector<Index>& unkeyed);
  void set_aside(std::span<const Index> unkeyed);

  // Removes the triangles and vertices that are gone. Triangles keep their order.
  void compact(const Executor& executor);

  std::uint64_t bytes() const;

  // The undecided surface between two appends, where all pieces are manifold: written, and read into an empty zone.
  // Turns are no part of it: with the next append all undecided vertices count as settled.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state, const PartShape& shape);

  // The undecided surface as a part of one that is cut. The zone is of no use afterwards. is_border(id, id): whether an
  // edge between two incomplete vertices, with one triangle here, lies on a border of the surface.
  ZonePart take_part(const std::function<bool(std::uint64_t, std::uint64_t)>& is_border, const Executor& executor);

  // Copies some triangles, to be removed, as a part by itself. Vertices of it are not final, and the triangles beside
  // them that stay are told that they are gone.
  ZonePart copy_settled(const std::vector<Index>& gone);

  // Puts a part that is linked into an empty zone. Vertices that it completes get their quadrics, their edges get keys,
  // and all undecided vertices count as settled.
  void put_part(ZonePart part, const Executor& executor);

  // The vertices that the next piece inherits.
  std::size_t front_size() const { return front_.size(); }

 private:
  class Linker;
  struct EdgeBatch;

  void take_arrays(ZonePart& part);
  void show_arrays();
  void forget_turns();
  void list_settled(Index end);
  // A vertex of the last piece, by its number in that piece after sorting.
  Index index_of(Index number) const {
    return number < front_.size() ? front_[number] : settled.first_new + (number - static_cast<Index>(front_.size()));
  }
  void check_piece(const SurfacePiece& piece) const;
  void add_vertices(const SurfacePiece& piece, const Executor& executor);
  void add_triangles(const Executor& executor);
  void link(const SurfacePiece& piece, Index first_triangle, std::span<const std::uint8_t> on_front,
            const Executor& executor);
  void know_more(const SurfacePiece& piece, const Executor& executor);
  bool is_one_fan(const Star& star) const;
  std::vector<std::array<Index, 3>> known_sides_of(const SurfacePiece& piece) const;
  void settle_vertices(std::span<const std::uint8_t> on_front, const Executor& executor);
  void initial_quadric(Star& star);
  void prefetch_corners(Index triangle) const;
  bool settle_edge(Index h, EdgeBatch& batch);
  void give_keys(EdgeBatch& batch);

  Array<Vertex> vertex_array_;
  Array<VertexState> state_array_;
  std::vector<Point> normal_array_;
  Array<NormalQuadric> normal_quadric_array_;  // where normals count
  std::vector<float> value_array_;
  Array<Key> turn_key_array_;
  Array<Turn> turn_array_;
  Array<Triangle> triangle_array_;
  Array<std::uint32_t> corner_array_;       // triangles that name each vertex, and whether an edge of it is bad; only
                                            // where pieces are no manifold by promise
  PieceOrder order_;                        // of the last piece
  Array<Index> first_side_, next_side_;     // lists of sides that link() pairs, kept for the next piece
  std::vector<Index> front_;                // incomplete vertices, in the order of the piece that named them
  std::vector<Index> unkeyed_edges_;        // an end incomplete
  Index first_unsettled_ = 0;               // triangle: its edges and those of the ones behind it have no keys
  std::vector<std::size_t> column_starts_;  // of these triangles
  bool turns_forgotten_ = false;
  std::unique_ptr<ExtractedSurface> extracted_surface_;  // where distances are bounded
};

}  // namespace isoweave
