// The values that samples of an array stand for, by the conventions of netCDF (CF), which xarray follows in Zarr.
#pragma once

#include <string>
#include <vector>

#include "volume/formats/chunked/array_places.hpp"

namespace isoweave {

// value = slope * sample + intercept.
struct ArrayScaling {
  double slope = 1;
  double intercept = 0;
  std::vector<std::string> notes;
};

// scale_factor and add_offset. An attribute that is no finite number, and a factor of 0, are left out with a note.
ArrayScaling scaling_of_attributes(const ArrayAttributes& attributes);

// Scales the volume, and notes the attributes that say which samples stand for no value: such samples are read as any
// other.
void take_values(VolumeInfo& info, const ArrayAttributes& attributes);

}  // namespace isoweave
