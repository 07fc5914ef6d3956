#include "volume/array_places.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "volume/geometry.hpp"
#include "volume/stack_description.hpp"

namespace isoweave {
namespace {

// Metres of a unit that Geometry knows; 0 for none.
double metres(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 4> kUnits{
      {{"m", 1}, {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}}};
  for (const auto& [name, length] : kUnits) {
    if (name == unit) return length;
  }
  return 0;
}

// A list for the axes of the array, from one for them or for k, j and i; empty for any other.
template <class Value>
std::vector<Value> for_axes(const std::vector<Value>& list, const AxisChoice& choice, const Value& otherwise) {
  if (list.size() == choice.at.size()) return list;
  std::vector<Value> values;
  if (list.size() != choice.axis.size()) return values;
  values.assign(choice.at.size(), otherwise);
  for (std::size_t a = 0; a < choice.axis.size(); ++a) {
    if (choice.axis.at(a) != kNoAxis) values[choice.axis.at(a)] = list[list.size() - 1 - a];
  }
  return values;
}

}  // namespace

AxisPlaces places_of_attributes(const ArrayAttributes& attributes, const AxisChoice& choice) {
  AxisPlaces places;
  const auto take = [&](const std::string& name, double otherwise, std::vector<double>& to) {
    const std::optional<std::vector<double>> list = attributes.numbers(name);
    if (!list) return false;
    to = for_axes(*list, choice, otherwise);
    if (to.empty()) places.notes.push_back("attribute " + name + " has another number of axes and is left out");
    return !to.empty();
  };
  if (take("element_size_um", 1, places.step)) {
    places.units.assign(choice.at.size(), "um");
  } else if (take("resolution", 1, places.step) || take("voxel_size", 1, places.step)) {
    std::vector<std::string> units = attributes.texts("units");
    if (units.empty()) units = attributes.texts("unit");
    if (units.size() == 1) units.assign(choice.at.size(), units[0]);
    places.units = for_axes(units, choice, std::string());
    if (take("offset", 0, places.begin)) {
      places.notes.emplace_back("attribute offset is taken in the unit of the spacing");
    }
  }
  return places;
}

void place_axes(VolumeInfo& info, const AxisChoice& choice, const AxisPlaces& places) {
  info.notes.insert(info.notes.end(), places.notes.begin(), places.notes.end());
  Axes axes;
  std::string unit;
  for (std::size_t a = 0; a < axes.steps.size(); ++a) {
    const std::size_t axis = choice.axis.at(a);
    if (axis == kNoAxis) continue;
    const LengthUnit own = length_unit(axis < places.units.size() ? places.units[axis] : std::string());
    if (!own.note.empty()) info.notes.push_back(own.note);
    if (a == 0) unit = own.unit;
    double scale = own.scale;
    if (own.unit != unit) {
      const bool convertible = metres(own.unit) > 0 && metres(unit) > 0;
      if (convertible) scale *= metres(own.unit) / metres(unit);
      info.notes.push_back("axis " + std::to_string(a) + " is in '" + own.unit + "', axis 0 in '" + unit + "'" +
                           (convertible ? "; all are given in that of axis 0" : ""));
    }
    if (axis < places.step.size()) {
      axes.steps.at(a).at(a) = places.step[axis] * scale;
    } else {
      info.notes.push_back("the spacing of axis " + std::to_string(a) + " is not given and taken as 1");
    }
    if (axis < places.begin.size()) axes.origin.at(a) = places.begin[axis] * scale;
  }
  set_geometry(info.geometry, axes, info.path);
  info.geometry.unit = unit;
}

}  // namespace isoweave
