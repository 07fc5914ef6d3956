// The text by which an index knows its volume again, and the places where indices are kept.
#pragma once

#include <string>

#include "isoweave/volume.hpp"

namespace isoweave {

// The size, type and chosen part of a volume, how it is read, the sizes and times of change of its files, and their
// first and last bytes. It does not say where the files lie. Empty for a volume that lies in no files.
std::string volume_identity(const VolumeInfo& volume);

}  // namespace isoweave
