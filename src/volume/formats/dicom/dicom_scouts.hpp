// Images of a DICOM series that are no slices of its volume: scouts, screenshots.
#pragma once

#include <string>
#include <vector>

#include "volume/formats/dicom/dicom_file.hpp"

namespace isoweave {

// The slices that look as most of them do: in size, orientation, pixel spacing and number of samples, and in whether
// they are localizers. The others are noted. All of them where no look is that of more than half.
std::vector<DicomSlice> without_scouts(const std::vector<DicomSlice>& series, std::vector<std::string>& notes);

}  // namespace isoweave
