// The output of final triangles, from whatever simplifies.
#pragma once

#include <cstdint>

#include "output/locked_part.hpp"
#include "output/surface_output.hpp"
#include "simplify/final_piece.hpp"

namespace isoweave {

class FinalOutput {
 public:
  FinalOutput(const World& world, MeshSink& sink, const Executor& executor, bool measure = true,
              SweepObserver* observer = nullptr)
      : executor_(executor), output_(world, sink, executor, measure, observer) {}

  // Writes the triangles that have become final since the last call, each vertex once.
  void take(FinalSource& source);

  bool measures() const { return output_.measures(); }

  // Fills in the counts of what has been written so far, its Euler number, components and digest. The counts of edges
  // leave out the edges with a locked end.
  void report(SurfaceReport& report) const { output_.report(open_edges_, report); }

  // Adds the counts around locked vertices, to a report that has everything else.
  void report_locked(SurfaceReport& report) const { locked_part_.report(report); }

  // Returns when the sink has received everything. Throws what it threw.
  void wait() { output_.wait(); }

  // The receipt of the next new vertex: its number and label are above those of all receipts given so far.
  Receipt end() const { return {output_.next_number(), output_.next_label()}; }

  // The counts between two pieces of a manifold surface: written, and read before the first one. Throws BadInput.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state);

 private:
  void write(std::uint64_t first_number);
  void keep_locked(std::uint64_t first_number);

  const Executor& executor_;
  SurfaceOutput output_;
  FinalPiece piece_;
  std::vector<OutputCorner> corners_;  // of the known vertices
  std::uint64_t open_edges_ = 0;       // without a locked end
  LockedPart locked_part_;
};

}  // namespace isoweave
