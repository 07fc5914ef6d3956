// The planes that the frames of a segmentation lie in. Several frames may lie in one, and planes may have none.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "volume/formats/dicom/dicom_places.hpp"

namespace isoweave {

struct FramePlanes {
  std::vector<std::int64_t> of_frame;  // ascending from 0; frames are in order of their depths
  std::int64_t count = 0;
  std::vector<std::string> notes;
};

// Counts planes at the distance that the header says or, where frames do not lie at multiples of it, at the smallest
// one between two frames. Throws BadInput where frames do not lie at multiples of that either, unless options take
// uneven slices as they are.
FramePlanes frame_planes(const PlacedSeries& series, const std::string& path, const OpenOptions& options);

}  // namespace isoweave
