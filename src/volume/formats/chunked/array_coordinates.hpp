// Coordinates along the axes of an array, which arrays of their own give: dimension scales of HDF5, coordinate
// variables of netCDF and xarray.
#pragma once

#include <string>
#include <vector>

#include "isoweave/volume.hpp"
#include "volume/formats/chunked/array_places.hpp"

namespace isoweave {

struct AxisCoordinates {
  std::string name;            // of the array of coordinates, for notes; empty: there is none
  std::vector<double> values;  // empty: no numbers that can be read
  std::string units;
};

// Coordinates with the scaling of their own attributes applied.
AxisCoordinates coordinates_of(const std::string& name, std::vector<double> stored, const ArrayAttributes& attributes);

// Sets the steps and starts of the axes that are i, j and k, in the unit of their coordinates. Coordinates that are not
// evenly spaced, or in a unit that is no length, give a step of 1, with a note. Does nothing
// where steps are known, or no axis has coordinates.
void take_coordinates(AxisPlaces& places, const std::vector<AxisCoordinates>& coordinates,
                      const std::vector<ArrayAxis>& axes, const AxisChoice& choice);

}  // namespace isoweave
