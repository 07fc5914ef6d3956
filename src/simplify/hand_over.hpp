// How final triangles leave the zone on processors.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/parallel.hpp"
#include "simplify/final_piece.hpp"
#include "simplify/zone.hpp"

namespace isoweave {

class HandOver {
 public:
  // level: of the zone's levels, or their number for the last mesh. Both other arguments must outlive this. early:
  // final vertices are handed over before any triangle of them is, so that copies of them have the same receipts.
  HandOver(Zone& zone, std::size_t level, bool early, const Executor& executor)
      : zone_(zone), level_(level), early_(early), executor_(executor) {}

  // Fills in triangles of the level, which have become final there, with their vertices in memory order. Those of the
  // last mesh are removed from the zone; the others stay for the levels behind.
  void fill(std::span<const Index> triangles, const Receipt& first, FinalPiece& piece);

  // Lets the receiver replace the labels in the receipts that are held.
  void change_labels(const std::function<void(std::span<std::uint32_t*>)>& change);

 private:
  bool is_last() const { return level_ == zone_.levels.size(); }
  std::uint64_t& number(Index v) const { return is_last() ? zone_.vertices[v].number : zone_.levels[level_][v].number; }
  std::uint32_t& label(Index v) const { return is_last() ? zone_.vertices[v].label : zone_.levels[level_][v].label; }

  bool is_final(Index v) const {
    return is_last() ? zone_.states[v] == VertexState::kFinal : zone_.levels[level_][v].final;
  }

  void list_vertices(std::span<const Index> triangles);
  template <class Select>
  void list(std::vector<Index>& vertices, const Select& select);
  void fill_vertices(const Receipt& first, FinalPiece& piece) const;
  void fill_triangles(std::span<const Index> triangles, FinalPiece& piece);
  void mark_locked(FinalPiece& piece) const;
  void count_open(const HalfEdge& side, const HalfEdge& next_side);
  void keep(Index triangle);
  void take_out(Index triangle);

  Zone& zone_;
  const std::size_t level_;
  const bool early_;
  const Executor& executor_;
  std::vector<std::uint32_t> place_;  // per vertex of the zone: its number in the piece, where that names it
  std::vector<Index> known_, new_;    // vertices of the piece
  std::atomic<std::uint64_t> open_edges_{0};
};

}  // namespace isoweave
