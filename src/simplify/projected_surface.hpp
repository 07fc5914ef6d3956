// Whether extracted triangles lie over a face everywhere, and near it, as they are seen along its normal.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "lattice/triangles.hpp"
#include "lattice/vec3.hpp"
#include "simplify/kernels.hpp"

namespace isoweave {

// Extracted triangles around a face, as they lie above and below it.
//
// Why they can tell that a part of the face is covered without a look at each: take triangles all of which are near
// what they lie over, count each side of them as +1 in one direction and -1 in the other, and drop those that do not
// touch the part. If all sums are 0, the triangles that lie over a point, those that face down counted as -1, are as
// many over every point of the part: the number changes only where a side of one is passed whose count is not 0 (the
// degree of a map, Milnor, 1965). So it suffices to count them over one point.
class ProjectedSurface {
 public:
  using Corners = measure::TriangleCorners;

  // Looks along the normal of a face, at no triangles yet. Returns false for a face that is next to nothing across.
  bool look_at(const Corners& face);

  // Forgets the triangles.
  void clear() { triangles_.count = 0; }

  // Adds a triangle. Returns false where there is no more room.
  bool add(const Vec3& a, const Vec3& b, const Vec3& c);

  // Keeps the triangles that lie over a part of the face, and all of whose points there are within the distance `most`
  // of the part's points below or above them. Returns whether each point of the part has one of them. The corners of
  // the part must go around it as those of the face do. All triangles must have been added that come within that height
  // of the part, once. More do not change the answer, nor does their order. farthest: raised to the greatest such
  // distance, which bounds that of all points that have a triangle.
  bool survey(const Corners& part, double most, double& farthest);

  // Whether each point of a smaller part, of the one that was surveyed, has one of these triangles.
  bool covers(const Corners& part) const;

  // A point of the surveyed part that is not within the distance of a triangle over it, where there is one.
  const std::optional<measure::Vector>& far_point() const { return far_point_; }

 private:
  // The bits of two coordinates of one end and of the other, the smaller bits first.
  using Side = std::array<std::uint64_t, 4>;

  struct Corner {
    std::array<double, 3> left{};  // how far it is to the left of each side of a part
    double x = 0, y = 0, height = 0;
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
  double highest(std::size_t triangle) const;
  Polygon polygon_over(std::size_t triangle, const SeenPart& part) const;
  bool is_near(std::size_t triangle, const SeenPart& part, double& farthest);
  void keep_near(const SeenPart& part, std::uint8_t* bits, double& farthest);
  void list_open_sides(const std::uint8_t* bits);
  std::size_t number_of(const Side& side);
  void count_side(std::size_t triangle, std::size_t from, std::size_t to);
  static bool touches(const Side& side, const SeenPart& part);

  const Kernels& kernels_ = kernels();
  measure::Vector origin_{}, across_{}, along_{}, up_{};
  SeenTriangles triangles_;
  std::optional<measure::Vector> far_point_;
  static constexpr std::size_t kMostSides = 3 * SeenTriangles::kRoom;
  static constexpr int kSlotBits = 10;
  static_assert(std::size_t{1} << kSlotBits > kMostSides, "some slots stay free");
  std::array<Side, kMostSides> sides_;
  std::array<int, kMostSides> counts_;  // in one direction, less those in the other
  std::size_t side_count_ = 0;
  std::array<std::uint16_t, std::size_t{1} << kSlotBits> slots_;  // a hash table: the number of a side and 1, or 0
  std::size_t open_count_ = 0;                                    // sides whose counts are not 0, which come first
};

}  // namespace isoweave
