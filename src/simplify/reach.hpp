// The test whether a collapse stays near the extracted surface.
#pragma once

#include <cstdint>

#include "simplify/face_bounds.hpp"
#include "simplify/star.hpp"

namespace isoweave {

// The answer of the test.
enum class Reach : std::uint8_t {
  kWithin,   // every point is within the distance of the extracted surface
  kUnknown,  // what decides it has not been extracted yet
  kBeyond,   // some point may not be within it
};

// Tests the faces around the vertex that two neighbours merge into, at `place`, and bounds them. The place must also
// lie in the layers of cells that the stars are in. The zone must have an extracted surface. bounds: where kWithin is
// answered, those of the faces that stay. cost: that of the edge, which says only whether a few points of the faces are
// to be looked at first.
Reach reach_of_collapse(const ZoneView& zone, const Star& u, const Star& v, const Vec3& place, CostBits cost,
                        FaceBounds& bounds);

}  // namespace isoweave
