#include "volume/formats/dicom/dicom_bare.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "volume/formats/dicom/dicom_elements.hpp"

namespace isoweave {
namespace {

struct Form {
  bool is_explicit = true;
  bool big_endian = false;
  std::string_view syntax;
};

constexpr std::array<Form, 3> kForms{
    {{true, false, "1.2.840.10008.1.2.1"}, {false, false, "1.2.840.10008.1.2"}, {true, true, "1.2.840.10008.1.2.2"}}};

std::uint32_t number(std::string_view data, std::size_t at, std::size_t bytes, bool big_endian) {
  std::uint32_t value = 0;
  for (std::size_t n = 0; n < bytes; ++n) {
    const std::size_t byte = big_endian ? n : bytes - 1 - n;
    value = value << 8 | static_cast<unsigned char>(data[at + byte]);
  }
  return value;
}

bool is_known_vr(std::string_view vr) {
  static constexpr std::array<std::string_view, 34> kKnown{
      "AE", "AS", "AT", "CS", "DA", "DS", "DT", "FD", "FL", "IS", "LO", "LT", "OB", "OD", "OF", "OL", "OV",
      "OW", "PN", "SH", "SL", "SQ", "SS", "ST", "SV", "TM", "UC", "UI", "UL", "UN", "UR", "US", "UT", "UV"};
  return std::find(kKnown.begin(), kKnown.end(), vr) != kKnown.end();
}

bool is_text(std::string_view value) {
  constexpr unsigned char kFirstLetter = 0x20;
  return std::all_of(value.begin(), value.end(), [](char c) {
    // The zero at the end of a UID, and the escapes of character sets, tabs and line ends.
    return c == 0 || c == 0x1b || c == '\t' || c == '\r' || c == '\n' || static_cast<unsigned char>(c) >= kFirstLetter;
  });
}

struct BareElement {
  std::uint32_t tag = 0;
  std::uint32_t length = 0;
  std::size_t value = 0;
  bool is_plausible = true;
};

// The element at a place from which there are 12 bytes at least.
BareElement element_at(std::string_view data, std::size_t at, const Form& form) {
  BareElement element;
  element.tag = number(data, at, 2, form.big_endian) << 16 | number(data, at + 2, 2, form.big_endian);
  element.value = at + 8;
  if (!form.is_explicit) {
    element.length = number(data, at + 4, 4, false);
    return element;
  }
  const std::string_view vr = data.substr(at + 4, 2);
  element.is_plausible = is_known_vr(vr);
  if (has_long_length(vr)) {
    element.length = number(data, at + 8, 4, form.big_endian);
    element.value = at + 12;
  } else {
    element.length = number(data, at + 6, 2, form.big_endian);
  }
  return element;
}

// Elements of the first groups are short texts but for the lengths in front and sequences behind.
bool is_plausible(std::string_view data, const BareElement& element) {
  constexpr std::uint32_t kLengths = 1;
  constexpr std::uint32_t kGroupOfText = 8;
  const std::string_view value = data.substr(element.value, element.length);
  const bool is_length = (element.tag & 0xffff) <= kLengths;
  if (is_length && element.tag >> 16 == kGroupOfText) return element.length == 4;
  return element.tag >> 16 != kGroupOfText || is_text(value);
}

// Whether the data begin with a few elements in ascending order, the first of them in a group that files begin with.
bool reads_as(std::string_view data, const Form& form, std::uint32_t first_group) {
  constexpr std::size_t kHeader = 12;
  constexpr std::uint32_t kSequences = 0x1000;  // from this element of group 8 on
  // Two letters that are a VR say more than a length does.
  const std::size_t enough = form.is_explicit ? 2 : 3;
  std::uint32_t last = 0;
  std::size_t count = 0;
  for (std::size_t at = 0; count < enough && at + kHeader <= data.size();) {
    const BareElement element = element_at(data, at, form);
    if (count == 0 && element.tag >> 16 != first_group) return false;
    if (!element.is_plausible || (count > 0 && element.tag <= last)) return false;
    const bool goes_on = element.tag >> 16 == first_group && (element.tag & 0xffff) < kSequences;
    if (goes_on && (element.length % 2 != 0 || !is_plausible(data, element))) return false;
    ++count;
    last = element.tag;
    if (!goes_on || element.length > data.size() - std::min(element.value, data.size())) break;
    at = element.value + element.length;
  }
  return count >= enough;
}

}  // namespace

bool is_bare_dicom(std::string_view head) {
  constexpr std::uint32_t kMetaGroup = 2;
  return reads_as(head, kForms[0], kMetaGroup) || !told_syntax(head).empty();
}

std::string_view told_syntax(std::string_view data) {
  constexpr std::uint32_t kIdentifyingGroup = 8;
  for (const Form& form : kForms) {
    if (reads_as(data, form, kIdentifyingGroup)) return form.syntax;
  }
  return {};
}

}  // namespace isoweave
