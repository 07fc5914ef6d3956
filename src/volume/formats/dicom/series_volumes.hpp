// Several volumes in one series: images in the same places that differ by time, echo, phase and the like.
#pragma once

#include "volume/formats/dicom/dicom_places.hpp"

namespace isoweave {

// Keeps the slices of one of the volumes that a series holds: the one at options.time, or the first with a note. The
// volumes are told apart by an attribute, by two of them, or by the order of the images' numbers, without a
// contradiction. Where none does, the series stays as it is. Adds notes, and what was chosen to `part`. Throws BadInput
// for an index that is not there.
void choose_volume(PlacedSeries& series, const std::string& path, const OpenOptions& options, std::string& part);

}  // namespace isoweave
