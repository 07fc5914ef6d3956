// Final triangles on their way out of the zone.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "pipeline/surface_output.hpp"
#include "simplify/simplifier.hpp"

namespace isoweave {

class FinalOutput {
 public:
  FinalOutput(const World& world, MeshSink& sink, const Executor& executor, bool measure = true,
              SweepObserver* observer = nullptr)
      : output_(world, sink, executor, measure, observer), executor_(executor) {}

  // Takes all final triangles out of the simplifier's zone, each vertex written once, and compacts the zone.
  void take(Simplifier& simplifier);

  // Fills in what has been written so far: counts, Euler number, components, digest.
  void report(MeshReport& report) const { output_.report(open_edges_, report); }

  // Returns when the sink has everything. Throws what it threw.
  void wait() { output_.wait(); }

  template <class Archive>
  void exchange(Archive& archive) {
    std::uint64_t open_edges = open_edges_;
    archive.value(open_edges);
    output_.exchange(archive);
    open_edges_ = open_edges;
  }

 private:
  void number_vertices(Zone& zone, const std::vector<Index>& triangles);
  void close_sides(Zone& zone, Index triangle);
  void forget_components(Zone& zone);

  SurfaceOutput output_;
  const Executor& executor_;
  std::vector<std::uint8_t> marks_;  // per vertex of the zone: is written with this slab
  std::vector<Index> new_vertices_;
  std::atomic<std::uint64_t> open_edges_{0};
};

}  // namespace isoweave
