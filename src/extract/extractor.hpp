// The seam for extractors: how a surface is made from the slices of a volume, some layers at a time.
#pragma once

#include <cstdint>
#include <utility>

#include "extract/surface_piece.hpp"
#include "files/state_file.hpp"
#include "lattice/vertex_numbering.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

// The counts of a slab that has been extracted.
struct SlabCounts {
  std::int64_t layers = 0;
  std::uint64_t cells_crossed = 0, triangles = 0, vertices = 0;
};

// Layer k lies between slices k and k + 1. Layers are taken in ascending order, each once.
class Extractor {
 public:
  Extractor() = default;
  Extractor(const Extractor&) = delete;
  Extractor& operator=(const Extractor&) = delete;
  virtual ~Extractor() = default;

  // How the vertices of the surface are numbered.
  virtual VertexNumbering numbering() const = 0;

  // Layers not yet extracted.
  virtual std::int64_t layers_left() const = 0;

  // Slices [first, end) that the next `layers` layers read, unclipped.
  virtual std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const = 0;

  // Extracts the next `layers` layers, or fewer, though at least one, where they would make more than `most_vertices`.
  // The window holds what slices_for() names, as far as the volume goes. Fills `piece`, or keeps the surface where it
  // is extracted and leaves the piece empty. Same result for any number of threads.
  virtual SlabCounts extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                             SurfacePiece& piece) = 0;

  // The most layers of a slab, however many are left.
  virtual std::int64_t most_layers() const { return layers_left(); }

  // New vertices that memory other than the process's has room for, where no more than `cap` bytes may be held (0:
  // all).
  virtual std::uint64_t room_for_vertices(std::uint64_t) const { return ~std::uint64_t{0}; }

  // Whether slices of the next slab are worth sending before this one is simplified; and does so.
  virtual bool takes_slices_early() const { return false; }
  virtual void take_slices(const SliceWindow&, std::int64_t) {}

  // The vertices that the next piece inherits.
  virtual std::uint64_t inherited() const = 0;

  // The state between two slabs: written, and read before the first one. Throws BadInput.
  virtual void serialize(StateWriter& state) const = 0;
  virtual void serialize(StateReader& state) = 0;
};

}  // namespace isoweave
