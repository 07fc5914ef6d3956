// The facts about packed DICOM samples that need no decoder: run lengths, and the frame headers of the JPEG family.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "volume/formats/dicom/dicom_file.hpp"

namespace isoweave {

// Decodes run lengths, one segment for each byte of a sample. Throws BadInput when they do not give `bytes`.
std::vector<std::byte> unpack_run_lengths(const DicomSlice& slice, std::span<const std::byte> packed,
                                          std::size_t bytes);

// Throws BadInput unless the frame header of a JPEG, JPEG-LS or JPEG 2000 stream says the size and depth of the slice:
// decoders fill what the stream says.
void check_frame_header(const DicomSlice& slice, std::span<const std::byte> packed);

}  // namespace isoweave
