// Quadric error metric (Garland and Heckbert, 1997), kept relative to a moving origin.
//
// Q(x) = x.Ax + 2 b.x + c with x measured from the quadric's origin: a vertex keeps its quadric relative to itself, so
// c is the error at the vertex and nothing depends on how far the vertex lies from the volume's corner.
#pragma once

#include <cmath>

#include "lattice/vec3.hpp"
#include "parallel/annotations.hpp"

namespace isoweave {

template <class Real>
struct BasicQuadric {
  Real xx{}, xy{}, xz{}, yy{}, yz{}, zz{};  // A, symmetric
  BasicVec3<Real> b;
  Real c{};
};

using Quadric = BasicQuadric<double>;

template <class Real>
ISOWEAVE_HD inline BasicVec3<Real> times(const BasicQuadric<Real>& q, const BasicVec3<Real>& v) {
  return {q.xx * v.x + q.xy * v.y + q.xz * v.z, q.xy * v.x + q.yy * v.y + q.yz * v.z,
          q.xz * v.x + q.yz * v.y + q.zz * v.z};
}

template <class Real>
ISOWEAVE_HD inline Real evaluate(const BasicQuadric<Real>& q, const BasicVec3<Real>& x) {
  return dot(x, times(q, x) + 2 * q.b) + q.c;
}

// The same function, measured from an origin moved by d.
template <class Real>
ISOWEAVE_HD inline BasicQuadric<Real> moved(const BasicQuadric<Real>& q, const BasicVec3<Real>& d) {
  BasicQuadric<Real> out = q;
  out.b = q.b + times(q, d);
  out.c = q.c + dot(d, q.b + out.b);
  return out;
}

template <class Real>
ISOWEAVE_HD inline BasicQuadric<Real> operator+(const BasicQuadric<Real>& p, const BasicQuadric<Real>& q) {
  return {p.xx + q.xx, p.xy + q.xy, p.xz + q.xz, p.yy + q.yy, p.yz + q.yz, p.zz + q.zz, p.b + q.b, p.c + q.c};
}

template <class Real>
ISOWEAVE_HD inline BasicQuadric<Real> operator*(double scale, const BasicQuadric<Real>& q) {
  return {scale * q.xx, scale * q.xy, scale * q.xz, scale * q.yy, scale * q.yz, scale * q.zz, scale * q.b, scale * q.c};
}

// scale * (normal . x)^2: a plane through the origin.
template <class Real>
ISOWEAVE_HD inline BasicQuadric<Real> plane_quadric(const BasicVec3<Real>& normal, const Real& scale) {
  const BasicVec3<Real> n = scale * normal;
  return {n.x * normal.x, n.x * normal.y, n.x * normal.z, n.y * normal.y, n.y * normal.z, n.z * normal.z, {}, {}};
}

// Factors of A + pull * I = L D L^T. The pull, a small part of the trace, draws the minimiser to a point given in the
// directions in which the quadric is flat, so that the solve is always well posed.
template <class Real>
struct Factors {
  Real l10, l20, l21, i0, i1, i2, pull;
};

inline constexpr double kPull = 1e-5;

template <class Real>
ISOWEAVE_HD inline Factors<Real> factorise(const BasicQuadric<Real>& q) {
  Factors<Real> f;
  f.pull = kPull * (q.xx + q.yy + q.zz) + 1e-300;
  f.i0 = 1 / (q.xx + f.pull);
  f.l10 = q.xy * f.i0;
  f.l20 = q.xz * f.i0;
  f.i1 = 1 / (q.yy + f.pull - f.l10 * q.xy);
  const Real d21 = q.yz - f.l20 * q.xy;
  f.l21 = d21 * f.i1;
  f.i2 = 1 / (q.zz + f.pull - f.l20 * q.xz - f.l21 * d21);
  return f;
}

template <class Real>
ISOWEAVE_HD inline BasicVec3<Real> solve(const Factors<Real>& f, const BasicVec3<Real>& r) {
  const Real y1 = r.y - f.l10 * r.x;
  const Real y2 = r.z - f.l20 * r.x - f.l21 * y1;
  const Real z = y2 * f.i2;
  const Real y = y1 * f.i1 - f.l21 * z;
  const Real x = r.x * f.i0 - f.l10 * y - f.l20 * z;
  return {x, y, z};
}

// The place where q is least; the pull draws it to `towards`.
template <class Real>
ISOWEAVE_HD inline BasicVec3<Real> minimiser(const BasicQuadric<Real>& q, const Factors<Real>& f,
                                             const BasicVec3<Real>& towards) {
  return solve(f, f.pull * towards - q.b);
}

// Least value of the sum of two quadrics that lie an edge apart, the first at its origin.
template <class Real>
ISOWEAVE_HD inline Real collapse_cost(const BasicQuadric<Real>& first, const BasicQuadric<Real>& second,
                                      const BasicVec3<Real>& edge) {
  const BasicQuadric<Real> q = first + moved(second, -edge);
  return evaluate(q, minimiser(q, factorise(q), 0.5 * edge));
}

}  // namespace isoweave
