// How thick the next slab is: thickness changes memory and speed, never the result.
#pragma once

#include <algorithm>
#include <cstdint>

#include "isoweave/volume.hpp"

namespace isoweave {

// The amounts that a slab should hold. Simplification needs enough triangles to keep all threads busy, at little cost
// beside the rest of a run. Without it a slab goes through the caches several times.
struct SlabGoal {
  double triangles;
  std::int64_t bytes;           // of its slices
  std::uint64_t most_vertices;  // a slab that turns out to be fuller is cut, where no thickness is asked for
};
inline constexpr SlabGoal kSimplifiedSlab{160000, std::int64_t{8} << 20, 120000};
inline constexpr SlabGoal kFullSlab{30000, std::int64_t{4} << 20, 120000};

// A device needs work for all its threads, and has memory of its own.
inline constexpr SlabGoal kDeviceSlab{4e6, std::int64_t{256} << 20, 3000000};

inline const SlabGoal& slab_goal(bool simplifies, bool device = false) {
  if (device) return kDeviceSlab;
  return simplifies ? kSimplifiedSlab : kFullSlab;
}

// The goal for a slab beside a zone that holds so many triangles. Every slab costs passes over all of them, and what it
// brings is held beside them: with half as many, memory is three quarters of what it is with as many, for a little
// time.
inline SlabGoal beside_zone(SlabGoal goal, double held) {
  const double factor = std::max(held / 2 / goal.triangles, 1.0);
  goal.triangles *= factor;
  goal.most_vertices = static_cast<std::uint64_t>(static_cast<double>(goal.most_vertices) * factor);
  return goal;
}

// The part of a memory cap that slabs are planned for. The formula is not exact, and the next layers may be fuller.
inline constexpr double kUsedPart = 0.8;

// The number of layers whose slices are worth holding at a time.
inline std::int64_t most_layers(const VolumeInfo& volume, const SlabGoal& goal) {
  const auto bytes = static_cast<std::int64_t>(volume.slice_bytes());
  return std::clamp(goal.bytes / std::max<std::int64_t>(bytes, 1), std::int64_t{4}, std::int64_t{64});
}

// The number of layers that hold the triangles wanted.
inline std::int64_t automatic_slab(const VolumeInfo& volume, const SlabGoal& goal, double triangles_per_layer) {
  return std::min(most_layers(volume, goal),
                  static_cast<std::int64_t>(goal.triangles / (triangles_per_layer + 0.01)) + 1);
}

// The layers of the next slab. The slab before had `recent` layers (0: there was none) with so many triangles per
// layer. A slab whose thickness is not asked for is at most twice as thick as the last one, as the next layers may be
// much fuller.
inline std::int64_t next_slab(const VolumeInfo& volume, const SlabGoal& goal, std::int64_t asked, std::int64_t recent,
                              double triangles_per_layer) {
  if (asked > 0) return asked;
  return std::min(recent > 0 ? 2 * recent : 8, automatic_slab(volume, goal, triangles_per_layer));
}

// The slices of the next slab to be read while a slab of `layers` layers is worked on.
inline std::int64_t slices_ahead(const VolumeInfo& volume, const SlabGoal& goal, std::int64_t layers) {
  const std::int64_t most = goal.bytes / std::max<std::int64_t>(static_cast<std::int64_t>(volume.slice_bytes()), 1);
  return std::clamp<std::int64_t>(most, 1, layers);
}

}  // namespace isoweave
