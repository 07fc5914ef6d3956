// The arithmetic of simplification over several edges or faces at once, for the instruction set of this processor.
// Every set gives the same bits.
#pragma once

#include <cstdint>
#include <span>

#include "simplify/star.hpp"

namespace isoweave {

// The ends of an edge, the one with the smaller id first.
struct EdgeEnds {
  const Vertex* first;
  const Vertex* second;
};

// The faces around a vertex, with places measured from the vertex. Slot n holds the face between neighbours n and n +
// 1, and the last slot closes the circle. A slot without a face has a normal of zero.
struct alignas(64) Fan {
  static constexpr std::size_t kRoom = 40;  // 29 neighbours, rounded up to whole vectors, and one vector beyond

  double x[kRoom], y[kRoom], z[kRoom];                       // of the neighbours
  double normal_x[kRoom], normal_y[kRoom], normal_z[kRoom];  // of the faces, twice as long as their area

  // Leaves a face out of all later computations.
  void drop(std::size_t slot) { normal_x[slot] = normal_y[slot] = normal_z[slot] = 0; }
};

// Sums over the faces of a fan, in the order of the slots.
struct FaceSums {
  Quadric planes;  // weighted by size, relative to the fan's vertex
  Vec3 normal;
};

struct Kernels {
  // Costs of collapsing edges.
  void (*edge_costs)(std::span<const EdgeEnds> edges, CostBits* costs);

  // Fills a fan. The list of neighbours must be followed by 8 or more further numbers. For a closed fan they repeat the
  // first neighbour. For an open fan, which has no face between its last neighbour and its first, they repeat the last
  // one.
  void (*measure)(const Vertex* vertices, Vec3 centre, const Index* neighbours, std::size_t count, Fan& fan);

  // Sums the planes of the faces in slots below `slots`, each with a weight of `weight` times twice its area.
  FaceSums (*sum_faces)(const Fan& fan, std::size_t slots, double weight);

  // Whether all faces keep their side when the vertex moves.
  bool (*keeps_sides)(const Fan& fan, std::size_t slots, Vec3 move);

  // Counts the pairs of equal numbers in two lists. b has `count` numbers, and is filled up to a multiple of 16 with
  // numbers that a does not have.
  int (*count_common)(std::span<const Index> a, const Index* b, std::size_t count);
};

// The best kernels for this processor.
const Kernels& kernels();

// All kernels that this processor can run, the best last.
std::span<const Kernels* const> all_kernels();

// The kernels applied to stars.
class VectorArithmetic {
 public:
  using Fan = isoweave::Fan;

  // Fills the fan of a star that is not too large.
  void measure(const ZoneView& zone, Star& star, Fan& fan) const {
    star.pad(star.neighbour[star.border ? star.count() - 1 : 0]);
    kernels_.measure(zone.vertices.data(), zone.vertices[star.vertex].position, star.neighbour.data(), star.count(),
                     fan);
  }

  FaceSums sum_faces(const Fan& fan, std::size_t slots, double weight) const {
    return kernels_.sum_faces(fan, slots, weight);
  }

  bool keeps_sides(const Fan& fan, std::size_t slots, Vec3 move) const {
    return kernels_.keeps_sides(fan, slots, move);
  }

  // The number of neighbours that two stars have in common.
  int count_common(const Star& a, Star& b) const {
    b.pad(kNone);
    return kernels_.count_common({a.neighbour.data(), a.count()}, b.neighbour.data(), b.count());
  }

  void edge_costs(std::span<const EdgeEnds> edges, CostBits* costs) const { kernels_.edge_costs(edges, costs); }

 private:
  const Kernels& kernels_ = kernels();
};

}  // namespace isoweave
