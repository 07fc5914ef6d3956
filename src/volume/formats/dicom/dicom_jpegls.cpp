// JPEG-LS samples of DICOM files through CharLS; GDCM's decoder around it keeps memory for good when a stream turns out
// to be damaged.
#include <charls/charls.h>

#include <memory>
#include <new>
#include <string>

#include "files/input_file.hpp"
#include "volume/formats/dicom/dicom_file.hpp"

namespace isoweave {
namespace {

constexpr auto kDone = charls_jpegls_errc{};

using Decoder = std::unique_ptr<charls_jpegls_decoder, decltype(&charls_jpegls_decoder_destroy)>;

}  // namespace

std::vector<std::byte> unpack_jpegls(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes) {
  const Decoder decoder(charls_jpegls_decoder_create(), charls_jpegls_decoder_destroy);
  if (!decoder) throw std::bad_alloc();
  std::size_t size = 0;
  const bool readable = charls_jpegls_decoder_set_source_buffer(decoder.get(), packed.data(), packed.size()) == kDone &&
                        charls_jpegls_decoder_read_header(decoder.get()) == kDone &&
                        charls_jpegls_decoder_get_destination_size(decoder.get(), 0, &size) == kDone;
  if (readable && size != bytes) {
    bad_input(slice.path, std::to_string(bytes) + " bytes of samples once unpacked", std::to_string(size));
  }
  std::vector<std::byte> out(bytes);
  if (!readable || charls_jpegls_decoder_decode_to_buffer(decoder.get(), out.data(), out.size(), 0) != kDone) {
    bad_input(slice.path, "decodable JPEG-LS samples", "damaged data");
  }
  return out;
}

}  // namespace isoweave
