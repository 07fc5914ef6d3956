// The simplifier: takes pieces of a surface in, decides what is safe, and tells what is final.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "isoweave/simplify_options.hpp"
#include "parallel/parallel.hpp"
#include "simplify/driver.hpp"
#include "simplify/zone.hpp"

namespace isoweave {

struct SimplifierOptions {
  ZoneOptions zone;
  Quality quality = Quality::kNormal;
  Schedule schedule = Schedule::kAutomatic;
};

// What final vertices are seen to be when their stars are whole for the last time.
struct SurfaceDefects {
  std::uint64_t nonmanifold_edges = 0;
  std::uint64_t nonmanifold_vertices = 0;
};

class Simplifier {
 public:
  Simplifier(const SimplifierOptions& options, const Executor& executor, const std::atomic<bool>* stop);

  Zone& zone() { return zone_; }
  const Zone& zone() const { return zone_; }

  void append(const SurfacePiece& piece) { zone_.append(piece, executor_); }

  // Decides every edge that can be decided with what has been appended. Throws Interrupted.
  void decide();

  // Triangles all of whose vertices are final, in memory order. Marks vertices final. The caller takes them out with
  // Zone::remove_triangle and then calls compact().
  std::vector<Index> final_triangles();

  void compact() { zone_.compact(executor_); }

  DecisionCounts counts() const { return driver_->counts(); }
  Schedule schedule() const { return schedule_; }  // never automatic
  std::uint64_t rounds() const { return driver_->rounds(); }
  const SurfaceDefects& defects() const { return defects_; }

 private:
  void mark_undecided();
  std::vector<Index> name_final_vertices();
  void inspect(const std::vector<Index>& vertices);
  std::uint32_t list_neighbours(Index v, std::uint32_t most, std::vector<Index>& neighbours) const;

  Zone zone_;
  const Executor& executor_;
  const std::atomic<bool>* stop_;
  Schedule schedule_;
  std::unique_ptr<Driver> driver_;
  std::vector<std::uint8_t> undecided_;  // per vertex
  SurfaceDefects defects_;
};

}  // namespace isoweave
