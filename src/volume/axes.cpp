#include "volume/axes.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/length_units.hpp"

namespace isoweave {
namespace {

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Fourth powers of lengths and products of all three must be numbers too.
constexpr double kSmallestStep = 1e-30;
constexpr double kLargestStep = 1e30;

bool is_usable_step(double length) { return length >= kSmallestStep && length <= kLargestStep; }

// A unit vector orthogonal to `a`: across the world axis that `a` leans to least.
Vector3 any_normal(const Vector3& a) {
  std::size_t least = 0;
  for (std::size_t axis = 1; axis < 3; ++axis) {
    if (std::abs(a[axis]) < std::abs(a[least])) least = axis;
  }
  Vector3 other{0, 0, 0};
  other[least] = 1;
  return normal_of(a, other);
}

bool all_finite(std::span<const double> numbers) {
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

}  // namespace

double length_of(const Vector3& v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0) || !std::isfinite(largest)) return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  const int exponent = std::ilogb(largest);
  double sum = 0;
  for (const double component : v) {
    const double scaled = std::scalbn(component, -exponent);
    sum += scaled * scaled;
  }
  return std::scalbn(std::sqrt(sum), exponent);
}

void require_usable(const VolumeInfo& volume) {
  const auto refuse = [&](const std::string& expected, const std::string& found) {
    throw std::invalid_argument(volume.path + ": expected " + expected + ", found " + found);
  };
  const Geometry& geometry = volume.geometry;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string of_axis = " on axis " + std::to_string(axis);
    if (volume.dims[axis] <= 0) refuse("1 sample or more" + of_axis, std::to_string(volume.dims[axis]));
    if (!is_usable_step(geometry.spacing[axis])) {
      refuse("a sample spacing from 1e-30 to 1e30" + of_axis, number_text(geometry.spacing[axis]));
    }
  }
  if (!all_finite(geometry.origin)) refuse("a finite origin", "another");
  if (!all_finite(geometry.direction)) refuse("finite directions of the axes", "others");
  if (!std::isfinite(volume.slope) || volume.slope == 0)
    refuse("a finite slope other than 0", number_text(volume.slope));
  if (!std::isfinite(volume.intercept)) refuse("a finite intercept", number_text(volume.intercept));
}

Vector3 normal_of(const Vector3& a, const Vector3& b) {
  Vector3 normal = cross(a, b);
  const double length = length_of(normal);
  if (!(length > 0)) return length_of(a) > 0 ? any_normal(a) : Vector3{0, 0, 1};
  for (double& component : normal) component /= length;
  return normal;
}

void set_geometry(Geometry& geometry, const Axes& axes, std::string_view path, const std::string& source) {
  std::array<Vector3, 3> units{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double length = length_of(axes.steps[axis]);
    const std::string of_axis = " on axis " + std::to_string(axis) + source;
    if (!std::isfinite(length) || !(length > 0)) {
      bad_input(path, "a positive, finite sample spacing" + of_axis, number_text(length));
    }
    if (!is_usable_step(length)) {
      bad_input(path, "a sample spacing from 1e-30 to 1e30" + of_axis, number_text(length));
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
    bad_input(path, "axes that span space" + source, "directions of determinant " + number_text(determinant));
  }
  for (const double coordinate : axes.origin) {
    if (!std::isfinite(coordinate)) bad_input(path, "a finite origin", number_text(coordinate));
  }
  geometry.origin = axes.origin;
}

namespace {

void apply_unit(VolumeInfo& volume, const std::string& text) {
  const std::optional<LengthUnit> unit = find_metric_unit(text);
  if (!unit) throw std::invalid_argument("unit: expected m, mm, um, nm or another length, found '" + text + "'");
  Geometry& geometry = volume.geometry;
  if (!geometry.unit.empty() && (geometry.unit != unit->name || unit->scale != 1)) {
    volume.notes.push_back("the file says that its unit is " + geometry.unit + ", which is taken for " + text);
  }
  for (double& step : geometry.spacing) step *= unit->scale;
  for (double& coordinate : geometry.origin) coordinate *= unit->scale;
  geometry.unit = unit->name;
}

}  // namespace

void require_usable_steps(const std::array<double, 3>& spacing) {
  for (const double step : spacing) {
    if (is_usable_step(step)) continue;
    throw std::invalid_argument("spacing: expected lengths from 1e-30 to 1e30, found " + rounded_text(step));
  }
}

void apply_overrides(VolumeInfo& volume, const OpenOptions& options) {
  Geometry& geometry = volume.geometry;
  if (options.spacing) {
    require_usable_steps(*options.spacing);
    geometry.spacing = *options.spacing;
  }
  if (options.origin) {
    for (const double coordinate : *options.origin) {
      if (!std::isfinite(coordinate)) throw std::invalid_argument("origin must be finite");
    }
    geometry.origin = *options.origin;
  }
  if (!options.unit.empty()) apply_unit(volume, options.unit);
}

double cube_root(double x) {
  int exponent = 0;
  double mantissa = std::frexp(x, &exponent);
  while (exponent % 3 != 0) {
    mantissa *= 2;
    --exponent;
  }
  double root = 1;
  for (int step = 0; step < 8; ++step) root = (2 * root + mantissa / (root * root)) / 3;
  return std::ldexp(root, exponent / 3);
}

double mean_voxel(const Geometry& geometry) {
  return cube_root(geometry.spacing[0] * geometry.spacing[1] * geometry.spacing[2]);
}

}  // namespace isoweave
