// What a written surface is where it is not a manifold.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "isoweave/pipeline.hpp"

namespace isoweave {

// Keeps the triangles around locked vertices. Links do not tell how these meet: only all of them do.
class LockedPart {
 public:
  // A triangle by its vertices' numbers in the output, and which of these are locked: one at least.
  void add(const std::array<std::uint64_t, 3>& numbers, const std::array<bool, 3>& locked);

  // Adds locked vertices, and edges with a locked end, to a report that has the counts of the other ones.
  void report(SurfaceReport& report) const;

 private:
  std::vector<std::array<std::uint64_t, 3>> triangles_;
  std::vector<std::uint64_t> locked_;  // numbers, repeated
};

}  // namespace isoweave
