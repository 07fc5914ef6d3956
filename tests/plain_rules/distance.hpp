// The bound on the distance from the extracted surface: all of it is looked at for every point.
#pragma once

#include <array>
#include <vector>

#include "plain_rules/quadrics.hpp"

namespace isoweave::plain {

struct Surface;

using Triangle = std::array<Vector, 3>;

class Distances {
 public:
  Distances(const Surface& surface, double most);

  // Whether all of a triangle is within the distance of the surface, or a smaller one.
  bool holds(const Triangle& face, double most) const;

 private:
  using List = std::vector<const Triangle*>;

  static bool is_near(const Vector& p, const Triangle& triangle, double most);
  List near_box(const Triangle& part, const List& triangles) const;

  double most_;
  std::vector<Triangle> triangles_;
};

}  // namespace isoweave::plain
