// The segments of a DICOM segmentation: their numbers, names and colours, and how frames hold them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "isoweave/label.hpp"
#include "volume/formats/dicom/dicom_elements.hpp"

namespace isoweave {

class DicomSegments {
 public:
  // Every element of the data set, in order.
  void take(const DicomElementWalk& walk, const DicomElement& element);

  // BINARY: samples are in the segment of their frame or not; FRACTIONAL: they say how much of them is; LABELMAP: they
  // are numbers of segments.
  const std::string& type() const { return type_; }
  // The stored value that means a whole sample, where the type is FRACTIONAL; 0 where the header does not have it.
  std::uint32_t most_fraction() const { return most_fraction_; }
  const std::string& said_to_overlap() const { return overlap_; }  // YES, NO, or that it is not known

  // The segments in the file's order; without 0, which is background in a label map.
  const std::vector<LabelName>& names() const { return names_; }

 private:
  void take_segment(const DicomElementWalk& walk, const DicomElement& element);

  bool in_segments_ = false;  // whether the last element lies in the sequence of segments
  std::string type_;
  std::string overlap_;
  std::uint32_t most_fraction_ = 0;
  std::vector<LabelName> names_;
};

// Whether a SOP class is one of segmentations as images.
bool is_segmentation_class(std::string_view uid);

// Red, green and blue of sRGB from 0 to 1 for a CIELab value as DICOM has it: three numbers of 16 bits. The white is
// that of D65, as in DCMTK, PixelMed and dcmqi, though the standard's is D50.
std::array<double, 3> color_of_lab(const std::array<std::uint32_t, 3>& lab);

}  // namespace isoweave
