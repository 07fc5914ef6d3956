// What the programs that write stacks of pages say about them in the image description of the first page.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isoweave {

struct StackDescription {
  enum class Writer { kUnknown, kImageJ, kOme };
  Writer writer = Writer::kUnknown;
  std::int64_t images = 0;  // planes by the description: slices times channels times frames; 0: it says nothing
  std::int64_t slices = 0;  // 0: all images
  std::int64_t step = 1;    // images from one slice to the next of the first channel and frame
  std::array<std::optional<double>, 3> spacing;
  std::array<double, 3> origin_samples{0, 0, 0};  // the sample at the world's origin
  std::string unit;                               // as written
  double slope = 1;
  double intercept = 0;
  std::vector<std::string> notes;
};

// Throws BadInput naming `path` for counts that are no counts or do not go together. Any other text describes nothing.
StackDescription parse_stack_description(std::string_view text, std::string_view path);

// Millimetres, micrometres, ... in a unit that Geometry knows. A unit it does not know is scaled to one it does, or
// left out with a note.
struct LengthUnit {
  double scale = 1;
  std::string unit;
  std::string note;
};
LengthUnit length_unit(std::string_view text);

}  // namespace isoweave
