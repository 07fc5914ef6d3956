// Three coordinates. Every sum is written out, left to right: the order is part of the result.
//
// Real is double, or several doubles at once (simplify/lanes.hpp): the maths is written once for both.
#pragma once

#include <cmath>
#include <type_traits>

#include "parallel/annotations.hpp"

namespace isoweave {

template <class Real>
struct BasicVec3 {
  Real x{}, y{}, z{};
};

using Vec3 = BasicVec3<double>;

template <class Real>
ISOWEAVE_HD inline BasicVec3<Real> operator+(const BasicVec3<Real>& a, const BasicVec3<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <class Real>
ISOWEAVE_HD inline BasicVec3<Real> operator-(const BasicVec3<Real>& a, const BasicVec3<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <class Real>
ISOWEAVE_HD inline BasicVec3<Real> operator*(const std::type_identity_t<Real>& s, const BasicVec3<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}

template <class Real>
ISOWEAVE_HD inline BasicVec3<Real> operator-(const BasicVec3<Real>& a) {
  return {-a.x, -a.y, -a.z};
}

template <class Real>
ISOWEAVE_HD inline Real dot(const BasicVec3<Real>& a, const BasicVec3<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
ISOWEAVE_HD inline BasicVec3<Real> cross(const BasicVec3<Real>& a, const BasicVec3<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// Whether p lies no farther from 0 than the limits say along each axis.
inline bool lies_within(const Vec3& p, const Vec3& limits) {
  return std::abs(p.x) <= limits.x && std::abs(p.y) <= limits.y && std::abs(p.z) <= limits.z;
}

}  // namespace isoweave
