// JPEG samples of DICOM files, lossless or not, through the codecs of GDCM.
#include <gdcmDataElement.h>
#include <gdcmFragment.h>
#include <gdcmJPEGCodec.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>
#include <gdcmTransferSyntax.h>

#include <exception>
#include <mutex>
#include <string>

#include "volume/dicom_file.hpp"
#include "volume/dicom_packed.hpp"
#include "volume/input_file.hpp"
#include "volume/printable.hpp"

namespace isoweave {
namespace {

// GDCM prints what it thinks of a file unless it is told not to.
void keep_gdcm_quiet() {
  static std::once_flag once;
  std::call_once(once, [] {
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
  });
}

gdcm::DataElement pixel_data(std::span<const std::byte> packed) {
  const gdcm::SmartPointer<gdcm::SequenceOfFragments> sequence = gdcm::SequenceOfFragments::New();
  gdcm::Fragment fragment;
  fragment.SetByteValue(reinterpret_cast<const char*>(packed.data()),
                        gdcm::VL(static_cast<gdcm::VL::Type>(packed.size())));
  sequence->AddFragment(fragment);
  gdcm::DataElement element(gdcm::Tag(0x7fe0, 0x0010));
  element.SetVR(gdcm::VR::OB);
  element.SetValue(*sequence);
  return element;
}

bool decodes(gdcm::JPEGCodec& codec, const gdcm::DataElement& packed, gdcm::DataElement& samples) {
  try {
    return codec.Decode(packed, samples);
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::vector<std::byte> unpack_jpeg(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes) {
  check_jpeg_ends(slice, packed);
  keep_gdcm_quiet();
  const gdcm::TransferSyntax syntax(gdcm::TransferSyntax::GetTSType(slice.syntax.c_str()));
  gdcm::JPEGCodec codec;
  if (!codec.CanDecode(syntax)) bad_input(slice.path, "JPEG samples", isoweave::quoted(slice.syntax));
  const std::array<unsigned int, 3> dims{static_cast<unsigned int>(slice.columns),
                                         static_cast<unsigned int>(slice.rows), 1};
  codec.SetNumberOfDimensions(2);
  codec.SetDimensions(dims.data());
  codec.SetPlanarConfiguration(0);
  codec.SetPhotometricInterpretation(gdcm::PhotometricInterpretation::MONOCHROME2);
  codec.SetPixelFormat(gdcm::PixelFormat(1, static_cast<unsigned short>(slice.bits),
                                         static_cast<unsigned short>(slice.stored),
                                         static_cast<unsigned short>(slice.high), slice.is_signed ? 1 : 0));
  gdcm::DataElement unpacked;
  const bool decoded = decodes(codec, pixel_data(packed), unpacked);
  const gdcm::ByteValue* value = decoded ? unpacked.GetByteValue() : nullptr;
  if (value == nullptr) bad_input(slice.path, "decodable DICOM samples", "damaged data");
  if (value->GetLength() != bytes) {
    bad_input(slice.path, std::to_string(bytes) + " bytes of samples once unpacked",
              std::to_string(static_cast<std::uint64_t>(value->GetLength())));
  }
  const auto* const first = reinterpret_cast<const std::byte*>(value->GetPointer());
  return {first, first + bytes};
}

}  // namespace isoweave
