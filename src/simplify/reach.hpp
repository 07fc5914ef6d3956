// The test whether a collapse stays near the extracted surface.
#pragma once

#include <cstdint>

#include "simplify/star.hpp"

namespace isoweave {

// The answer of the test.
enum class Reach : std::uint8_t {
  kWithin,   // every point is within the distance of the extracted surface
  kBeyond,   // some point may not be
  kUnknown,  // what decides it has not been extracted yet
};

// Tests the triangles around the vertex that two neighbours merge into, at `place`. The place must also lie in the
// layers of cells that the stars are in. The zone must have an extracted surface.
Reach reach_of_collapse(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place);

}  // namespace isoweave
