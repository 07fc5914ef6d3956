// Whether extracted triangles lie over a face everywhere, and near it, as they are seen along its normal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "lattice/triangles.hpp"
#include "lattice/vec3.hpp"
#include "simplify/kernels.hpp"

namespace isoweave {

// Extracted triangles around a face, as they lie above and below it.
//
// Why covers() can tell that a part of the face is covered without cutting it into the parts over each triangle: take
// the triangles that lie over the part within a height, count each side of them as +1 in one direction and -1 in the
// other, and drop those that do not touch the part. If all sums are 0, the triangles that lie over a point, those that
// face down counted as -1, are as many over every point of the part: the number changes only where a side of one is
// passed whose count is not 0 (the degree of a map, Milnor, 1965). So it suffices to count them over one point.
class ProjectedSurface {
 public:
  using Corners = measure::TriangleCorners;

  // Looks along the normal of a face, at no triangles yet. Returns false for a face that is next to nothing across.
  bool look_at(const Corners& face);

  // Forgets the triangles.
  void clear() { triangles_.count = 0; }

  // Adds a triangle. Returns false where there is no more room.
  bool add(const Vec3& a, const Vec3& b, const Vec3& c);

  // Whether each point of a part of the face is seen to have a point of some triangle no farther above or below it than
  // `most`. The corners of the part must go around it as those of the face do. All triangles must have been added that
  // come within that height of the part, once. More do not change the answer, nor does their order.
  bool covers(const Corners& part, double most);

 private:
  // The bits of two coordinates of one end and of the other.
  using Side = std::array<std::uint64_t, 4>;

  struct Corner {
    std::array<double, 3> left{};  // how far it is to the left of each side of a part
    double height = 0;
  };

  // A triangle, or what of it lies over a part.
  struct Polygon {
    static constexpr std::size_t kMostCorners = 6;  // a triangle, cut three times

    // Rounding may find more corners than there are: the last place stands for all of them.
    void add(const Corner& corner) { corners[count < kMostCorners ? count++ : kMostCorners - 1] = corner; }
    Polygon left_of(std::size_t side) const;

    std::array<Corner, kMostCorners> corners;
    std::size_t count = 0;
  };

  SeenPart seen_part(const Corners& corners, double most) const;
  bool is_high(std::size_t triangle, const SeenPart& part) const;
  void add_side(std::size_t triangle, std::size_t from, std::size_t to);

  const Kernels& kernels_ = kernels();
  measure::Vector origin_{}, across_{}, along_{}, up_{};
  SeenTriangles triangles_;
  std::size_t open_count_ = 0;
  std::array<Side, 3 * SeenTriangles::kRoom> open_;  // sides with no counterpart in the other direction
};

}  // namespace isoweave
