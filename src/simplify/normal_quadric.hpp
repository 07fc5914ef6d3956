// Quadric over position and normal (Hoppe, 1999: attributes that are linear over each face).
//
// Over a face every component of the normal is a linear function of position, gradient . x + offset. A vertex at x with
// a normal s has the error of its position and, for each component, weight * (gradient . x + offset - s)^2, summed over
// the faces. The terms without s are added to the quadric of the vertex, and this class has the rest. The best s at a
// given x is a weighted mean, so a quadric over position alone is left to be minimised.
#pragma once

#include "parallel/annotations.hpp"
#include "simplify/quadric.hpp"

namespace isoweave {

// Sums over faces, measured from the same origin as the quadric they belong to.
struct NormalQuadric {
  Vec3 gradient[3];  // of each component, times the weight
  Vec3 offset;       // of the components, times the weight
  double weight = 0;
};

// The same function, measured from an origin moved by d.
ISOWEAVE_HD inline NormalQuadric moved(const NormalQuadric& q, const Vec3& d) {
  NormalQuadric out = q;
  out.offset = q.offset + Vec3{dot(q.gradient[0], d), dot(q.gradient[1], d), dot(q.gradient[2], d)};
  return out;
}

ISOWEAVE_HD inline NormalQuadric operator+(const NormalQuadric& p, const NormalQuadric& q) {
  return {{p.gradient[0] + q.gradient[0], p.gradient[1] + q.gradient[1], p.gradient[2] + q.gradient[2]},
          p.offset + q.offset,
          p.weight + q.weight};
}

// scale * (a . x + b)^2
ISOWEAVE_HD inline Quadric square_of(const Vec3& a, double b, double scale) {
  Quadric q = plane_quadric(a, scale);
  q.b = scale * b * a;
  q.c = scale * b * b;
  return q;
}

// The least value, over all normals, of a quadric over position and normal: a quadric over position.
ISOWEAVE_HD inline Quadric with_best_normal(const Quadric& q, const NormalQuadric& n) {
  if (!(n.weight > 0)) return q;
  const double offsets[3] = {n.offset.x, n.offset.y, n.offset.z};
  Quadric left = q;
  for (int c = 0; c < 3; ++c) left = left + square_of(n.gradient[c], offsets[c], -1 / n.weight);
  return left;
}

// Adds a face that has corners at 0, a and b and normals there, weighted by `weight` in all.
ISOWEAVE_HD inline void add_face(const Vec3& a, const Vec3& b, const Vec3 normals[3], double weight, Quadric& q,
                                 NormalQuadric& n) {
  const Vec3 across = cross(a, b);
  const double squared = dot(across, across);
  const Vec3 along_a = (1 / squared) * cross(b, across);  // grows by 1 from 0 to a, and stays from 0 to b
  const Vec3 along_b = (1 / squared) * cross(across, a);
  const double here[3] = {normals[0].x, normals[0].y, normals[0].z};
  const double at_a[3] = {normals[1].x, normals[1].y, normals[1].z};
  const double at_b[3] = {normals[2].x, normals[2].y, normals[2].z};
  for (int c = 0; c < 3; ++c) {
    const Vec3 gradient = (at_a[c] - here[c]) * along_a + (at_b[c] - here[c]) * along_b;
    q = q + square_of(gradient, here[c], weight);
    n.gradient[c] = n.gradient[c] + weight * gradient;
  }
  n.offset = n.offset + weight * normals[0];
  n.weight += weight;
}

// Least value of the sum of two quadrics over position and normal that lie an edge apart, the first at its origin.
ISOWEAVE_HD inline double collapse_cost(const Quadric& first, const NormalQuadric& first_normal, const Quadric& second,
                                        const NormalQuadric& second_normal, const Vec3& edge) {
  const Quadric q = with_best_normal(first + moved(second, -edge), first_normal + moved(second_normal, -edge));
  return evaluate(q, minimiser(q, factorise(q), 0.5 * edge));
}

}  // namespace isoweave
