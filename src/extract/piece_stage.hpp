// The seam for stages: a stage looks at a piece of the surface, or changes it, between extraction and simplification.
#pragma once

#include <cstdint>

#include "extract/surface_piece.hpp"
#include "files/state_file.hpp"

namespace isoweave {

class PieceStage {
 public:
  PieceStage() = default;
  PieceStage(const PieceStage&) = delete;
  PieceStage& operator=(const PieceStage&) = delete;
  virtual ~PieceStage() = default;

  // Takes the next piece. Later stages see the piece that this one leaves.
  virtual void apply(SurfacePiece& piece) = 0;

  // Bytes that the stage holds from piece to piece, if they grow.
  virtual std::uint64_t bytes() const { return 0; }

  // The state between two pieces.
  virtual void serialize(StateWriter& state) = 0;
  virtual void serialize(StateReader& state) = 0;
};

}  // namespace isoweave
