// How thick the next slab is: a matter of memory and speed, never of the result.
#pragma once

#include <algorithm>
#include <cstdint>

#include "isoweave/volume.hpp"

namespace isoweave {

// What a slab is to hold. Simplification wants all threads busy, at little cost beside what a scan needs elsewhere;
// without it a slab goes through the caches several times.
struct SlabGoal {
  double triangles;
  std::int64_t bytes;           // of its slices
  std::uint64_t most_vertices;  // a slab that turns out to be fuller is cut, where no thickness is asked for
};
inline constexpr SlabGoal kSimplifiedSlab{160000, std::int64_t{8} << 20, 120000};
inline constexpr SlabGoal kFullSlab{30000, std::int64_t{4} << 20, 120000};

// A device wants work for all its threads, and has memory of its own.
inline constexpr SlabGoal kDeviceSlab{4e6, std::int64_t{256} << 20, 3000000};

inline const SlabGoal& slab_goal(bool simplifies, bool device = false) {
  if (device) return kDeviceSlab;
  return simplifies ? kSimplifiedSlab : kFullSlab;
}

// The goal beside a zone that holds so many triangles: each slab has passes over all of them, so it is to bring as
// many.
inline SlabGoal beside_zone(SlabGoal goal, double held) {
  const double factor = std::max(held / goal.triangles, 1.0);
  goal.triangles *= factor;
  goal.most_vertices = static_cast<std::uint64_t>(static_cast<double>(goal.most_vertices) * factor);
  return goal;
}

// Of a memory cap, what slabs are planned for: the formula is not exact, and the next layers may be fuller.
inline constexpr double kUsedPart = 0.8;

// Layers whose slices are worth holding at a time.
inline std::int64_t most_layers(const VolumeInfo& volume, const SlabGoal& goal) {
  const auto bytes = static_cast<std::int64_t>(volume.slice_bytes());
  return std::clamp(goal.bytes / std::max<std::int64_t>(bytes, 1), std::int64_t{4}, std::int64_t{64});
}

// As many layers as hold the triangles wanted.
inline std::int64_t automatic_slab(const VolumeInfo& volume, const SlabGoal& goal, double triangles_per_layer) {
  return std::min(most_layers(volume, goal),
                  static_cast<std::int64_t>(goal.triangles / (triangles_per_layer + 0.01)) + 1);
}

// Layers of the next slab, `recent` after the one before (0: it is the first), which had so many triangles per layer.
// Slabs that are not asked for at most double, as the next layers may be much fuller.
inline std::int64_t next_slab(const VolumeInfo& volume, const SlabGoal& goal, std::int64_t asked, std::int64_t recent,
                              double triangles_per_layer) {
  if (asked > 0) return asked;
  return std::min(recent > 0 ? 2 * recent : 8, automatic_slab(volume, goal, triangles_per_layer));
}

// Slices of the next slab, to be read while one of `layers` layers is worked on.
inline std::int64_t slices_ahead(const VolumeInfo& volume, const SlabGoal& goal, std::int64_t layers) {
  const std::int64_t most = goal.bytes / std::max<std::int64_t>(static_cast<std::int64_t>(volume.slice_bytes()), 1);
  return std::clamp<std::int64_t>(most, 1, layers);
}

}  // namespace isoweave
