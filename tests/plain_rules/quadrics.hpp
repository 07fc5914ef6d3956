// Vectors and quadrics, written a second time: docs/determinism.md says in which order each sum is taken.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace isoweave::plain {

using Vector = std::array<double, 3>;

inline Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector operator*(double s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline double length(const Vector& a) { return std::sqrt(dot(a, a)); }

inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// x.Ax + 2 b.x + c. Of the symmetric A the upper triangle counts.
struct Quadric {
  std::array<Vector, 3> a{};
  Vector b{};
  double c = 0;
};

inline Vector times(const Quadric& q, const Vector& x) {
  return {dot(q.a[0], x), dot({q.a[0][1], q.a[1][1], q.a[1][2]}, x), dot({q.a[0][2], q.a[1][2], q.a[2][2]}, x)};
}

inline double evaluate(const Quadric& q, const Vector& x) { return dot(x, times(q, x) + 2.0 * q.b) + q.c; }

inline Quadric operator+(const Quadric& p, const Quadric& q) {
  return {{p.a[0] + q.a[0], p.a[1] + q.a[1], p.a[2] + q.a[2]}, p.b + q.b, p.c + q.c};
}

inline Quadric operator*(double s, const Quadric& q) {
  return {{s * q.a[0], s * q.a[1], s * q.a[2]}, s * q.b, s * q.c};
}

// The same function of x, where x is measured from a place that is d farther.
inline Quadric moved(const Quadric& q, const Vector& d) {
  Quadric out = q;
  out.b = q.b + times(q, d);
  out.c = q.c + dot(d, q.b + out.b);
  return out;
}

// scale * (normal.x + offset)^2
inline Quadric square(const Vector& normal, double offset, double scale) {
  const Vector n = scale * normal;
  return {{n[0] * normal, n[1] * normal, n[2] * normal}, (scale * offset) * normal, scale * offset * offset};
}

// Solves (A + pull) x = r, where the pull, a 100,000th of the trace, is added along the diagonal.
class Solver {
 public:
  explicit Solver(const Quadric& q) : pull_(1e-5 * (q.a[0][0] + q.a[1][1] + q.a[2][2]) + 1e-300) {
    inverse_[0] = 1 / (q.a[0][0] + pull_);
    lower10_ = q.a[0][1] * inverse_[0];
    lower20_ = q.a[0][2] * inverse_[0];
    inverse_[1] = 1 / (q.a[1][1] + pull_ - lower10_ * q.a[0][1]);
    const double rest = q.a[1][2] - lower20_ * q.a[0][1];
    lower21_ = rest * inverse_[1];
    inverse_[2] = 1 / (q.a[2][2] + pull_ - lower20_ * q.a[0][2] - lower21_ * rest);
  }

  Vector solve(const Vector& r) const {
    const double y1 = r[1] - lower10_ * r[0];
    const double y2 = r[2] - lower20_ * r[0] - lower21_ * y1;
    const double z = y2 * inverse_[2];
    const double y = y1 * inverse_[1] - lower21_ * z;
    return {r[0] * inverse_[0] - lower10_ * y - lower20_ * z, y, z};
  }

  // Where the quadric is least, drawn to a place where it is flat.
  Vector least(const Quadric& q, const Vector& towards) const { return solve(pull_ * towards - q.b); }

 private:
  double pull_, lower10_, lower20_, lower21_;
  std::array<double, 3> inverse_;
};

// The normal at a place as the faces tell it: for each component the weighted sum of gradient.x + offset.
struct NormalQuadric {
  std::array<Vector, 3> gradient{};
  Vector offset{};
  double weight = 0;
};

inline NormalQuadric operator+(const NormalQuadric& p, const NormalQuadric& q) {
  return {{p.gradient[0] + q.gradient[0], p.gradient[1] + q.gradient[1], p.gradient[2] + q.gradient[2]},
          p.offset + q.offset,
          p.weight + q.weight};
}

inline NormalQuadric moved(const NormalQuadric& q, const Vector& d) {
  NormalQuadric out = q;
  for (std::size_t c = 0; c < 3; ++c) out.offset[c] = q.offset[c] + dot(q.gradient[c], d);
  return out;
}

// The quadric of places alone, where the normal is the best one at each place.
inline Quadric with_best_normal(Quadric q, const NormalQuadric& n) {
  for (std::size_t c = 0; c < 3 && n.weight > 0; ++c) q = q + square(n.gradient[c], n.offset[c], -1 / n.weight);
  return q;
}

}  // namespace isoweave::plain
