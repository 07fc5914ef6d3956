// Frames of a DICOM file without functional groups (cone beam CT, nuclear medicine, radiotherapy dose): one position
// for all of them, and distances.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "volume/formats/dicom/dicom_file.hpp"

namespace isoweave {

class DicomStack {
 public:
  // Every element of the data set, in order.
  void take(const DicomElementWalk& walk, const DicomElement& element);

  // Says where each frame lies: how far along the normal, and what the file does not say of position, orientation and
  // pixel spacing. Throws BadInput when offsets and frames differ in number, and for frames that are no slices.
  void place(std::vector<DicomSlice>& frames) const;

 private:
  std::vector<double> offsets(const std::vector<DicomSlice>& frames, std::string& notes) const;
  std::vector<double> even_offsets(const std::vector<DicomSlice>& frames, std::string& notes) const;
  void refuse_moments(const DicomSlice& slice) const;

  bool in_detectors_ = false;  // whether the last element lies in the sequence of detectors
  std::string grid_offsets_, slice_locations_;
  std::string imager_spacing_, scanned_spacing_;
  std::string detector_position_, detector_orientation_;
  std::vector<std::uint32_t> increments_;    // tags of what differs from frame to frame
  std::vector<std::uint32_t> slice_vector_;  // the slice that each frame is, from 1
};

}  // namespace isoweave
