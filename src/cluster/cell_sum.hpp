// The sum of a cell: the planes of the triangles that have corners in it, as one quadric (Lindstrom, 2000).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "lattice/vec3.hpp"
#include "simplify/quadric.hpp"

namespace isoweave {

// A triangle: its unit normal, and a third of its area, which is the weight of each corner.
struct WeighedPlane {
  Vec3 normal;
  double weight = 0;  // 0: without area, and without a normal

  explicit WeighedPlane(const std::array<Vec3, 3>& corners) {
    const Vec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double twice = std::sqrt(dot(across, across));
    if (!(twice > 0)) return;
    normal = (1 / twice) * across;
    weight = twice / 6;
  }
};

// Sums in the order in which corners are added. All places are relative to the middle of the cell.
struct CellSum {
  Quadric planes;
  Vec3 corners;  // each with its weight

  void add(const WeighedPlane& plane, const Vec3& corner) {
    const double before = dot(plane.normal, corner);
    Quadric quadric = plane_quadric(plane.normal, plane.weight);
    quadric.b = (-plane.weight * before) * plane.normal;
    quadric.c = plane.weight * before * before;
    planes = planes + quadric;
    corners = corners + plane.weight * corner;
  }

  // The weight of all corners: the trace, as normals have length 1.
  double weight() const { return planes.xx + planes.yy + planes.zz; }

  // The place with the least sum of squared distances from the planes. It is pulled to the mean of the corners, a
  // thousandth as strongly as all planes together: there is always one such place, and on a flat it is that mean. The
  // pull is in place of the singular values that Lindstrom cuts off.
  Vec3 best() const {
    constexpr double kStrength = 1e-3 - kPull;  // the rest is in the factors
    if (!(weight() > 0)) return {};
    const Vec3 mean = (1 / weight()) * corners;
    const double pull = kStrength * weight();
    Quadric pulled = planes;
    pulled.xx += pull;
    pulled.yy += pull;
    pulled.zz += pull;
    pulled.b = pulled.b - pull * mean;
    return minimiser(pulled, factorise(pulled), mean);
  }
};

}  // namespace isoweave
