#include "volume/formats/dicom/dicom_elements.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "files/header_text.hpp"
#include "parallel/size.hpp"

namespace isoweave {

bool has_long_length(std::string_view vr) {
  static constexpr std::array<std::string_view, 13> kLong{"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                          "SV", "UC", "UN", "UR", "UT", "UV"};
  return std::find(kLong.begin(), kLong.end(), vr) != kLong.end();
}

DicomElement DicomElementWalk::next() {
  while (!ends_.empty() && ends_.back() != kOpen && position_ >= ends_.back()) ends_.pop_back();
  DicomElement element = header();
  const std::uint64_t left = file_.size() - std::min(element.value, file_.size());
  if (element.length != DicomElement::kUndefined && element.length > left) {
    bad_input(
        file_.path(),
        std::to_string(element.length) + " bytes of a DICOM element from byte " + std::to_string(element.value) + " on",
        "a file of " + std::to_string(file_.size()));
  }
  if ((element.tag == DicomElement::kItemEnd || element.tag == DicomElement::kSequenceEnd) && !ends_.empty())
    ends_.pop_back();
  depth_ = ends_.size();
  position_ = element.value;
  if (is_container(element)) {
    enter(element);
  } else if (element.length != DicomElement::kUndefined) {
    position_ += element.length;
  }
  return element;
}

std::uint32_t DicomElementWalk::number(std::uint64_t at, std::size_t bytes) const {
  std::array<std::byte, 4> raw{};
  const std::span<std::byte> wanted = std::span(raw).first(bytes);
  if (file_.read_at(at, wanted) < bytes) {
    bad_input(file_.path(), "a DICOM element at byte " + std::to_string(at),
              "a file of " + std::to_string(file_.size()));
  }
  if (!big_endian_) std::reverse(wanted.begin(), wanted.end());
  std::uint32_t value = 0;
  for (const std::byte byte : wanted) value = value << 8 | std::to_integer<std::uint32_t>(byte);
  return value;
}

std::string DicomElementWalk::text(const DicomElement& element, std::size_t longest) const {
  const std::uint64_t left = file_.size() - std::min(element.value, file_.size());
  std::string result(to_size(std::min<std::uint64_t>({element.length, longest, left})), '\0');
  result.resize(file_.read_at(element.value, std::as_writable_bytes(std::span(result))));
  return std::string(trimmed(std::string_view(result).substr(0, result.find('\0'))));
}

DicomFragments DicomElementWalk::fragments() {
  std::vector<DicomRange> ranges;
  while (true) {
    const DicomElement element = header();
    if (element.tag == DicomElement::kSequenceEnd) {
      position_ = element.value;
      break;
    }
    const std::uint64_t left = file_.size() - std::min(element.value, file_.size());
    if (element.tag != DicomElement::kItem || element.length > left) {
      bad_input(file_.path(), "an item of packed samples at byte " + std::to_string(position_), "none");
    }
    ranges.emplace_back(element.value, element.length);
    position_ = element.value + element.length;
  }
  if (ranges.empty()) bad_input(file_.path(), "a table of offsets before packed samples", "none");
  const DicomRange table = ranges.front();
  ranges.erase(ranges.begin());
  return {table, std::move(ranges)};
}

DicomElement DicomElementWalk::header() const {
  DicomElement element;
  element.tag = number(position_, 2) << 16 | number(position_ + 2, 2);
  element.value = position_ + 8;
  const bool frame = element.tag >> 16 == DicomElement::kItem >> 16;
  if (!explicit_ || frame) {
    element.length = number(position_ + 4, 4);
    return element;
  }
  element.vr.resize(2);
  file_.read_at(position_ + 4, std::as_writable_bytes(std::span(element.vr)));
  if (has_long_length(element.vr)) {
    element.length = number(position_ + 8, 4);
    element.value = position_ + 12;
  } else {
    element.length = number(position_ + 6, 2);
  }
  return element;
}

bool DicomElementWalk::is_container(const DicomElement& element) const {
  if (element.tag == DicomElement::kPixelData) return false;
  if (element.length == DicomElement::kUndefined || element.tag == DicomElement::kItem || element.vr == "SQ")
    return true;
  // Without a VR a sequence is known by its first item.
  return element.vr.empty() && element.length >= 8 && number(element.value, 2) == DicomElement::kItem >> 16 &&
         number(element.value + 2, 2) == (DicomElement::kItem & 0xffff);
}

void DicomElementWalk::enter(const DicomElement& element) {
  constexpr std::size_t kDeepest = 64;
  if (ends_.size() >= kDeepest) bad_input(file_.path(), "sequences no deeper than 64", "deeper ones");
  if (element.vr == "UN" && element.length == DicomElement::kUndefined) {
    bad_input(file_.path(), "sequences whose VR is known", "one of VR UN at byte " + std::to_string(element.value));
  }
  ends_.push_back(element.length == DicomElement::kUndefined ? kOpen : element.value + element.length);
}

}  // namespace isoweave
