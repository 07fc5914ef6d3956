// The segments that 3D Slicer describes in the header of NRRD (.seg.nrrd).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/label.hpp"

namespace isoweave {

// The segments that pairs "Segment0_Name", "Segment0_LabelValue", "Segment0_Layer", "Segment0_Color" tell of, in the
// order of their numbers; none in files that are no segmentations. Without a value a segment is 1, without a layer that
// of its number. Throws BadInput for what does not fit the number of layers, and for values that are no whole numbers.
std::vector<LabelName> segments_of(const std::map<std::string, std::string>& pairs, std::int64_t layers,
                                   std::string_view path);

}  // namespace isoweave
