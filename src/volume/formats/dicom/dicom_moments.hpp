// What a header says of the time, echo or phase of an image: it tells images apart that lie in one place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "volume/formats/dicom/dicom_elements.hpp"

namespace isoweave {

struct DicomMoment {
  enum class Form : std::uint8_t { kText, kWhole, kDouble };

  std::uint32_t tag;
  std::string_view name;
  Form form;
};

// In the order in which they are asked. Those of single images and those of frames stand side by side.
inline constexpr std::array<DicomMoment, 15> kDicomMoments{
    {{0x00200100, "Temporal Position Identifier", DicomMoment::Form::kText},
     {0x00209128, "Temporal Position Index", DicomMoment::Form::kWhole},
     {0x00181060, "Trigger Time", DicomMoment::Form::kText},
     {0x00209153, "Nominal Cardiac Trigger Delay Time", DicomMoment::Form::kDouble},
     {0x00180081, "Echo Time", DicomMoment::Form::kText},
     {0x00189082, "Effective Echo Time", DicomMoment::Form::kDouble},
     {0x00189087, "Diffusion b-value", DicomMoment::Form::kDouble},
     {0x00180082, "Inversion Time", DicomMoment::Form::kText},
     {0x00541300, "Frame Reference Time", DicomMoment::Form::kText},
     {0x00200012, "Acquisition Number", DicomMoment::Form::kText},
     {0x00209156, "Frame Acquisition Number", DicomMoment::Form::kWhole},
     {0x0008002a, "Acquisition DateTime", DicomMoment::Form::kText},
     {0x00189074, "Frame Acquisition DateTime", DicomMoment::Form::kText},
     {0x00080032, "Acquisition Time", DicomMoment::Form::kText},
     {0x00080033, "Content Time", DicomMoment::Form::kText}}};

using DicomMoments = std::array<std::string, kDicomMoments.size()>;

// Takes the value of an element that is one of the moments.
void take_moment(DicomMoments& moments, const DicomElementWalk& walk, const DicomElement& element);

}  // namespace isoweave
