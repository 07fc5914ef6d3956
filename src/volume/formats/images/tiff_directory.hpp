// The frame of a TIFF directory, looked at before libtiff, which leaves tags out that lie behind the end of a file.
#pragma once

#include <cstdint>

#include "files/input_file.hpp"

namespace isoweave {

// Throws BadInput unless the directory at byte `offset`, with the values of all its tags and the link to the next
// directory, lies in the file.
void check_tiff_directory(const InputFile& file, std::uint64_t offset);

}  // namespace isoweave
