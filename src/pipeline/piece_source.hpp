// Where the pieces of a surface come from: a volume, a label of a map, a mesh.
#pragma once

#include <cstdint>

#include "extract/surface_piece.hpp"
#include "isoweave/report.hpp"

namespace isoweave {

// The amounts that a run holds between two pieces, in the memory of the process.
struct Held {
  std::uint64_t triangles = 0;    // undecided
  std::uint64_t zone_bytes = 0;   // of the zone, with the last piece; 0: not known
  std::uint64_t other_bytes = 0;  // besides, and growing
  std::uint64_t waiting = 0;      // of the triangles, about: those that the next piece leaves as they are
};

class PieceSource {
 public:
  PieceSource() = default;
  PieceSource(const PieceSource&) = delete;
  PieceSource& operator=(const PieceSource&) = delete;
  virtual ~PieceSource() = default;

  // Whether no piece is left.
  virtual bool complete() const = 0;

  // Reads the input of the next piece, as much as is right beside what the run holds. Adds the time to the report.
  virtual void read(const Held& held, MeshReport& report) = 0;

  // Makes the next piece from what has been read. Adds the time and the counts to the report.
  virtual void make(SurfacePiece& piece, MeshReport& report) = 0;

  // Whether reading for the next piece is to begin before this one is simplified.
  virtual bool reads_early() const { return false; }

  // The vertices that the next piece inherits.
  virtual std::uint64_t inherited() const { return 0; }

  // Bytes held for what has been read.
  virtual std::uint64_t bytes() const { return 0; }
};

}  // namespace isoweave
