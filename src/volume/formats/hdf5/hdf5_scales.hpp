// Dimension scales of HDF5, as netCDF-4 and h5py attach them: names of the axes of a dataset, and the coordinates along
// them. To be used inside a session.
#pragma once

#include <string>
#include <vector>

#include "volume/formats/chunked/array_coordinates.hpp"
#include "volume/formats/hdf5/hdf5_place.hpp"

namespace isoweave {

struct Hdf5Scales {
  std::vector<AxisCoordinates> coordinates;  // per axis of the dataset
  std::vector<std::string> notes;
};

// The scales of an open dataset. An axis without a name takes that of its scale. An axis that has a name and no scale
// has the coordinates of a dataset of this name beside it, where that has one number for each sample.
// Scalings and offsets that NeXus keeps beside a dataset are noted, not applied.
Hdf5Scales take_hdf5_scales(const Hdf5File& file, hid_t dataset, const std::string& name, std::vector<ArrayAxis>& axes);

}  // namespace isoweave
