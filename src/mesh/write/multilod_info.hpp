// The file `info` of neuroglancer's multi-resolution meshes.
#pragma once

#include <string>

#include "isoweave/mesh.hpp"

namespace isoweave {

// Coordinates are those of the volume; `transform` makes them nanometres. properties: the folder with those of the
// objects; empty: there is none.
std::string multilod_info(const MeshFileOptions& options, unsigned minishard_bits, const std::string& properties);

// A line about how far places were rounded. coarsest: the number of the last level of detail.
std::string multilod_rounding(const std::string& path, const std::string& unit, double error, std::size_t coarsest);

// A line for a mesh whose unit is not said, or nothing.
std::vector<std::string> multilod_unit_notes(const std::string& path, const std::string& unit);

}  // namespace isoweave
