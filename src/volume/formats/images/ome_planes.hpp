// The planes of an OME-XML description: which image lies in a file, and on which pages its planes are.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "volume/formats/chunked/array_axes.hpp"

namespace isoweave {

// A run of planes that one TiffData element describes.
struct PlaneRun {
  std::int64_t plane = 0;  // the first one, counted along all axes
  std::int64_t page = 0;   // of the first one, among all directories of the file
  // Of planes on pages that follow one another; nothing: as many as come before the next plane that is described.
  std::optional<std::int64_t> count;
};

struct OmeImage {
  std::string_view pixels;                  // the tag
  std::vector<std::string_view> here;       // tags TiffData of planes in this file
  std::vector<std::string_view> elsewhere;  // tags TiffData of planes in other files
};

// The image that lies in the file `path`. Throws BadInput where there is none, or where there are several.
OmeImage find_ome_image(std::string_view text, const std::string& path);

// axes: of the planes, from the slowest to the fastest
// Throws BadInput for planes that are not there.
std::vector<PlaneRun> plane_runs(const OmeImage& image, const std::vector<ArrayAxis>& axes, std::string_view path);

// The place of each plane's page among `pages`, which are numbers of directories, as many as there are planes. Throws
// BadInput unless every plane has a page of its own.
std::vector<std::size_t> places_of_planes(const std::vector<PlaneRun>& runs, const std::vector<std::int64_t>& pages,
                                          std::string_view path);

}  // namespace isoweave
