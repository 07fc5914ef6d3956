// DICOM series: one slice per file, put in order by where the slices lie.
#pragma once

#include <string>

#include "volume/formats/images/slice_files.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// The series in a list of files that options.series names: by its UID, or "none" where it has none. Where nothing is
// named there must be only one. Throws BadInput that lists the series when there are several to choose from.
OpenedVolume open_dicom_series(const SliceFiles& slices, const OpenOptions& options);

// The series that a file belongs to, with the other files of its folder.
OpenedVolume open_dicom_file(const std::string& path, const OpenOptions& options);

}  // namespace isoweave
