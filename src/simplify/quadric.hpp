// Quadric error metric (Garland and Heckbert, 1997), kept relative to a moving origin.
//
// Q(x) = x.Ax + 2 b.x + c with x measured from the quadric's origin: a vertex keeps its quadric relative to itself, so
// c is the error at the vertex and nothing depends on how far the vertex lies from the volume's corner.
#pragma once

#include <cmath>

#include "parallel/host_device.hpp"
#include "slab/vec3.hpp"

namespace isoweave {

struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  // A, symmetric
  Vec3 b;
  double c = 0;
};

ISOWEAVE_HD inline Vec3 times(const Quadric& q, Vec3 v) {
  return {q.xx * v.x + q.xy * v.y + q.xz * v.z, q.xy * v.x + q.yy * v.y + q.yz * v.z,
          q.xz * v.x + q.yz * v.y + q.zz * v.z};
}

ISOWEAVE_HD inline double evaluate(const Quadric& q, Vec3 x) { return dot(x, times(q, x) + 2 * q.b) + q.c; }

// The same function, measured from an origin moved by d.
ISOWEAVE_HD inline Quadric moved(const Quadric& q, Vec3 d) {
  Quadric out = q;
  out.b = q.b + times(q, d);
  out.c = q.c + dot(d, q.b + out.b);
  return out;
}

ISOWEAVE_HD inline Quadric operator+(const Quadric& p, const Quadric& q) {
  return {p.xx + q.xx, p.xy + q.xy, p.xz + q.xz, p.yy + q.yy, p.yz + q.yz, p.zz + q.zz, p.b + q.b, p.c + q.c};
}

// Adds a plane through the quadric's origin: scale * (normal . x)^2. Planes elsewhere: move the quadric.
ISOWEAVE_HD inline void add_plane(Quadric& q, Vec3 normal, double scale) {
  const Vec3 n = scale * normal;
  q.xx += n.x * normal.x;
  q.xy += n.x * normal.y;
  q.xz += n.x * normal.z;
  q.yy += n.y * normal.y;
  q.yz += n.y * normal.z;
  q.zz += n.z * normal.z;
}

// Factors of A + pull * I = L D L^T. The pull, a small part of the trace, draws the minimiser to a point given in the
// directions in which the quadric is flat, so that the solve is always well posed.
struct Factors {
  double l10, l20, l21, i0, i1, i2, pull;
};

inline constexpr double kPull = 1e-5;

ISOWEAVE_HD inline Factors factorise(const Quadric& q) {
  const double pull = kPull * (q.xx + q.yy + q.zz) + 1e-300;
  Factors f{};
  f.pull = pull;
  f.i0 = 1 / (q.xx + pull);
  f.l10 = q.xy * f.i0;
  f.l20 = q.xz * f.i0;
  f.i1 = 1 / (q.yy + pull - f.l10 * q.xy);
  const double d21 = q.yz - f.l20 * q.xy;
  f.l21 = d21 * f.i1;
  f.i2 = 1 / (q.zz + pull - f.l20 * q.xz - f.l21 * d21);
  return f;
}

ISOWEAVE_HD inline Vec3 solve(const Factors& f, Vec3 r) {
  const double y1 = r.y - f.l10 * r.x;
  const double y2 = r.z - f.l20 * r.x - f.l21 * y1;
  const double z = y2 * f.i2;
  const double y = y1 * f.i1 - f.l21 * z;
  const double x = r.x * f.i0 - f.l10 * y - f.l20 * z;
  return {x, y, z};
}

// Where q is least; `towards` is what the pull draws to.
ISOWEAVE_HD inline Vec3 minimiser(const Quadric& q, const Factors& f, Vec3 towards) {
  return solve(f, f.pull * towards - q.b);
}

}  // namespace isoweave
