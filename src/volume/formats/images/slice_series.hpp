// Volumes of one TIFF or PNG file per slice.
#pragma once

#include "volume/formats/images/slice_files.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// Looks at every file, so that one that is missing, broken or unlike the others is found now; later one is open at a
// time. A single file is read as it would be by itself.
OpenedVolume open_slice_series(const SliceFiles& slices, const OpenOptions& options);

}  // namespace isoweave
