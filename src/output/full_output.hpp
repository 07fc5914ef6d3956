// The output of the extracted surface, for runs that simplify nothing.
#pragma once

#include <cstdint>
#include <vector>

#include "extract/surface_piece.hpp"
#include "output/surface_output.hpp"

namespace isoweave {

class FullOutput {
 public:
  FullOutput(const World& world, MeshSink& sink, const Executor& executor, bool measure, SweepObserver* observer)
      : executor_(executor), output_(world, sink, executor, measure, observer) {}

  // Writes a piece of a manifold surface.
  void take(const SurfacePiece& piece);

  void report(SurfaceReport& report) const { output_.report(open_edges_, report); }

  // Returns when the sink has received everything. Throws what it threw.
  void wait() { output_.wait(); }

  // The vertices that the next piece inherits.
  std::size_t front_size() const { return front_.size(); }

  // The state between two pieces: written, and read before the first one. Throws BadInput.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state);

 private:
  void forget_components();

  const Executor& executor_;
  SurfaceOutput output_;
  std::vector<OutputCorner> front_;  // vertices that the next piece names as well
  std::uint64_t open_edges_ = 0;
};

}  // namespace isoweave
