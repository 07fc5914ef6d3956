#include "measure/orientation.hpp"

#include <array>
#include <cmath>

#include "lattice/triangles.hpp"

namespace isoweave::measure {
namespace {

constexpr double kEpsilon = 0x1p-53;  // half a unit in the last place of 1

// Shewchuk's bounds A on the error of the determinants below, for coordinates that are doubles.
constexpr double kBoundInSpace = (7 + 56 * kEpsilon) * kEpsilon;
constexpr double kBoundInPlane = (3 + 16 * kEpsilon) * kEpsilon;

int sign_of(double x) { return (x > 0) - (x < 0); }

// A sum of doubles without rounding: parts that do not overlap, smallest first (Shewchuk's GROW-EXPANSION).
//
// Products of three float32 are multiples of 2^-447 and below 2^384, so nothing here over- or underflows.
class ExactSum {
 public:
  void add(double term) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double sum = term + parts_[i];
      const double of_part = sum - term;  // Knuth's two-sum: what rounding took away
      const double rest = (term - (sum - of_part)) + (parts_[i] - of_part);
      if (rest != 0) parts_[kept++] = rest;
      term = sum;
    }
    if (term != 0) parts_[kept++] = term;
    count_ = kept;
  }

  // Adds x y z. The product of two float32 is a double; of that, halves of 26 bits times a third are doubles (Dekker).
  void add_product(float x, float y, double z) {
    const double product = double{x} * double{y};
    const double spread = 0x1.000002p27 * product;
    const double high = spread - (spread - product);
    add(high * z);
    add((product - high) * z);
  }

  // The sign of the largest part, as all others together are smaller.
  int sign() const { return count_ == 0 ? 0 : sign_of(parts_[count_ - 1]); }

 private:
  std::array<double, 48> parts_{};  // as many as terms, at most
  std::size_t count_ = 0;
};

// Adds the determinant of three points as columns, times `factor`.
void add_determinant(ExactSum& sum, double factor, const Point& p, const Point& q, const Point& r) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3;
    const std::size_t last = (axis + 2) % 3;
    sum.add_product(p[axis], q[next], factor * double{r[last]});
    sum.add_product(p[axis], q[last], -factor * double{r[next]});
  }
}

// The sign from 24 products. Differences of coordinates would not be doubles.
int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  ExactSum sum;
  add_determinant(sum, 1, b, c, d);
  add_determinant(sum, -1, a, c, d);
  add_determinant(sum, 1, a, b, d);
  add_determinant(sum, -1, a, b, c);
  return sum.sign();
}

int exact_orientation_along(std::size_t axis, const Point& a, const Point& b, const Point& c) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  ExactSum sum;
  const auto add_cross = [&](const Point& p, const Point& q) {
    sum.add(double{p[u]} * double{q[v]});
    sum.add(-double{p[v]} * double{q[u]});
  };
  add_cross(a, b);
  add_cross(b, c);
  add_cross(c, a);
  return sum.sign();
}

}  // namespace

int orientation(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Vector apex = vector_of(a);
  const Vector p = vector_of(b) - apex;
  const Vector q = vector_of(c) - apex;
  const Vector r = vector_of(d) - apex;
  double determinant = 0;
  double magnitude = 0;  // the same with all terms positive
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t next = (axis + 1) % 3;
    const std::size_t last = (axis + 2) % 3;
    const double positive = p[next] * q[last];
    const double negative = p[last] * q[next];
    determinant += (positive - negative) * r[axis];
    magnitude += (std::abs(positive) + std::abs(negative)) * std::abs(r[axis]);
  }
  // Where the magnitude is 0, every product has a factor that is exactly 0.
  if (std::abs(determinant) > kBoundInSpace * magnitude || magnitude == 0) return sign_of(determinant);
  return exact_orientation(a, b, c, d);
}

int orientation_along(std::size_t axis, const Point& a, const Point& b, const Point& c) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  const double positive = (double{b[u]} - double{a[u]}) * (double{c[v]} - double{a[v]});
  const double negative = (double{b[v]} - double{a[v]}) * (double{c[u]} - double{a[u]});
  const double determinant = positive - negative;
  const double magnitude = std::abs(positive) + std::abs(negative);
  if (std::abs(determinant) > kBoundInPlane * magnitude || magnitude == 0) return sign_of(determinant);
  return exact_orientation_along(axis, a, b, c);
}

}  // namespace isoweave::measure
