// A slab's way through the pipeline, as the sweep drives it: extract, simplify, write. There is one on processors and
// one on a device.
#pragma once

#include <cstdint>
#include <utility>

#include "files/state_file.hpp"
#include "isoweave/pipeline.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

class SlabEngine {
 public:
  SlabEngine() = default;
  SlabEngine(const SlabEngine&) = delete;
  SlabEngine& operator=(const SlabEngine&) = delete;
  virtual ~SlabEngine() = default;

  // Layers not yet extracted.
  virtual std::int64_t layers_left() const = 0;

  // Slices [first, end) that the next `layers` layers read, unclipped.
  virtual std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const = 0;

  // New vertices that memory other than the process's has room for, where no more than `cap` bytes may be held (0:
  // all).
  virtual std::uint64_t room_for_vertices(std::uint64_t) const { return ~std::uint64_t{0}; }

  // The most layers of a slab.
  virtual std::int64_t most_layers() const { return layers_left(); }

  // Extracts the next `layers` layers, whose slices the window holds, or fewer, though at least one, where they would
  // make more than `most_vertices`. Adds what it found to the report, and returns how many layers.
  virtual std::int64_t extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                               MeshReport& report) = 0;

  // Gives the vertices just extracted the values of another volume, whose slices the window holds.
  virtual void take_values(const SliceWindow&) {}

  // Whether slices of the next slab are worth sending before this one is simplified; and does so.
  virtual bool takes_slices_early() const { return false; }
  virtual void take_slices(const SliceWindow&, std::int64_t) {}

  // Decides what can be decided with this slab. Fills in what is held.
  virtual void simplify(SlabRecord& record) = 0;

  // Hands what is final to the sink. Fills in what is still held, and in the report what has been written so far.
  virtual void write(SlabRecord& record, MeshReport& report) = 0;

  // Triangles held over to the next slab, in the memory of the process.
  virtual std::uint64_t held_triangles() const = 0;

  // Bytes of the zone with the last slab, in the memory of the process; 0: not known.
  virtual std::uint64_t zone_bytes() const { return 0; }

  // Held besides in the memory of the process, and growing.
  virtual std::uint64_t other_bytes() const { return 0; }

  // Hands over the triangles held over to the next slab, where they are in the memory of the process.
  virtual void view_undecided(const SweepObserver::Visitor&) const {}

  // Returns when the sink has everything. Throws what it threw.
  virtual void wait_for_sink() = 0;

  // The counters of the whole run.
  virtual void finish(MeshReport& report) const = 0;

  // The state between two slabs.
  virtual void exchange(StateWriter& state) = 0;
  virtual void exchange(StateReader& state) = 0;
};

}  // namespace isoweave
