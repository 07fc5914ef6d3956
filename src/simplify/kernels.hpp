// The arithmetic of simplification over several edges or faces at once, for the instruction set of this processor.
// Every set gives the same bits.
#pragma once

#include <cstdint>
#include <span>

#include "simplify/face_bounds.hpp"
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

// Rounding, in terms of lengths and areas that are seen from above: what touches a side or a face counts as inside.
inline constexpr double kTouching = 1e-9;

// The least weight of a corner at a point, for quotients. A bound that would have to be larger is of no use.
inline constexpr double kLeastWeight = 1e-6;

// Sides of faces as they are seen from above: two coordinates across, and the height.
struct alignas(64) SeenSides {
  static constexpr std::size_t kRoom = 64;
  static constexpr std::size_t kLanes = 8;  // of the widest vectors

  double x[kRoom], y[kRoom], z[kRoom];                    // where a side begins
  double along_x[kRoom], along_y[kRoom], along_z[kRoom];  // from there to its end
  double bound[kRoom], along_bound[kRoom];                // of the faces beside it, where it begins, and from there
  std::size_t count = 0;

  // bound_from, bound_to: the larger ones of the faces beside it.
  void add(const Vec3& from, const Vec3& to, double bound_from, double bound_to) {
    const Vec3 along = to - from;
    x[count] = from.x;
    y[count] = from.y;
    z[count] = from.z;
    along_x[count] = along.x;
    along_y[count] = along.y;
    along_z[count] = along.z;
    bound[count] = bound_from;
    along_bound[count++] = bound_to - bound_from;
  }

  // Fills the last vectors with sides that cross nothing.
  void pad() {
    while (count % kLanes != 0) add({}, {}, 0, 0);
  }
};

// Triangles as they are seen along a direction: two coordinates across, and the height above or below a face.
struct alignas(64) SeenTriangles {
  static constexpr std::size_t kRoom = 256;

  double x[3][kRoom], y[3][kRoom], height[3][kRoom];  // of the corners
  std::size_t count = 0;

  // Fills the last vectors with triangles that lie over no point, as they have no area.
  void pad() {
    for (std::size_t n = count; n % SeenSides::kLanes != 0; ++n) {
      for (std::size_t corner = 0; corner < 3; ++corner) x[corner][n] = y[corner][n] = height[corner][n] = 0;
      x[1][n] = 1;
    }
  }
};

// A part of the face that triangles are seen from. Its corners go around it to the left.
struct SeenPart {
  double x[3], y[3];  // of the corners
  double centre_x, centre_y;
  double most;                           // height that is allowed
  double slack;                          // of lengths, for rounding: what is as near as that is touched
  double left_x[3], left_y[3], from[3];  // of each side: a direction to its left, and where the side lies along it

  // Finds the centre and the sides of the corners.
  void set_sides() {
    centre_x = (x[0] + x[1] + x[2]) / 3;
    centre_y = (y[0] + y[1] + y[2]) / 3;
    for (std::size_t n = 0; n < 3; ++n) {
      left_x[n] = y[n] - y[(n + 1) % 3];
      left_y[n] = x[(n + 1) % 3] - x[n];
      from[n] = left_x[n] * x[n] + left_y[n] * y[n];
    }
  }

  // How far to the left of a side a point is, in terms of the side's length.
  template <class Real>
  Real left_of(std::size_t side, const Real& px, const Real& py) const {
    return left_x[side] * px + left_y[side] * py - from[side];
  }
};

// How a triangle lies over a part of a face, in bits.
namespace seen {
inline constexpr std::int64_t kTouches = 1;     // its first side touches the part; 2 and 4: its other sides
inline constexpr std::int64_t kOverCentre = 8;  // it lies over the part's centre
}  // namespace seen

// Four points, by coordinates.
struct alignas(32) FourPoints {
  double x[4], y[4], z[4];
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

  // The least bound at the origin, of a side from there to a point with a bound of its own, that makes the side's bound
  // no smaller, wherever it crosses others, than the height between the two and the other one's bound together. 0 where
  // it crosses none.
  double (*bound_of_crossings)(const Vec3& to, double bound, const SeenSides& sides);

  // Which of four points are within a distance of a triangle: bit n is for point n. most: the distance, squared.
  unsigned (*points_within)(double most, const FourPoints& points, const std::array<const Vec3*, 3>& triangle);

  // How each of some triangles lies over a part of a face, in bits of `seen`: 0 where it lies beside the part, or all
  // above or all below what is allowed.
  void (*lie_over)(const SeenTriangles& triangles, const SeenPart& part, std::uint8_t* bits);

  // How many triangles that face up lie over a point, less those that face down.
  int (*count_over)(const SeenTriangles& triangles, double x, double y);
};

// The best kernels for this processor.
const Kernels& kernels();

// All kernels that this processor can run, the best last.
std::span<const Kernels* const> all_kernels();

// The kernels applied to stars.
class VectorArithmetic {
 public:
  static constexpr bool kBoundsDistances = true;

  using Fan = isoweave::Fan;
  using Bounds = FaceBounds;

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
