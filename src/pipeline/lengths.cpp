#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "files/from_chars.hpp"
#include "files/length_units.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave {
namespace {

constexpr double kShapePart = 0.05;  // of a diagonal

// The length of `value` of the suffix's unit, in the other unit. Nothing where one of the units is not known. An input
// without a unit is in mm.
std::optional<double> converted(double value, std::string_view suffix, std::string_view unit) {
  const std::optional<LengthUnit> length = find_length_unit(suffix);
  if (!length) return std::nullopt;
  return unit_in(LengthUnit{value * length->scale, length->name}, unit_or_usual(unit));
}

double diagonal_of(const std::array<double, 3>& sides) {
  double squared = 0;
  for (const double side : sides) squared += side * side;
  return std::sqrt(squared);
}

}  // namespace

Length parse_length(std::string_view text, std::string_view unit, std::optional<double> diagonal) {
  constexpr double kPercent = 0.01;
  double value = 0;
  const auto [end, failed] = number_from_chars(text.data(), text.data() + text.size(), value);
  const std::string_view suffix(end, static_cast<std::size_t>(text.data() + text.size() - end));
  const bool plain = suffix.empty() || suffix == "vox";
  const bool part = suffix == "%" && diagonal;
  const std::optional<double> length = plain  ? value
                                       : part ? value * kPercent * *diagonal
                                              : converted(value, suffix, unit);
  if (failed != std::errc{} || !(value >= 0) || std::isinf(value) || !length) {
    throw std::invalid_argument("length '" + std::string(text) +
                                "': expected a number of 0 or more and vox, mm, um, nm, in" + (diagonal ? ", %" : "") +
                                " or nothing");
  }
  return {*length, suffix == "vox"};
}

double box_diagonal(const VolumeInfo& volume) {
  std::array<double, 3> sides{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sides[axis] = volume.geometry.spacing[axis] * static_cast<double>(volume.dims[axis]);
  }
  return diagonal_of(sides);
}

double box_diagonal(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  std::array<double, 3> sides{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::ranges::minmax(mesh.vertices, {}, [&](const Point& p) { return p[axis]; });
    sides[axis] = double{high[axis]} - double{low[axis]};
  }
  return diagonal_of(sides);
}

double most_shape_error(const VolumeInfo& volume) { return kShapePart * box_diagonal(volume); }

double most_shape_error(const TriangleMesh& mesh) { return kShapePart * box_diagonal(mesh); }

}  // namespace isoweave
