#include "volume/formats/chunked/array_places.hpp"

#include <array>
#include <utility>

#include "files/length_units.hpp"
#include "volume/axes.hpp"

namespace isoweave {
namespace {

// A list for the axes of the array, from one for them or for k, j and i; empty for any other.
template <class Value>
std::vector<Value> for_axes(const std::vector<Value>& list, const AxisChoice& choice, const Value& otherwise) {
  if (list.size() == choice.at.size()) return list;
  std::vector<Value> values;
  if (list.size() != choice.axis.size()) return values;
  values.assign(choice.at.size(), otherwise);
  for (std::size_t a = 0; a < choice.axis.size(); ++a) {
    if (choice.place.at(a) != kNoAxis) values[choice.place.at(a)] = list[list.size() - 1 - a];
  }
  return values;
}

struct ListOfAxes {
  const ArrayAttributes& attributes;
  const AxisChoice& choice;
  std::string name;
  double otherwise;
};

// Takes an attribute of a number for each axis. Returns whether there is one.
bool take_list(AxisPlaces& places, const ListOfAxes& list, std::vector<double>& to) {
  const std::optional<std::vector<double>> numbers = list.attributes.numbers(list.name);
  if (!numbers) return false;
  to = for_axes(*numbers, list.choice, list.otherwise);
  if (to.empty()) places.notes.push_back("attribute " + list.name + " has another number of axes and is left out");
  return !to.empty();
}

}  // namespace

AxisPlaces places_of_attributes(const ArrayAttributes& attributes, const AxisChoice& choice) {
  AxisPlaces places;
  const auto take = [&](const std::string& name) {
    return take_list(places, {attributes, choice, name, 1}, places.step);
  };
  if (take("element_size_um")) {
    places.units.assign(choice.at.size(), "um");
  } else if (take("resolution") || take("voxel_size")) {
    std::vector<std::string> units = attributes.texts("units");
    if (units.empty()) units = attributes.texts("unit");
    if (units.size() == 1) units.assign(choice.at.size(), units[0]);
    places.units = for_axes(units, choice, std::string());
  }
  return places;
}

void take_offset(AxisPlaces& places, const ArrayAttributes& attributes, const AxisChoice& choice) {
  if (!take_list(places, {attributes, choice, "offset", 0}, places.begin)) return;
  if (places.step.empty()) {
    places.begin.clear();
    places.notes.emplace_back("attribute offset has no spacing beside it and is left out");
  } else {
    places.notes.emplace_back("attribute offset is taken in the unit of the spacing");
  }
}

void place_axes(OpenedVolume& volume, const AxisChoice& choice, const AxisPlaces& places) {
  VolumeInfo& info = volume.info;
  info.notes.insert(info.notes.end(), places.notes.begin(), places.notes.end());
  std::array<std::optional<std::string>, 3> texts;
  for (std::size_t a = 0; a < texts.size(); ++a) {
    const std::size_t axis = choice.place.at(a);
    if (axis < places.step.size()) texts.at(a) = axis < places.units.size() ? places.units[axis] : std::string();
  }
  const CommonUnit unit = common_unit(texts);
  take_unit(volume, unit);
  Axes axes;
  for (std::size_t a = 0; a < axes.steps.size(); ++a) {
    const std::size_t axis = choice.place.at(a);
    if (axis == kNoAxis) continue;
    if (axis < places.step.size()) {
      axes.steps.at(a).at(a) = places.step[axis] * unit.scale.at(a);
    } else {
      info.notes.push_back("the spacing of axis " + std::to_string(a) + " is not given and taken as 1");
    }
    if (axis < places.begin.size()) axes.origin.at(a) = places.begin[axis] * unit.scale.at(a);
  }
  set_geometry(info.geometry, axes, info.path);
}

}  // namespace isoweave
