// The place of a vertex of dual marching cubes: where it meets the tangent planes of the surface best (Ju et al.,
// 2002).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "extract/cube_rules.hpp"
#include "lattice/vec3.hpp"

namespace isoweave {

// The planes through the crossings of a polygon. Sums go in the order in which crossings are added. Lengths are
// physical.
class TangentPlanes {
 public:
  // A crossing, and the unit normal there, or zero.
  void add(const Vec3& place, const Vec3& normal) {
    places_[size_] = place;
    normals_[size_++] = normal;
    sum_ = sum_ + place;
  }

  Vec3 mean() const { return (1 / static_cast<double>(size_)) * sum_; }

  // The sum of the normals.
  Vec3 normal() const {
    Vec3 sum;
    for (std::size_t n = 0; n < size_; ++n) sum = sum + normals_[n];
    return sum;
  }

  // The place with the least sum of squared distances from the planes. It is pulled to the mean of the crossings, a
  // thousandth as strongly as all planes together, so that there is always one such place (in place of the singular
  // values that Lindstrom, 2000, cuts off).
  Vec3 best() const {
    constexpr double kPull = 1e-3;
    const Vec3 centre = mean();
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
    Vec3 b;
    for (std::size_t n = 0; n < size_; ++n) {
      const Vec3& m = normals_[n];
      xx += m.x * m.x, xy += m.x * m.y, xz += m.x * m.z;
      yy += m.y * m.y, yz += m.y * m.z, zz += m.z * m.z;
      b = b + dot(m, places_[n] - centre) * m;
    }
    const double pull = kPull * (xx + yy + zz);
    if (!(pull > 0)) return centre;
    return centre + solve(xx + pull, xy, xz, yy + pull, yz, zz + pull, b);
  }

 private:
  static constexpr std::size_t kMost = 12;

  // The solution of a positive definite system, by Cholesky's method.
  static Vec3 solve(double xx, double xy, double xz, double yy, double yz, double zz, const Vec3& b) {
    const double l00 = std::sqrt(xx);
    const double l10 = xy / l00, l20 = xz / l00;
    const double l11 = std::sqrt(yy - l10 * l10);
    const double l21 = (yz - l20 * l10) / l11;
    const double l22 = std::sqrt(zz - l20 * l20 - l21 * l21);
    const double u = b.x / l00;
    const double v = (b.y - l10 * u) / l11;
    const double w = (b.z - l20 * u - l21 * v) / l22;
    const double z = w / l22;
    const double y = (v - l21 * z) / l11;
    return {(u - l10 * y - l20 * z) / l00, y, z};
  }

  std::size_t size_ = 0;
  Vec3 places_[kMost];
  Vec3 normals_[kMost];
  Vec3 sum_;
};

// A coordinate in the unit cell, kept off its sides: triangles of neighbouring cells do not fold over each other.
inline double within_cell(double x) { return x > kCrossingMargin ? std::min(x, 1 - kCrossingMargin) : kCrossingMargin; }

}  // namespace isoweave
