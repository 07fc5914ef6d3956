#include "volume/geometry.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include "volume/header_text.hpp"
#include "volume/input_file.hpp"

namespace isoweave {
namespace {

double length_of(const Vector3& v) { return std::hypot(v[0], v[1], v[2]); }

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Fourth powers of lengths and products of all three must be numbers too.
constexpr double kSmallestStep = 1e-30;
constexpr double kLargestStep = 1e30;

bool is_usable_step(double length) { return length >= kSmallestStep && length <= kLargestStep; }

// Some unit vector orthogonal to `a`: against the world axis that `a` leans to least.
Vector3 any_normal(const Vector3& a) {
  std::size_t least = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::abs(a[axis]) < std::abs(a[least])) least = axis;
  }
  Vector3 other{0, 0, 0};
  other[least] = 1;
  return normal_of(a, other);
}

}  // namespace

Vector3 normal_of(const Vector3& a, const Vector3& b) {
  Vector3 normal = cross(a, b);
  const double length = length_of(normal);
  if (!(length > 0)) return length_of(a) > 0 ? any_normal(a) : Vector3{0, 0, 1};
  for (double& component : normal) component /= length;
  return normal;
}

void set_geometry(Geometry& geometry, const Axes& axes, std::string_view path) {
  std::array<Vector3, 3> units{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = length_of(axes.steps[axis]);
    if (!std::isfinite(length) || !(length > 0)) {
      bad_input(path, "a positive, finite sample spacing on axis " + std::to_string(axis), number_text(length));
    }
    if (!is_usable_step(length)) {
      bad_input(path, "a sample spacing from 1e-30 to 1e30 on axis " + std::to_string(axis), number_text(length));
    }
    geometry.spacing[axis] = length;
    for (std::size_t row = 0; row < 3; ++row) {
      units[axis][row] = axes.steps[axis][row] / length;
      geometry.direction[3 * row + axis] = units[axis][row];
    }
  }
  constexpr double kFlat = 1e-6;
  const double determinant = dot(cross(units[0], units[1]), units[2]);
  if (!(std::abs(determinant) > kFlat)) {
    bad_input(path, "axes that span space", "directions of determinant " + number_text(determinant));
  }
  for (const double coordinate : axes.origin) {
    if (!std::isfinite(coordinate)) bad_input(path, "a finite origin", number_text(coordinate));
  }
  geometry.origin = axes.origin;
}

void apply_overrides(Geometry& geometry, const OpenOptions& options) {
  if (options.spacing) {
    for (const double step : *options.spacing) {
      if (!std::isfinite(step) || !(step > 0)) throw std::invalid_argument("spacing must be positive and finite");
      if (!is_usable_step(step)) throw std::invalid_argument("spacing must lie between 1e-30 and 1e30");
    }
    geometry.spacing = *options.spacing;
  }
  if (options.origin) {
    for (const double coordinate : *options.origin) {
      if (!std::isfinite(coordinate)) throw std::invalid_argument("origin must be finite");
    }
    geometry.origin = *options.origin;
  }
}

}  // namespace isoweave
