// The descriptions of stacks that programs write into the image description of the first page.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "volume/formats/chunked/array_axes.hpp"
#include "volume/formats/images/ome_planes.hpp"

namespace isoweave {

struct StackDescription {
  enum class Writer { kUnknown, kImageJ, kOme, kTifffile };
  Writer writer = Writer::kUnknown;
  std::int64_t images = 0;      // planes by the description: slices times channels times frames; 0: it says nothing
  std::vector<ArrayAxis> axes;  // of the planes, from the slowest to the fastest; empty: all images are slices
  std::vector<PlaneRun> runs;   // pages of the planes; empty: one after another
  bool names_others = false;    // planes lie in other files as well, or only there
  std::array<std::optional<double>, 3> spacing;
  std::array<double, 3> origin_samples{0, 0, 0};  // the sample at the world's origin
  std::array<std::string, 3> units;               // as written
  double slope = 1;
  double intercept = 0;
};

// Throws BadInput naming `path` for counts that are no counts or do not go together. Any other text describes nothing.
StackDescription parse_stack_description(std::string_view text, const std::string& path);

}  // namespace isoweave
