// A volume from the slices of a DICOM series: its axes, and its samples slice by slice.
#pragma once

#include <string>
#include <vector>

#include "volume/formats/dicom/dicom_file.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {

// `path` stands for all slices in messages. Of the options, those about spacing count.
OpenedVolume open_dicom_slices(const std::vector<DicomSlice>& series, const std::string& path,
                               const OpenOptions& options);

}  // namespace isoweave
