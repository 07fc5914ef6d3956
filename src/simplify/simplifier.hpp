// The simplifier: takes pieces of a surface in, decides all edges that are safe to decide, and finds what is final.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "isoweave/run.hpp"
#include "parallel/parallel.hpp"
#include "simplify/driver.hpp"
#include "simplify/final_piece.hpp"
#include "simplify/zone.hpp"

namespace isoweave {

struct SimplifierOptions {
  ZoneOptions zone;
  Schedule schedule = Schedule::kAutomatic;
  // The costs of the finer meshes, ascending, all below the cost at which edges are retired.
  std::vector<CostBits> finer{};
  bool inspect = true;  // inspect final vertices for defects
  bool cut = false;     // the surface is cut: other parts of it have copies of vertices
};

class Simplifier {
 public:
  Simplifier(const SimplifierOptions& options, const Executor& executor, const std::atomic<bool>* stop);
  ~Simplifier();

  Zone& zone() { return zone_; }
  const Zone& zone() const { return zone_; }

  void append(const SurfacePiece& piece) {
    zone_.append(piece, executor_);
    if (schedule_ != Schedule::kLocal) zone_.settle_edges(executor_);  // the local one settles edges while it decides
    appended_ += piece.triangles.size();
  }

  // Takes a part in that is linked, before anything else.
  void put_part(ZonePart part) {
    appended_ = part.triangles.size();
    zone_.put_part(std::move(part), executor_);
  }

  // The undecided surface as a part (Zone::take_part), once all levels have handed out their final triangles. The
  // simplifier is of no use afterwards, but for its counts.
  ZonePart take_part(const std::function<bool(std::uint64_t, std::uint64_t)>& is_border) {
    return zone_.take_part(is_border, executor_);
  }

  // For a surface that is cut, after decide(): takes out the triangles at whose vertices all edges cost more than the
  // limit, as a part by itself, for a run with a higher limit. least: gets a cost for each of them, below which no edge
  // of its vertices lies.
  ZonePart take_settled(CostHistogram& least);

  // The number of meshes that come out: one for each finer level, and the last one.
  std::size_t levels() const { return finer_.size() + 1; }
  bool is_last(std::size_t level) const { return level == finer_.size(); }

  // Decides every edge that can be decided with the pieces appended so far. Throws Interrupted.
  void decide();

  // Decides every edge up to the cost of a level. After an append the levels follow one another, and each hands out its
  // final triangles before the next one changes them.
  void decide(std::size_t level);

  // For a complete surface, after decide(): decides in the order of the keys until no more than `triangles` of the
  // surface are left, or no edge is. Turns are not renewed, so decide() must not follow. Throws Interrupted.
  void decide_in_order(std::uint64_t triangles);

  // Where the final triangles of a level come from, after decide(level): those whose vertices are all final there, in
  // memory order. Triangles of the last level leave the zone, which is compacted.
  FinalSource& final_source(std::size_t level = 0) { return *sources_[level]; }

  // Compacts the zone if one in `part` of its triangles has gone.
  void close_gaps(std::uint64_t part = 8);

  // The triangles of the surface so far: those held, and those handed out.
  std::uint64_t triangles() const { return appended_ - counts().removed; }

  // The triangles that are held and have not been collapsed.
  std::uint64_t live_triangles() const { return triangles() - dropped_; }

  DecisionCounts counts() const {
    DecisionCounts sum = counts_before_;
    sum += driver_->counts();
    return sum;
  }
  // Counts removed triangles by the keys of the decisions, from now on.
  void count_removed() { driver_->count_removed(); }

  // The counts of removed triangles, with those of the process that saved the state.
  CostHistogram removed_by_key() const;
  Schedule schedule() const { return schedule_; }  // never automatic
  std::uint64_t rounds() const { return rounds_before_ + driver_->rounds(); }
  const SurfaceDefects& defects(std::size_t level) const { return defects_[level]; }
  const SurfaceDefects& defects() const { return defects_.back(); }

  // The state between two pieces: written, and read before the first one. Throws BadInput.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state, const PartShape& shape);

  // The counts of removed triangles by key, likewise.
  void serialize_removed(StateWriter& state) const { removed_by_key().serialize(state); }
  void serialize_removed(StateReader& state) { removed_before_.emplace().serialize(state); }

 private:
  class Source;

  CostBits limit_of(std::size_t level) const { return is_last(level) ? zone_.options.retire : finer_[level]; }
  std::vector<Index> final_triangles(std::size_t level, CostBits within);
  void note_dropped(std::size_t triangles);
  std::vector<Index> name_final_vertices(std::size_t level, CostBits within);
  bool make_final(Index v, std::size_t level);

  Zone zone_;
  const Executor& executor_;
  const std::atomic<bool>* stop_;
  Schedule schedule_;
  std::vector<CostBits> finer_;
  bool inspects_;
  std::unique_ptr<Driver> driver_;
  std::vector<std::unique_ptr<FinalSource>> sources_;  // per level
  std::vector<std::uint8_t> undecided_;                // per vertex
  std::uint64_t appended_ = 0;                         // triangles
  std::uint64_t dropped_ = 0;
  std::vector<SurfaceDefects> defects_;          // per level
  DecisionCounts counts_before_;                 // by the process that saved the state
  std::optional<CostHistogram> removed_before_;  // likewise, by key
  std::uint64_t rounds_before_ = 0;
};

}  // namespace isoweave
