// Final triangles on their way out of the zone.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "output/locked_part.hpp"
#include "output/surface_output.hpp"
#include "simplify/simplifier.hpp"

namespace isoweave {

class FinalOutput {
 public:
  // level: the level of the simplifier; by default the only one.
  FinalOutput(const World& world, MeshSink& sink, const Executor& executor, bool measure = true, std::size_t level = 0,
              SweepObserver* observer = nullptr)
      : output_(world, sink, executor, measure, observer), executor_(executor), level_(level) {}

  // Writes the triangles that have become final in the level, each vertex once. Triangles of the last level leave the
  // simplifier's zone, which is compacted.
  void take(Simplifier& simplifier);

  // Fills in the counts of what has been written so far, its Euler number, components and digest. The counts of edges
  // leave out the edges with a locked end.
  void report(SurfaceReport& report) const { output_.report(open_edges_, report); }

  // Adds the counts around locked vertices, to a report that has everything else.
  void report_locked(SurfaceReport& report) const { locked_part_.report(report); }

  // Returns when the sink has received everything. Throws what it threw.
  void wait() { output_.wait(); }

  template <class Archive>
  void exchange(Archive& archive) {
    std::uint64_t open_edges = open_edges_;
    archive.value(open_edges);
    output_.exchange(archive);
    open_edges_ = open_edges;
  }

 private:
  // The place in the zone for the number of a vertex in this level's output.
  std::uint64_t& number(Zone& zone, Index v) const {
    return level_ < zone.levels.size() ? zone.levels[level_][v].output : zone.vertices[v].output;
  }
  std::uint32_t& component(Zone& zone, Index v) const {
    return level_ < zone.levels.size() ? zone.levels[level_][v].component : zone.vertices[v].component;
  }

  void number_vertices(Zone& zone, const std::vector<Index>& triangles);
  void keep_locked(Zone& zone, const std::vector<Index>& triangles);
  void count_open(const Zone& zone, const HalfEdge& side, const HalfEdge& next_side);
  void keep(Zone& zone, Index triangle);
  void close_sides(Zone& zone, Index triangle);
  void forget_components(Zone& zone);

  SurfaceOutput output_;
  const Executor& executor_;
  std::size_t level_;
  std::vector<std::uint8_t> marks_;  // per vertex of the zone: is written with this slab
  std::vector<Index> new_vertices_;
  std::atomic<std::uint64_t> open_edges_{0};  // without a locked end
  LockedPart locked_part_;
};

}  // namespace isoweave
