// The seam for back ends: where pieces of a surface are simplified, and from where final triangles leave.
#pragma once

#include <cstdint>
#include <optional>

#include "files/state_file.hpp"
#include "isoweave/report.hpp"
#include "pipeline/piece_source.hpp"
#include "pipeline/task.hpp"
#include "simplify/count_target.hpp"

namespace isoweave {

class BackEnd {
 public:
  BackEnd() = default;
  BackEnd(const BackEnd&) = delete;
  BackEnd& operator=(const BackEnd&) = delete;
  virtual ~BackEnd() = default;

  // Takes the next piece in, and decides the edges that can be decided. `complete`: the piece is the last one of the
  // surface. Fills in the counts of what is held.
  virtual void simplify(const SurfacePiece& piece, bool complete, SlabRecord& record) = 0;

  // Hands the final triangles to the sinks. Fills in the counts of what is still held, and in the report the counts of
  // what has been written so far.
  virtual void write(const SurfacePiece& piece, SlabRecord& record, MeshReport& report) = 0;

  // After the last piece: nothing, or the head start of the run that has to take the place of this one, where this one
  // has handed nothing over and is of no use: its own head start was too high, or was there to count (CountTarget).
  virtual std::optional<HeadStart> overshot() const { return std::nullopt; }

  // The parts of the zone and the output that are in the memory of the process.
  virtual Held held() const = 0;

  // Hands over the triangles that are held over to the next piece, where they are in the memory of the process.
  virtual void view_undecided(const SweepObserver::Visitor&) const {}

  // Returns when the sinks have received everything. Throws what they threw.
  virtual void wait_for_sinks() = 0;

  // Fills in the counters of the whole run.
  virtual void finish(MeshReport& report) const = 0;

  // The vertices that the next piece inherits.
  virtual std::uint64_t inherited() const = 0;

  // The state between two pieces: written, and read before the first one. Throws BadInput. Processors and a device
  // have the same: one goes on where the other was.
  virtual void serialize(StateWriter& state) const = 0;
  virtual void serialize(StateReader& state) = 0;
};

// Reads whether the surface is simplified, and refuses the state of a run of the other kind.
void require_kind(StateReader& state, bool simplified);

// The shape of the parts of a task's surface, without the ends of receipts.
PartShape part_shape(const SimplifyTask& task);

}  // namespace isoweave
