// The attributes of DICOM by which images in one place may differ: times, echoes, phases, diffusion weights.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "volume/formats/dicom/dicom_elements.hpp"

namespace isoweave {

// An attribute, and how its value is stored.
struct DicomMoment {
  enum class Form : std::uint8_t { kText, kWhole, kDouble };

  std::uint32_t tag;
  std::string_view name;
  Form form;
};

// All such attributes, in the order in which they are tried. An attribute of single images stands before that of
// frames.
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

// The values of an image, as texts; empty where the header does not have the attribute.
using DicomMoments = std::array<std::string, kDicomMoments.size()>;

// Takes the value of an element that is one of the attributes.
void take_moment(DicomMoments& moments, const DicomElementWalk& walk, const DicomElement& element);

}  // namespace isoweave
