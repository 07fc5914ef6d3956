// The arithmetic of a decision one number after the other, for one thread of a device. Every sum has the order of the
// kernels in lanes, and gives the same bits.
#pragma once

#include <cmath>

#include "simplify/kernels.hpp"

namespace isoweave {

class ScalarArithmetic {
 public:
  static constexpr bool kBoundsDistances = false;

  struct Bounds {};

  // The faces around a vertex, with places measured from the vertex. Slot n holds the face between neighbours n and n +
  // 1.
  class Fan {
   public:
    // Leaves a face out of all later computations.
    ISOWEAVE_HD void drop(std::size_t slot) { dropped_ |= std::uint64_t{1} << slot; }

   private:
    friend class ScalarArithmetic;

    ISOWEAVE_HD bool has(std::size_t slot) const { return (dropped_ >> slot & 1) == 0; }
    ISOWEAVE_HD Vec3 normal(std::size_t slot) const { return cross(to_[slot], to_[slot + 1]); }

    Vec3 to_[Star::kCapacity + 2];  // the last one closes the circle
    std::uint64_t dropped_ = 0;
  };

  ISOWEAVE_HD void measure(const ZoneView& zone, const Star& star, Fan& fan) const {
    const Vec3 centre = zone.vertices[star.vertex].position;
    const std::size_t count = star.count();
    for (std::size_t n = 0; n < count; ++n) fan.to_[n] = zone.vertices[star.neighbour[n]].position - centre;
    fan.to_[count] = fan.to_[star.border ? count - 1 : 0];
    fan.dropped_ = 0;
  }

  ISOWEAVE_HD FaceSums sum_faces(const Fan& fan, std::size_t slots, double weight) const {
    FaceSums sums;
    for (std::size_t n = 0; n < slots; ++n) {
      if (!fan.has(n)) continue;
      const Vec3 normal = fan.normal(n);
      const double size = sqrt(dot(normal, normal));  // twice the area
      sums.planes = sums.planes + plane_quadric(normal, size > 0 ? weight / size : 0);
      sums.normal = sums.normal + normal;
    }
    return sums;
  }

  ISOWEAVE_HD bool keeps_sides(const Fan& fan, std::size_t slots, Vec3 move) const {
    for (std::size_t n = 0; n < slots; ++n) {
      if (!fan.has(n)) continue;
      if (!keeps_side(fan.normal(n), cross(fan.to_[n] - move, fan.to_[n + 1] - move))) return false;
    }
    return true;
  }

  ISOWEAVE_HD int count_common(const Star& a, const Star& b) const {
    int common = 0;
    for (std::size_t n = 0; n < a.count(); ++n) {
      for (std::size_t m = 0; m < b.count(); ++m) common += a.neighbour[n] == b.neighbour[m] ? 1 : 0;
    }
    return common;
  }

  ISOWEAVE_HD void edge_costs(std::span<const EdgeEnds> edges, CostBits* costs) const {
    for (std::size_t n = 0; n < edges.size(); ++n) {
      const Vertex& first = *edges[n].first;
      const Vertex& second = *edges[n].second;
      costs[n] = to_cost(collapse_cost(first.quadric, second.quadric, second.position - first.position));
    }
  }
};

}  // namespace isoweave
