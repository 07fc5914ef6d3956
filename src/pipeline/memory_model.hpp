// The bytes that a run holds: the formula behind forecasts and the memory cap.
//
// The figures per triangle are fits to runs (docs/memory.md has the runs). They hold within a tenth for zones of more
// than some ten thousand triangles.
#pragma once

#include <cstdint>

#include "isoweave/mesh_options.hpp"

namespace isoweave {

// Bytes for normals and values of vertices.
struct VertexExtras {
  std::uint64_t extracted = 0;    // of each vertex on its way from extraction
  std::uint64_t held = 0;         // in the zone
  std::uint64_t slice_bytes = 0;  // of the volume of values
};

VertexExtras vertex_extras(const AttributeOptions& attributes);

struct MemoryModel {
  std::uint64_t resident = 0;  // bytes that the process holds before the run: the program and its libraries
  std::uint64_t slice_bytes = 0;
  std::uint64_t slice_samples = 0;
  int threads = 1;
  bool simplifies = true;
  VertexExtras extras{};
  std::uint64_t levels = 0;  // finer ones
  bool bounded = false;      // distances: the extracted surface around the zone is held as well
  double heavier = 1;        // measured bytes of the zone over those of this formula

  // The bytes that do not grow.
  double fixed() const { return static_cast<double>(resident) + kBuffers + 0.15e6 * threads; }

  // The bytes with a slab of `layers` layers and `triangles` triangles, beside `undecided` triangles held before. The
  // ring has room for `ring` slices, and never shrinks.
  double peak(double layers, double ring, double triangles, double undecided) const {
    return fixed() + slices(layers, ring) + per_new() * triangles + per_held() * (triangles + undecided);
  }

  // The triangles of a slab of so many layers that fit into `bytes`; may be negative.
  double triangles_within(double bytes, double layers, double ring, double undecided) const {
    return (bytes - peak(layers, ring, 0, undecided)) / (per_new() + per_held());
  }

  // The slices in the ring for a slab and for read-ahead.
  static double ring_for(double layers, double ahead, bool normals) { return layers + 1 + ahead + (normals ? 2 : 0); }

  // The bytes of a zone with so many triangles.
  double zone(double triangles) const { return per_held() * triangles; }

 private:
  static constexpr double kBuffers = 6e6;
  static constexpr double kBounded = 250;  // four extracted triangles for each that is held

  double slices(double layers, double ring) const {
    constexpr double kBits = 0.75;  // bytes per sample: inside, crossings along three axes, cells, numbers of vertices
    return ring * static_cast<double>(slice_bytes + extras.slice_bytes) +
           (layers + 1) * kBits * static_cast<double>(slice_samples);
  }

  // The bytes per new triangle on the way from extraction to the zone, or straight to the file.
  double per_new() const { return (simplifies ? 85 : 115) + static_cast<double>(extras.extracted); }

  // The bytes per triangle in the zone, with half a vertex each.
  double per_held() const {
    if (!simplifies) return 0;
    const double extra = static_cast<double>(extras.held) / 2 + 10 * static_cast<double>(levels);
    return heavier * (160 + extra + (bounded ? kBounded : 0));
  }
};

}  // namespace isoweave
