#include "volume/formats/dicom/dicom_stack.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "files/header_text.hpp"
#include "files/input_file.hpp"
#include "files/quoted.hpp"
#include "volume/formats/dicom/dicom_numbers.hpp"

namespace isoweave {
namespace {

constexpr std::uint32_t kSliceVector = 0x00540080;
constexpr std::uint32_t kGridOffsets = 0x3004000c;
constexpr std::uint32_t kSliceLocations = 0x00182005;
// The longest list of frame offsets: 2^17 of them, of 16 letters and a backslash.
constexpr std::size_t kLongestOffsets = std::size_t{17} << 17;

std::vector<std::uint32_t> words_at(const DicomElementWalk& walk, const DicomElement& element) {
  constexpr std::uint32_t kMost = 1 << 17;
  std::vector<std::uint32_t> words;
  for (std::uint32_t n = 0; n < std::min(element.length / 2, kMost); ++n) {
    words.push_back(walk.number(element.value + 2 * std::uint64_t{n}, 2));
  }
  return words;
}

void take_if_empty(std::string& text, const DicomElementWalk& walk, const DicomElement& element) {
  if (text.empty()) text = walk.text(element);
}

// 1, or -1 where the normal of the slices points down the z axis.
double side_of_z(const DicomSlice& slice) {
  const std::vector<double> cosines = leading_numbers(slice.orientation);
  const bool down = cosines.size() == 6 && cosines[0] * cosines[4] - cosines[1] * cosines[3] < 0;
  return down ? -1 : 1;
}

// Offsets along the normal from the planes that the header lists: from the first plane, or along the patient's z axis
// where the first of them is the position's z.
std::vector<double> offsets_of(const std::string& text, std::string_view what, const DicomSlice& slice,
                               std::size_t count) {
  std::vector<double> planes = leading_numbers(text);
  if (planes.size() != count) {
    bad_input(slice.path, std::to_string(count) + " numbers as " + std::string(what), std::to_string(planes.size()));
  }
  const double first = planes.front();
  const std::vector<double> position = leading_numbers(slice.position);
  constexpr double kSlack = 1e-3;
  const bool along_z = first != 0 && position.size() == 3 && std::abs(position[2] - first) < kSlack;
  const double side = along_z ? side_of_z(slice) : 1;
  for (double& plane : planes) plane = side * (plane - first);
  return planes;
}

void note(std::string& notes, const std::string& text) { notes += (notes.empty() ? "" : "; ") + text; }

// The name of a tag that frames are told apart by, where the tag is not a place.
std::string_view moment_of(std::uint32_t tag) {
  struct Known {
    std::uint32_t tag;
    std::string_view name;
  };
  static constexpr std::array<Known, 10> kKnown{{{0x00181063, "Frame Time"},
                                                 {0x00181065, "Frame Time Vector"},
                                                 {0x00540010, "Energy Window Vector"},
                                                 {0x00540020, "Detector Vector"},
                                                 {0x00540030, "Phase Vector"},
                                                 {0x00540050, "Rotation Vector"},
                                                 {0x00540060, "R-R Interval Vector"},
                                                 {0x00540070, "Time Slot Vector"},
                                                 {0x00540090, "Angular View Vector"},
                                                 {0x00540100, "Time Slice Vector"}}};
  for (const Known& known : kKnown) {
    if (known.tag == tag) return known.name;
  }
  return {};
}

}  // namespace

void DicomStack::take(const DicomElementWalk& walk, const DicomElement& element) {
  // The sequence of detectors, its item.
  constexpr std::size_t kDetectorDepth = 2;
  if (walk.depth() == kDetectorDepth && in_detectors_) {
    if (element.tag == 0x00200032) take_if_empty(detector_position_, walk, element);
    if (element.tag == 0x00200037) take_if_empty(detector_orientation_, walk, element);
  }
  if (walk.depth() != 0) return;
  in_detectors_ = element.tag == 0x00540022;
  if (element.tag == 0x00181164) imager_spacing_ = walk.text(element);
  if (element.tag == 0x00182010) scanned_spacing_ = walk.text(element);
  if (element.tag == kGridOffsets) grid_offsets_ = walk.text(element, kLongestOffsets);
  if (element.tag == kSliceLocations) slice_locations_ = walk.text(element, kLongestOffsets);
  if (element.tag == kSliceVector) slice_vector_ = words_at(walk, element);
  if (element.tag == 0x00280009) increments_ = words_at(walk, element);
}

// Frames that are told apart by time, view or energy lie in one place, unless the file says how far slices are apart.
void DicomStack::refuse_moments(const DicomSlice& slice) const {
  std::string found;
  for (std::size_t n = 0; n + 1 < increments_.size(); n += 2) {
    const std::uint32_t tag = increments_[n] << 16 | increments_[n + 1];
    if (tag == kSliceVector) return;
    const bool is_time = tag >> 16 == 0x0018;
    if (is_time && !(slice.slice_spacing.empty() && slice.thickness.empty())) continue;
    if (found.empty()) found = moment_of(tag);
  }
  if (!found.empty()) bad_input(slice.path, "frames that are slices", "frames that differ by " + found);
}

std::vector<double> DicomStack::even_offsets(const std::vector<DicomSlice>& frames, std::string& notes) const {
  const DicomSlice& slice = frames.front();
  double distance = number_or(slice.slice_spacing, 0, "Spacing Between Slices", slice.path);
  const double thickness = std::abs(number_or(slice.thickness, 0, "Slice Thickness", slice.path));
  if (distance != 0) {
    note(notes, "the distance is Spacing Between Slices, " + number_text(distance) + " mm");
  } else if (thickness != 0) {
    distance = thickness;
    note(notes, "the distance is not given, and taken from Slice Thickness, " + number_text(distance) + " mm");
  } else {
    distance = 1;
    note(notes, "the distance is not given and taken as 1 (--spacing says another)");
  }
  std::vector<double> offsets;
  for (std::size_t n = 0; n < frames.size(); ++n) {
    const bool listed = slice_vector_.size() == frames.size();
    // Numbered from 1; the position is that of the first frame.
    offsets.push_back(distance * (listed ? static_cast<double>(slice_vector_[n]) - static_cast<double>(slice_vector_[0])
                                         : static_cast<double>(n)));
  }
  return offsets;
}

std::vector<double> DicomStack::offsets(const std::vector<DicomSlice>& frames, std::string& notes) const {
  const DicomSlice& slice = frames.front();
  if (!grid_offsets_.empty()) {
    note(notes, "offsets are those of Grid Frame Offset Vector");
    return offsets_of(grid_offsets_, "Grid Frame Offset Vector", slice, frames.size());
  }
  if (!slice_locations_.empty()) {
    note(notes, "offsets are those of Slice Location Vector");
    return offsets_of(slice_locations_, "Slice Location Vector", slice, frames.size());
  }
  refuse_moments(slice);
  return even_offsets(frames, notes);
}

void DicomStack::place(std::vector<DicomSlice>& frames) const {
  DicomSlice common = frames.front();
  std::string notes;
  const auto fill = [&notes](std::string& text, const std::string& other, const char* otherwise, const char* what) {
    if (!text.empty()) return;
    if (other.empty()) note(notes, std::string(what) + " is not given and taken as " + in_quotes(otherwise));
    text = other.empty() ? otherwise : other;
  };
  fill(common.position, detector_position_, "0\\0\\0", "the position");
  fill(common.orientation, detector_orientation_, "1\\0\\0\\0\\1\\0", "the orientation");
  const std::string& pixel = imager_spacing_.empty() ? scanned_spacing_ : imager_spacing_;
  const bool has_unit = !common.pixel_spacing.empty() || !pixel.empty();
  fill(common.pixel_spacing, pixel, "1\\1", "the pixel spacing");
  for (DicomSlice& frame : frames) {
    frame.position = common.position;
    frame.orientation = common.orientation;
    frame.pixel_spacing = common.pixel_spacing;
    frame.has_unit = has_unit;
  }
  const std::vector<double> along = offsets(frames, notes);
  for (std::size_t n = 0; n < frames.size(); ++n) {
    frames[n].offset = along[n];
    frames[n].placed_by = notes;
  }
}

}  // namespace isoweave
