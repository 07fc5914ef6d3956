// The per-element rules of extraction, shared by every back end: which samples are inside, and where crossings lie.
#pragma once

#include <cmath>
#include <cstdint>

#include "parallel/annotations.hpp"

namespace isoweave {

// The surface asked for, in stored sample units.
struct IsoRule {
  double iso = 0;
  bool above = true;   // inside: sample >= iso; else: sample <= iso. NaN is outside.
  bool closed = true;  // one virtual layer of outside samples surrounds the volume
};

// Crossings keep this distance, in samples, from the lattice points: no degenerate triangles, no snapping.
inline constexpr double kCrossingMargin = 1.0 / 256;

// The part of the way from f0 to f1 at which iso lies. Where the difference is beyond the largest number, it is taken
// of the halves: the quotient is 0 or no number then, and hardly ever otherwise.
ISOWEAVE_HD inline double part_between(double f0, double f1, double iso) {
  const double part = (iso - f0) / (f1 - f0);
  if (part < 0 || part > 0) return part;
  return (iso / 2 - f0 / 2) / (f1 / 2 - f0 / 2);
}

// The place along a lattice edge from f0 to f1 where the surface crosses it, in [1/256, 255/256]. A sample outside the
// volume is given as NaN. Beside a NaN the surface hugs the inside sample.
ISOWEAVE_HD inline double crossing_parameter(double f0, double f1, double iso, bool inside0) {
  const double t = part_between(f0, f1, iso);
  if (t != t) return inside0 ? kCrossingMargin : 1 - kCrossingMargin;
  if (t < kCrossingMargin) return kCrossingMargin;
  if (t > 1 - kCrossingMargin) return 1 - kCrossingMargin;
  return t;
}

// The case of the cell whose corner 0 is bit `bit` of the sample row words given: rows (j, k), (j+1, k), (j, k+1),
// (j+1, k+1). Each pair holds the bits at x and x + 1 in its two lowest bits.
ISOWEAVE_HD inline std::uint32_t cell_case(std::uint32_t pair00, std::uint32_t pair10, std::uint32_t pair01,
                                           std::uint32_t pair11) {
  return pair00 | pair10 << 2 | pair01 << 4 | pair11 << 6;
}

}  // namespace isoweave
