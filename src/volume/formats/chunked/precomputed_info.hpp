// neuroglancer's precomputed volumes: the object `info`.
#pragma once

#include <cstddef>
#include <string>

#include "files/json_file.hpp"
#include "volume/formats/chunked/array_places.hpp"
#include "volume/formats/chunked/chunked_array.hpp"

namespace isoweave {

// The array of a scale, and where its samples lie.
struct PrecomputedScale {
  ChunkedArray array;
  AxisPlaces places;
  std::size_t scale = 0, scales = 1;
};

// The scale that the options choose. Throws BadInput for a volume that is wrong or not supported.
PrecomputedScale precomputed_scale(const StorePtr& store, const std::string& folder, const Json& info,
                                   const OpenOptions& options);

}  // namespace isoweave
