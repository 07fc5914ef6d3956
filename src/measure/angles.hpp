// Angles of triangles, counted one triangle at a time.
#pragma once

#include <limits>

#include "isoweave/measure.hpp"
#include "lattice/triangles.hpp"

namespace isoweave::measure {

// Compares angles by their cotangents, which fall from 0 to 180 degrees. A cotangent takes sums, products, a root and a
// quotient only, so counts are the same on every machine. Degrees are computed at the end.
class AngleSurvey {
 public:
  void add(const TriangleCorners& triangle);
  TriangleAngles result() const;

 private:
  TriangleAngles counts_;
  double largest_cotangent_ = -std::numeric_limits<double>::infinity();
  double least_cotangent_ = std::numeric_limits<double>::infinity();
};

}  // namespace isoweave::measure
