// The way of a slab through a device, as the sweep sees it: samples go in, final triangles come out, and the undecided
// zone stays on the device.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "device/final_passes.hpp"
#include "extract/cube_rules.hpp"
#include "extract/extractor.hpp"
#include "simplify/zone_view.hpp"
#include "volume/slice_window.hpp"

namespace isoweave {

struct BulkOptions {
  VolumeInfo volume;
  IsoRule rule;
  bool normals = false;
  ZoneOptions zone;
};

// Triangles that have become final, on the host. Vertices written for the first time come first.
struct FinalPiece {
  std::vector<FinalVertex> vertices;
  std::vector<Point> normals;  // of the new ones; or none
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::size_t new_vertices = 0;
};

// Throws DeviceError when the device fails or has no memory left.
class DeviceEngine {
 public:
  DeviceEngine() = default;
  DeviceEngine(const DeviceEngine&) = delete;
  DeviceEngine& operator=(const DeviceEngine&) = delete;
  virtual ~DeviceEngine() = default;

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

  // Finds the vertices and triangles that have become final. Returns the number of vertices to be written for the first
  // time.
  virtual std::size_t name_final() = 0;

  // Takes out the triangles that name_final() has found, and gives the new vertices consecutive numbers and labels.
  virtual void take_final(std::uint64_t first_output, std::uint32_t first_component, FinalPiece& piece) = 0;

  // Lets the caller replace the labels of the vertices that have been written and are still held.
  virtual void change_components(const std::function<void(std::span<std::uint32_t*>)>& change) = 0;

  virtual std::uint64_t live_triangles() const = 0;  // held, and not collapsed
  virtual std::size_t held_vertices() const = 0;
  virtual std::uint64_t bytes() const = 0;  // held in the memory of the device

  // The number of new vertices, with their triangles, that the device has room for, where at most `cap` bytes of its
  // memory may be held (0: all of it).
  virtual std::uint64_t room_for_vertices(std::uint64_t cap) const = 0;
  virtual std::uint64_t rounds() const = 0;
  virtual const DecisionCounts& decisions() const = 0;
  virtual const SurfaceDefects& defects() const = 0;
  virtual std::uint64_t open_edges() const = 0;
};

}  // namespace isoweave
