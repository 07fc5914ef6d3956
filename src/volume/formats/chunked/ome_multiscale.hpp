// The multiscales of OME-Zarr 0.1 to 0.5: one image at several sizes, its axes, and where its samples lie.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "files/json_file.hpp"
#include "volume/formats/chunked/array_places.hpp"

namespace isoweave {

struct Multiscale {
  struct Level {
    std::string path;
    AxisPlaces places;  // with the transformations of the level and of the whole applied
  };
  std::vector<Level> levels;  // the largest first
  Json axis_names;            // a list of texts; null where none are given
};

// The first image that `attributes` describe; nothing when they describe none. Throws BadInput naming `path` for a
// description that is wrong, and for transformations other than scales and translations.
std::optional<Multiscale> multiscale_of(const Json& attributes, const std::string& path);

// One array as the level of an image.
struct LevelInImage {
  Multiscale image;
  std::size_t level = 0;
};

// The image of which the array `dataset`, a path in the group, is a level; nothing when it is of none. Throws as
// multiscale_of does.
std::optional<LevelInImage> find_level(const Json& attributes, const std::string& dataset, const std::string& path);

}  // namespace isoweave
