// JPEG samples of DICOM files, lossless or not.
#include <cstring>
#include <string>

#include "files/input_file.hpp"
#include "volume/formats/dicom/dicom_file.hpp"
#include "volume/formats/dicom/jpeg.hpp"

namespace isoweave {

std::vector<std::byte> unpack_jpeg(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes) {
  constexpr int kMostBits = 16;
  if (slice.bits > kMostBits) bad_input(slice.path, "JPEG samples of 8 or 16 bits", std::to_string(slice.bits));
  const int used = slice.is_signed ? slice.bits : slice.stored;
  const std::vector<std::uint16_t> samples = decode_jpeg(slice.path, packed, slice.columns, slice.rows, used);
  std::vector<std::byte> out(samples.size() * static_cast<std::size_t>(slice.bits) / 8);
  if (out.size() != bytes) {
    bad_input(slice.path, std::to_string(bytes) + " bytes of samples once unpacked", std::to_string(out.size()));
  }
  if (slice.bits == kMostBits) {
    std::memcpy(out.data(), samples.data(), bytes);
  } else {
    for (std::size_t n = 0; n < bytes; ++n) out[n] = static_cast<std::byte>(samples[n]);
  }
  return out;
}

}  // namespace isoweave
