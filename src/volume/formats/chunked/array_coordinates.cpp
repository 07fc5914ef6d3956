#include "volume/formats/chunked/array_coordinates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "files/header_text.hpp"
#include "files/length_units.hpp"
#include "files/quoted.hpp"
#include "volume/formats/chunked/array_values.hpp"
#include "volume/grid_coordinates.hpp"

namespace isoweave {
namespace {

// Why coordinates give no step; empty where they give one.
std::string fault_of(const AxisCoordinates& coordinates, std::int64_t samples) {
  const std::vector<double>& values = coordinates.values;
  if (values.empty()) return "no numbers that can be read";
  if (std::cmp_not_equal(values.size(), samples)) {
    return std::to_string(values.size()) + " for " + std::to_string(samples) + " samples";
  }
  if (!trimmed(coordinates.units).empty() && !find_length_unit(coordinates.units)) {
    return "in " + in_quotes(coordinates.units) + ", which is no length that is known";
  }
  const double step = even_step(values);
  const bool even = std::isfinite(step) && step != 0 && !first_uneven(values);
  return even ? std::string() : "not evenly spaced";
}

void take_axis(AxisPlaces& places, const AxisCoordinates& coordinates, std::int64_t samples, std::size_t n,
               const std::string& axis) {
  if (coordinates.name.empty()) {
    places.notes.push_back("the spacing of axis " + axis + " is not given and taken as 1");
    return;
  }
  if (const std::string fault = fault_of(coordinates, samples); !fault.empty()) {
    places.notes.push_back("the coordinates " + in_quotes(coordinates.name) + " of axis " + axis + " are " + fault +
                           ": its spacing is taken as 1");
    return;
  }
  places.step[n] = even_step(coordinates.values);
  places.begin[n] = coordinates.values.front();
  places.units[n] = coordinates.units;
  if (samples == 1) places.notes.push_back("the spacing of axis " + axis + " is not given and taken as 1");
}

}  // namespace

AxisCoordinates coordinates_of(const std::string& name, std::vector<double> stored, const ArrayAttributes& attributes) {
  AxisCoordinates coordinates{name, std::move(stored), {}};
  const ArrayScaling scaling = scaling_of_attributes(attributes);
  for (double& value : coordinates.values) value = scaling.slope * value + scaling.intercept;
  const std::vector<std::string> units = attributes.texts("units");
  if (units.size() == 1) coordinates.units = units[0];
  return coordinates;
}

void take_coordinates(AxisPlaces& places, const std::vector<AxisCoordinates>& coordinates,
                      const std::vector<ArrayAxis>& axes, const AxisChoice& choice) {
  const auto is_there = [](const AxisCoordinates& axis) { return !axis.name.empty(); };
  if (!places.step.empty() || coordinates.size() != axes.size()) return;
  if (std::none_of(coordinates.begin(), coordinates.end(), is_there)) return;
  places.step.assign(axes.size(), 1);
  places.begin.assign(axes.size(), 0);
  places.units.assign(axes.size(), std::string());
  for (std::size_t a = 0; a < choice.place.size(); ++a) {
    const std::size_t n = choice.place.at(a);
    if (n != kNoAxis) take_axis(places, coordinates[n], axes[n].size, n, std::to_string(a));
  }
}

}  // namespace isoweave
