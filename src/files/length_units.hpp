// Units of length as headers spell them, and axes whose units differ made one.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isoweave {

// A unit that meshes and volumes are given in (m, mm, um, nm or in), and the factor from another unit to it: a
// centimetre is 10 mm, a foot 12 in.
struct LengthUnit {
  double scale = 1;
  std::string_view name;
};

// Any spelling of a unit of length: capitals, blanks around it, singular or plural, the micro sign in any of its forms.
// Nothing for pixels and whatever else is no length.
std::optional<LengthUnit> find_length_unit(std::string_view text);

// The metric unit of a text; inches become millimetres. Volumes are given in metric units only.
std::optional<LengthUnit> find_metric_unit(std::string_view text);

// The number of units `other` in one `unit`. Nothing unless both names are among those of LengthUnit.
std::optional<double> unit_in(const LengthUnit& unit, std::string_view other);
std::optional<double> unit_in(std::string_view unit, std::string_view other);

// The unit that lengths of an unknown one are in.
inline constexpr std::string_view kUnitOfNone = "mm";
inline std::string_view unit_or_usual(std::string_view unit) { return unit.empty() ? kUnitOfNone : unit; }

// The factors that bring the numbers of three axes into one unit.
struct CommonUnit {
  std::string unit;  // one that Geometry knows; empty where no axis has a known one
  std::array<double, 3> scale{1, 1, 1};
  std::vector<std::string> notes;
  std::string conflict;  // the units found, where they cannot be made one
};

// The unit of the first axis that has a known one. An axis of nothing plays no part; one whose unit is empty counts as
// in the unit of the others, with a note.
CommonUnit common_unit(const std::array<std::optional<std::string>, 3>& texts);

}  // namespace isoweave
