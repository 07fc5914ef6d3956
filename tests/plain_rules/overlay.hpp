// Bounds on the distance of faces from the extracted surface, as they follow from the faces that were there before.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "plain_rules/quadrics.hpp"

namespace isoweave::plain {

inline constexpr unsigned kNoBound = 65535;
inline constexpr unsigned kHalfBound = 32768;

// The faces around the two ends of an edge that is to collapse. Places are measured from the merged vertex.
struct Overlaid {
  struct Face {
    std::array<std::size_t, 3> corners;  // counter-clockwise from an end on
    unsigned bound;
  };

  std::vector<Vector> places;  // first those of the ring, counter-clockwise, then the two ends
  std::vector<Face> faces;     // those of the first end from the second on, then those of the second end alone

  std::size_t ring() const { return places.size() - 2; }
};

// The bounds of the faces around the place, where `most` is the distance that is allowed; none where the faces are not
// seen to lie above each other.
std::optional<std::vector<unsigned>> new_bounds(const Overlaid& before, double most);

}  // namespace isoweave::plain
