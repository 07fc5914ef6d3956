// Keys, costs and legality: the per-element rules of simplification, shared by every schedule and back end.
//
// All costs here are in units of a0, the mean voxel face: dimensionless, so nothing depends on the unit of length.
#pragma once

#include <cstdint>
#include <cstring>

#include "isoweave/simplify_options.hpp"
#include "parallel/annotations.hpp"
#include "simplify/quadric.hpp"

namespace isoweave {

// A cost as the bits of a non-negative float32: compares as an integer.
using CostBits = std::uint32_t;

inline constexpr CostBits kUnknownCost = 0;            // an end is incomplete: live, and undecidable
inline constexpr CostBits kRetiredCost = 0x7f800000u;  // +infinity: an edge that is never decided
inline constexpr float kCostFloor = 1e-20F;            // lower costs count as this
inline constexpr float kPostponeFactor = 16;           // a smaller factor gives far more rounds on noise
inline constexpr float kPostponeFloor = 2.4e-4F;       // a 64th of a voxel, squared
inline constexpr double kMemory = 0.125;               // weight of the quadrics in a full cost, of 2 in all
inline constexpr double kNormalWeight = 0.25;          // a normal off by 1 counts as half a voxel, squared
inline constexpr int kMaxValence = 24;                 // of a merged vertex
inline constexpr double kSideCosine = 0.2;             // least cosine between a face before and after

ISOWEAVE_HD inline CostBits cost_bits(float cost) {
  CostBits bits = 0;
  memcpy(&bits, &cost, sizeof bits);
  return bits;
}

ISOWEAVE_HD inline float cost_value(CostBits bits) {
  float cost = 0;
  memcpy(&cost, &bits, sizeof cost);
  return cost;
}

ISOWEAVE_HD inline CostBits to_cost(double error) {
  const float cost = static_cast<float>(error);
  return cost_bits(cost <= kCostFloor ? kCostFloor : cost);  // NaN stays NaN, above every limit
}

ISOWEAVE_HD inline CostBits postponed_cost(CostBits cost) {
  const float raised = kPostponeFactor * cost_value(cost);
  return cost_bits(raised > kPostponeFloor ? raised : kPostponeFloor);
}

// How costs become keys. The full cost of an edge is known when the edge is decided. On the surface as it was extracted
// it is about twice the cost of the quadrics at the ends; later it is lower in relation.
struct KeyFactors {
  float first;   // of the quadrics' cost, for edges as they were extracted
  float merged;  // of the quadrics' cost, for edges at a merged vertex
  float limit;   // an edge that is decided goes back when its full cost exceeds its key by this
};

ISOWEAVE_HD inline KeyFactors key_factors(Quality quality) {
  if (quality == Quality::kFast) return {1, 1, 1};
  if (quality == Quality::kNormal) return {2, 1, 2};
  return {2, 0.5F, 1.1F};
}

ISOWEAVE_HD inline CostBits scaled(CostBits cost, float factor) { return cost_bits(factor * cost_value(cost)); }

// Bijective mix of 64 bits (finaliser of SplitMix64, Steele et al., 2014). Ties broken by a hash need far fewer
// rounds on flats than ties broken by position.
ISOWEAVE_HD inline std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

// Whether a face keeps its side and stays a face when its normal, of any length, changes so. A face without area
// imposes nothing.
template <class Real>
ISOWEAVE_HD inline auto keeps_side(const BasicVec3<Real>& before, const BasicVec3<Real>& after) {
  const Real size_before = dot(before, before);
  const Real cosine = dot(before, after);
  return (!(size_before > 0)) |
         ((cosine > 0) & (cosine * cosine > kSideCosine * kSideCosine * size_before * dot(after, after)));
}

}  // namespace isoweave
