// The way of a slab through a device, as the sweep sees it: samples go in, final triangles come out, and the undecided
// zone stays on the device.
#pragma once

#include <cstdint>
#include <utility>

#include "extract/cube_rules.hpp"
#include "extract/extractor.hpp"
#include "simplify/final_piece.hpp"
#include "simplify/simplify_totals.hpp"
#include "simplify/zone_part.hpp"
#include "simplify/zone_view.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

struct BulkOptions {
  VolumeInfo volume;
  IsoRule rule;
  bool normals = false;
  ZoneOptions zone;
};

// Throws DeviceError when the device fails or has no memory left.
class DeviceEngine : public FinalSource {
 public:
  virtual VertexNumbering numbering() const = 0;

  virtual std::int64_t layers_left() const = 0;

  // Slices [first, end) that the next `layers` layers read, unclipped.
  virtual std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const = 0;

  // The most layers of a slab whose vertices and triangles can be counted in 32 bits, whatever its samples are.
  virtual std::int64_t most_layers() const = 0;

  // Starts to send the slices that the next `layers` layers read, and returns before they are there. The window holds
  // these slices, as far as the volume goes.
  virtual void upload(const SliceWindow& window, std::int64_t layers) = 0;

  // Extracts the next `layers` layers, which have been uploaded, and adds their triangles to the zone. Extracts fewer
  // layers, though at least one, where all of them would make more than `most_vertices`. Throws OverMemory when the
  // zone would hold 2^30 triangles.
  virtual SlabCounts extract(std::int64_t layers, std::uint64_t most_vertices) = 0;

  // Links the slab to the zone, and gives quadrics and keys to the vertices and edges that are complete now.
  virtual void append() = 0;

  // Decides every edge that can be decided with what has been appended.
  virtual void decide() = 0;

  // The vertices that the next slab inherits: of the extraction, and of the zone.
  virtual std::uint64_t inherited() const = 0;
  virtual std::uint64_t front_size() const = 0;

  // The state between two slabs, as MarchingCubes and Simplifier have it: written, and read before the first slab.
  // Throw BadInput.
  virtual void write_extraction(StateWriter& state) = 0;
  virtual void read_extraction(StateReader& state) = 0;
  virtual void write_zone(StateWriter& state) = 0;
  virtual void read_zone(StateReader& state, const PartShape& shape) = 0;

  virtual std::uint64_t live_triangles() const = 0;  // held, and not collapsed
  virtual std::uint64_t bytes() const = 0;           // held in the memory of the device

  // The number of new vertices, with their triangles, that the device has room for, where at most `cap` bytes of its
  // memory may be held (0: all of it).
  virtual std::uint64_t room_for_vertices(std::uint64_t cap) const = 0;
  virtual std::uint64_t rounds() const = 0;
  virtual const DecisionCounts& decisions() const = 0;
  virtual const SurfaceDefects& defects() const = 0;
};

}  // namespace isoweave
