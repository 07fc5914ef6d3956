// Where the vertices lie that the triangles of a slab name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "lattice/vec3.hpp"

namespace isoweave {

// The places of inherited vertices, whose numbers come first, and of new ones. There is no branch between the two, as
// it could not be predicted.
class VertexPlaces {
 public:
  VertexPlaces(std::span<const Vec3> inherited, const Vec3* added)
      : first_{0, static_cast<std::uint32_t>(inherited.size())}, places_{inherited.data(), added} {}

  const Vec3& operator()(std::uint32_t number) const {
    const std::size_t is_new = number >= first_[1] ? 1 : 0;
    return places_[is_new][number - first_[is_new]];
  }

 private:
  std::array<std::uint32_t, 2> first_;  // number of each kind
  std::array<const Vec3*, 2> places_;
};

}  // namespace isoweave
