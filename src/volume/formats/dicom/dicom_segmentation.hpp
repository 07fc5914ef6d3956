// DICOM segmentations as label maps: planes of frames, each of one segment, or of numbers of segments.
#pragma once

#include <string>
#include <vector>

#include "volume/formats/dicom/dicom_file.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// Opens a segmentation by its frames. Planes without a frame are empty, as are the one below all frames and the one
// above. Segments that overlap are layers, which options.channel chooses. Throws BadInput for frames that are no label
// map.
OpenedVolume open_dicom_segmentation(const std::vector<DicomSlice>& frames, const std::string& path,
                                     const OpenOptions& options);

}  // namespace isoweave
