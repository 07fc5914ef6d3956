// The one loop, which every run goes through. Each step reads and makes a piece of the surface, passes it through the
// stages, decides all edges that are safe to decide, and writes the final triangles.
#pragma once

#include <exception>
#include <utility>
#include <vector>

#include "extract/piece_stage.hpp"
#include "pipeline/back_end.hpp"
#include "pipeline/piece_source.hpp"

namespace isoweave {

// Throws Interrupted when the run is to stop.
void check_stop(const RunControl& control);

class Loop {
 public:
  // All arguments must outlive the loop. back_end: null where stages only look at the pieces.
  Loop(PieceSource& source, std::vector<PieceStage*> stages, BackEnd* back_end, MeshReport& report)
      : source_(source), stages_(std::move(stages)), back_end_(back_end), report_(report) {}

  bool complete() const { return source_.complete(); }

  // Takes the next piece, and returns the counts of what was held with it.
  SlabRecord step();

  // Returns when the sinks have received everything. Throws what they threw.
  void wait_for_sinks();

  // The triangles that were held after the last piece: none once the surface is complete.
  std::uint64_t undecided() const { return undecided_; }

  // Completes the report of a surface that is complete. Throws std::logic_error where triangles are left undecided.
  void finish();

  // The parts of the run that are in the memory of the process between two pieces.
  Held held() const;

  // Hands over the triangles that are held and not final.
  void view_undecided(const SweepObserver::Visitor& visitor) const {
    if (back_end_ != nullptr) back_end_->view_undecided(visitor);
  }

  // The state between two pieces, without that of the source: written, and read before the first one, after that of the
  // source. Throws BadInput.
  void serialize(StateWriter& state) const;
  void serialize(StateReader& state);

 private:
  void simplify(bool complete, SlabRecord& record);
  std::exception_ptr try_to_read();
  void read();

  PieceSource& source_;
  const std::vector<PieceStage*> stages_;
  BackEnd* const back_end_;
  MeshReport& report_;
  SurfacePiece piece_;
  bool is_read_ = false;  // what the next piece is made of
  std::uint64_t undecided_ = 0;
};

}  // namespace isoweave
