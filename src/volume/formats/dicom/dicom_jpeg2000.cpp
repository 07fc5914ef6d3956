// JPEG 2000 samples of DICOM files through OpenJPEG, which prints nothing and gives everything back when a stream turns
// out to be damaged; GDCM's decoder around it does neither.
#include <openjpeg.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <string>

#include "files/input_file.hpp"
#include "volume/formats/dicom/dicom_file.hpp"

namespace isoweave {
namespace {

using Codec = std::unique_ptr<opj_codec_t, decltype(&opj_destroy_codec)>;
using Image = std::unique_ptr<opj_image_t, decltype(&opj_image_destroy)>;
using Stream = std::unique_ptr<opj_stream_t, decltype(&opj_stream_destroy)>;

// Bytes in memory as OpenJPEG reads them.
struct Input {
  std::span<const std::byte> bytes;
  std::size_t position = 0;
};

constexpr auto kEnd = static_cast<OPJ_SIZE_T>(-1);

OPJ_SIZE_T read_input(void* out, OPJ_SIZE_T count, void* handle) {
  Input& input = *static_cast<Input*>(handle);
  const std::size_t step = std::min<std::size_t>(count, input.bytes.size() - input.position);
  if (step == 0) return kEnd;
  std::memcpy(out, input.bytes.data() + input.position, step);
  input.position += step;
  return step;
}

OPJ_OFF_T skip_input(OPJ_OFF_T count, void* handle) {
  Input& input = *static_cast<Input*>(handle);
  if (count < 0) return -1;
  const std::size_t step = std::min(static_cast<std::size_t>(count), input.bytes.size() - input.position);
  input.position += step;
  return static_cast<OPJ_OFF_T>(step);
}

OPJ_BOOL seek_input(OPJ_OFF_T position, void* handle) {
  Input& input = *static_cast<Input*>(handle);
  if (position < 0 || static_cast<std::size_t>(position) > input.bytes.size()) return OPJ_FALSE;
  input.position = static_cast<std::size_t>(position);
  return OPJ_TRUE;
}

Stream stream_of(Input& input) {
  Stream stream(opj_stream_default_create(OPJ_TRUE), opj_stream_destroy);
  if (!stream) throw std::bad_alloc();
  opj_stream_set_read_function(stream.get(), read_input);
  opj_stream_set_skip_function(stream.get(), skip_input);
  opj_stream_set_seek_function(stream.get(), seek_input);
  opj_stream_set_user_data(stream.get(), &input, nullptr);
  opj_stream_set_user_data_length(stream.get(), input.bytes.size());
  return stream;
}

// The decoded image; none when the stream is damaged.
Image decoded(std::span<const std::byte> packed) {
  Input input{packed};
  const Stream stream = stream_of(input);
  const Codec codec(opj_create_decompress(OPJ_CODEC_J2K), opj_destroy_codec);
  if (!codec) throw std::bad_alloc();
  opj_dparameters_t parameters;
  opj_set_default_decoder_parameters(&parameters);
  opj_image_t* image = nullptr;
  const bool readable = opj_setup_decoder(codec.get(), &parameters) != OPJ_FALSE &&
                        opj_read_header(stream.get(), codec.get(), &image) != OPJ_FALSE;
  Image result(image, opj_image_destroy);
  const bool whole = readable && opj_decode(codec.get(), stream.get(), result.get()) != OPJ_FALSE &&
                     opj_end_decompress(codec.get(), stream.get()) != OPJ_FALSE;
  if (!whole) result.reset();
  return result;
}

template <class Word>
void store(const opj_image_comp_t& samples, std::span<std::byte> out) {
  for (std::size_t n = 0; n < out.size() / sizeof(Word); ++n) {
    const auto word = static_cast<Word>(samples.data[n]);
    std::memcpy(out.data() + n * sizeof(Word), &word, sizeof(Word));
  }
}

}  // namespace

std::vector<std::byte> unpack_jpeg2000(const DicomSlice& slice, std::span<const std::byte> packed, std::size_t bytes) {
  const Image image = decoded(packed);
  if (!image) bad_input(slice.path, "decodable JPEG 2000 samples", "damaged data");
  const opj_image_comp_t& samples = image->comps[0];
  const auto width = static_cast<std::int64_t>(samples.w);
  const auto height = static_cast<std::int64_t>(samples.h);
  if (image->numcomps != 1 || width != slice.columns || height != slice.rows || samples.data == nullptr) {
    bad_input(slice.path, std::to_string(slice.columns) + " x " + std::to_string(slice.rows) + " JPEG 2000 samples",
              std::to_string(width) + " x " + std::to_string(height));
  }
  std::vector<std::byte> out(bytes);
  if (slice.bits == 8) store<std::uint8_t>(samples, out);
  if (slice.bits == 16) store<std::uint16_t>(samples, out);
  if (slice.bits == 32) store<std::uint32_t>(samples, out);
  return out;
}

}  // namespace isoweave
