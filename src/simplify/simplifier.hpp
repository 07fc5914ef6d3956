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
  // Zone::remove_triangle and then calls Zone::compact.
  std::vector<Index> final_triangles();

  DecisionCounts counts() const { return driver_->counts(); }
  Schedule schedule() const { return schedule_; }  // never automatic
  std::uint64_t rounds() const { return driver_->rounds(); }
  const SurfaceDefects& defects() const { return defects_; }

 private:
  void inspect_final_vertex(Index v, std::uint32_t corners);

  Zone zone_;
  const Executor& executor_;
  const std::atomic<bool>* stop_;
  Schedule schedule_;
  std::unique_ptr<Driver> driver_;
  SurfaceDefects defects_;
};

}  // namespace isoweave
