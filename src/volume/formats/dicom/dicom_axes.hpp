// The axes of a volume of DICOM slices.
#pragma once

#include <cstdint>

#include "volume/formats/dicom/dicom_places.hpp"

namespace isoweave {

// Sets the geometry of `count` evenly spaced slices, of which the first and the last are those of the series. Notes
// slices that do not lie on the line between the two, and a thickness that is not known.
void set_dicom_axes(VolumeInfo& info, const PlacedSeries& series, std::int64_t count);

}  // namespace isoweave
