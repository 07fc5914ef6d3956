// The seam for stages: a stage looks at a piece of the surface, or changes it, between extraction and simplification.
#pragma once

#include <cstdint>
#include <optional>

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

  // The vertices that the next piece inherits, once it has passed the stage; none where the stage expects another
  // number of them before.
  virtual std::optional<std::uint64_t> inherited(std::uint64_t before) const { return before; }

  // The state between two pieces: written, and read before the first one. Throws BadInput.
  virtual void serialize(StateWriter& state) const = 0;
  virtual void serialize(StateReader& state) = 0;
};

}  // namespace isoweave
