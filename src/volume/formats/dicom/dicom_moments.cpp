#include "volume/formats/dicom/dicom_moments.hpp"

#include <bit>

#include "files/header_text.hpp"

namespace isoweave {
namespace {

std::string text_of(const DicomElementWalk& walk, const DicomElement& element, DicomMoment::Form form) {
  constexpr std::uint32_t kWord = 2, kLong = 4, kDouble = 8;
  if (form == DicomMoment::Form::kText) return walk.text(element);
  if (form == DicomMoment::Form::kWhole) {
    if (element.length < kWord) return {};
    return std::to_string(walk.number(element.value, element.length < kLong ? kWord : kLong));
  }
  if (element.length < kDouble) return {};
  const auto half = [&](std::uint64_t n) { return std::uint64_t{walk.number(element.value + kLong * n, kLong)}; };
  const std::uint64_t low = walk.is_big_endian() ? half(1) : half(0);
  const std::uint64_t high = walk.is_big_endian() ? half(0) : half(1);
  return number_text(std::bit_cast<double>(high << 32 | low));
}

}  // namespace

void take_moment(DicomMoments& moments, const DicomElementWalk& walk, const DicomElement& element) {
  for (std::size_t n = 0; n < kDicomMoments.size(); ++n) {
    if (kDicomMoments[n].tag == element.tag) moments[n] = text_of(walk, element, kDicomMoments[n].form);
  }
}

}  // namespace isoweave
