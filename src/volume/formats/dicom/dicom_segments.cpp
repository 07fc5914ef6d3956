#include "volume/formats/dicom/dicom_segments.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "volume/axes.hpp"

namespace isoweave {
namespace {

constexpr std::uint32_t kSegments = 0x00620002;
constexpr std::uint32_t kNumber = 0x00620004;
constexpr std::uint32_t kLabel = 0x00620005;
constexpr std::uint32_t kColor = 0x0062000d;

// The inverse of CIELab's function of a part of white.
double part_of_white(double f) {
  constexpr double kLinear = 6.0 / 29;
  return f > kLinear ? f * f * f : 3 * kLinear * kLinear * (f - 4.0 / 29);
}

// A linear part of light as sRGB has it (IEC 61966-2-1). The power of 5/12 is the cube root of that of 5/4.
double encoded(double light) {
  light = std::clamp(light, 0.0, 1.0);
  if (light <= 0.0031308) return 12.92 * light;
  return 1.055 * cube_root(light * std::sqrt(std::sqrt(light))) - 0.055;
}

}  // namespace

bool is_segmentation_class(std::string_view uid) {
  constexpr std::array<std::string_view, 2> kClasses{"1.2.840.10008.5.1.4.1.1.66.4", "1.2.840.10008.5.1.4.1.1.66.7"};
  return std::find(kClasses.begin(), kClasses.end(), uid) != kClasses.end();
}

std::array<double, 3> color_of_lab(const std::array<std::uint32_t, 3>& lab) {
  constexpr double kMost = 65535;
  const double luminance = lab[0] / kMost * 100;
  const double a = lab[1] / kMost * 255 - 128;
  const double b = lab[2] / kMost * 255 - 128;
  const double f = (luminance + 16) / 116;
  const double x = 0.950456 * part_of_white(f + a / 500);
  const double y = part_of_white(f);
  const double z = 1.088754 * part_of_white(f - b / 200);
  return {encoded(3.2404542 * x - 1.5371385 * y - 0.4985314 * z),
          encoded(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z),
          encoded(0.0556434 * x - 0.2040259 * y + 1.0572252 * z)};
}

void DicomSegments::take(const DicomElementWalk& walk, const DicomElement& element) {
  if (walk.depth() == 0) {
    in_segments_ = element.tag == kSegments;
    if (element.tag == 0x00620001) type_ = walk.text(element);
    if (element.tag == 0x00620013) overlap_ = walk.text(element);
    if (element.tag == 0x0062000e && element.length >= 2) most_fraction_ = walk.number(element.value, 2);
  } else if (in_segments_) {
    take_segment(walk, element);
  }
}

// An item begins a segment; the elements in it follow.
void DicomSegments::take_segment(const DicomElementWalk& walk, const DicomElement& element) {
  constexpr std::size_t kItemDepth = 1;
  constexpr std::uint32_t kWord = 2;
  if (walk.depth() == kItemDepth && element.tag == DicomElement::kItem) names_.emplace_back();
  if (walk.depth() != kItemDepth + 1 || names_.empty()) return;
  const auto word = [&](std::uint32_t n) { return walk.number(element.value + std::uint64_t{kWord} * n, kWord); };
  LabelName& segment = names_.back();
  if (element.tag == kNumber && element.length >= kWord) segment.label = word(0);
  if (element.tag == kLabel) segment.name = walk.text(element);
  if (element.tag == kColor && element.length >= 3 * kWord) segment.color = color_of_lab({word(0), word(1), word(2)});
}

}  // namespace isoweave
