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

  // Whether all of a triangle is within the distance of the surface.
  bool holds(const Triangle& face) const;

 private:
  using List = std::vector<const Triangle*>;

  bool is_near(const Vector& p, const Triangle& triangle) const;
  List near_box(const Triangle& part, const List& triangles) const;

  double most_;
  std::vector<Triangle> triangles_;
};

}  // namespace isoweave::plain
