// Final triangles on their way out of the zone: numbered, measured, handed to the sink.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "isoweave/pipeline.hpp"
#include "measure/component_counter.hpp"
#include "pipeline/world.hpp"
#include "simplify/simplifier.hpp"

namespace isoweave {

class FinalOutput {
 public:
  FinalOutput(const World& world, MeshSink& sink) : world_(world), sink_(sink) {}

  // Takes all final triangles out of the simplifier's zone, each vertex written once, and compacts the zone.
  void take(Simplifier& simplifier);

  // Fills in what has been written so far: counts, Euler number, components, digest.
  void report(MeshReport& report) const;

 private:
  std::array<std::uint64_t, 3> write_triangle(Zone& zone, Index t);
  void forget_components(Zone& zone);

  const World& world_;
  MeshSink& sink_;
  ComponentCounter components_;
  std::vector<Point> points_;
  std::vector<Point> normals_;
  std::vector<std::array<std::uint64_t, 3>> triangles_;
  std::uint64_t vertices_written_ = 0;
  std::uint64_t triangles_written_ = 0;
  std::uint64_t open_edges_ = 0;
  std::uint64_t digest_ = 0;
};

}  // namespace isoweave
