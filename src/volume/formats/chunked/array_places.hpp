// Where the samples of an array lie: steps and starts along its axes, as the attributes of several conventions give
// them.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "volume/formats/chunked/array_axes.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// Per axis of the array, from the slowest to the fastest; an empty list: nothing is said.
struct AxisPlaces {
  std::vector<double> step;
  std::vector<double> begin;
  std::vector<std::string> units;
  std::vector<std::string> notes;
};

// The attributes of an array, whatever the format; lists are in the order of its axes.
struct ArrayAttributes {
  std::function<std::optional<std::vector<double>>(const std::string& name)> numbers;
  std::function<std::vector<std::string>(const std::string& name)> texts;
  std::function<bool(const std::string& name)> has;
};

// The steps of element_size_um (micrometres), or of resolution or voxel_size with units. Lists of three are of k, j, i.
AxisPlaces places_of_attributes(const ArrayAttributes& attributes, const AxisChoice& choice);

// The starts of the attribute offset, in the unit of the steps, whichever attribute gave these. An offset without steps
// is left out with a note.
void take_offset(AxisPlaces& places, const ArrayAttributes& attributes, const AxisChoice& choice);

// Sets spacing, origin and unit; what is not said is taken as 1 and 0 with a note. Units that differ are made one.
// Throws BadInput for steps of no length.
void place_axes(OpenedVolume& volume, const AxisChoice& choice, const AxisPlaces& places);

}  // namespace isoweave
