// The counts of a written surface where it is not a manifold.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "isoweave/pipeline.hpp"

namespace isoweave {

// Keeps the triangles around locked vertices. Links do not tell how these triangles meet; only all of them together do.
class LockedPart {
 public:
  // Adds a triangle by its vertices' numbers in the output. At least one of these vertices is locked.
  void add(const std::array<std::uint64_t, 3>& numbers, const std::array<bool, 3>& locked);

  // Adds locked vertices, and edges with a locked end, to a report that has all other counts.
  void report(SurfaceReport& report) const;

 private:
  std::vector<std::array<std::uint64_t, 3>> triangles_;
  std::vector<std::uint64_t> locked_;  // numbers, repeated
};

}  // namespace isoweave
