#include "volume/formats/dicom/dicom_packed.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <string>

#include "files/input_file.hpp"

namespace isoweave {
namespace {

using Packed = std::span<const std::byte>;

// A number whose most significant byte comes first; 0 behind the end.
std::uint32_t number(Packed packed, std::size_t at, std::size_t bytes) {
  std::uint32_t value = 0;
  if (at > packed.size() || bytes > packed.size() - at) return 0;
  for (std::size_t n = 0; n < bytes; ++n) value = value << 8 | std::to_integer<std::uint32_t>(packed[at + n]);
  return value;
}

// Appends one segment to every `step`-th byte of `samples` from `first` on; false when it is not as long as they are.
bool unpack_segment(Packed segment, std::span<std::byte> samples, std::size_t first, std::size_t step) {
  std::size_t out = first;
  std::size_t at = 0;
  while (at < segment.size() && out < samples.size()) {
    constexpr std::size_t kNothing = 128;
    const auto code = std::to_integer<std::size_t>(segment[at++]);
    if (code == kNothing) continue;
    const bool literal = code < kNothing;
    const std::size_t count = literal ? code + 1 : 257 - code;
    const std::size_t stored = literal ? count : 1;
    if (stored > segment.size() - at) return false;
    for (std::size_t n = 0; n < count && out < samples.size(); ++n, out += step) {
      samples[out] = segment[at + (literal ? n : 0)];
    }
    at += stored;
  }
  return out >= samples.size();
}

struct FrameHeader {
  std::uint32_t columns = 0;
  std::uint32_t rows = 0;
  std::uint32_t bits = 0;
  std::uint32_t components = 0;
};

// The image size marker, which comes first in a JPEG 2000 codestream.
std::optional<FrameHeader> jpeg2000_header(Packed packed) {
  constexpr std::uint32_t kStart = 0xff4fff51;
  if (number(packed, 0, 4) != kStart) return std::nullopt;
  const std::uint32_t left = number(packed, 16, 4);
  const std::uint32_t top = number(packed, 20, 4);
  constexpr std::uint32_t kDepth = 0x7f;
  return FrameHeader{number(packed, 8, 4) - left, number(packed, 12, 4) - top, (number(packed, 42, 1) & kDepth) + 1,
                     number(packed, 40, 2)};
}

bool starts_frame(std::uint32_t marker) {
  // The markers of frames. C4, C8 and CC among them are tables; F7 is the marker of JPEG-LS.
  return marker == 0xf7 || (marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc);
}

// The first frame header of a JPEG or JPEG-LS stream.
std::optional<FrameHeader> jpeg_header(Packed packed) {
  constexpr std::uint32_t kStart = 0xffd8;
  if (number(packed, 0, 2) != kStart) return std::nullopt;
  std::size_t at = 2;
  while (number(packed, at, 1) == 0xff) {
    const std::uint32_t marker = number(packed, at + 1, 1);
    if (starts_frame(marker)) {
      return FrameHeader{number(packed, at + 7, 2), number(packed, at + 5, 2), number(packed, at + 4, 1),
                         number(packed, at + 9, 1)};
    }
    const std::uint32_t length = number(packed, at + 2, 2);
    // Bytes of filling have no length.
    at += marker == 0xff ? 1 : 2 + std::max<std::uint32_t>(length, 2);
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::byte> unpack_run_lengths(const DicomSlice& slice, Packed packed, std::size_t bytes) {
  constexpr std::size_t kHeader = 64;
  const std::size_t sample = static_cast<std::size_t>(slice.bits) / 8;
  const auto word = [&](std::size_t n) { return __builtin_bswap32(number(packed, 4 * n, 4)); };
  if (packed.size() < kHeader || word(0) != sample) {
    bad_input(slice.path, std::to_string(sample) + " run length segments", std::to_string(word(0)));
  }
  std::vector<std::byte> samples(bytes);
  for (std::size_t n = 0; n < sample; ++n) {
    const std::size_t begin = word(n + 1);
    const std::size_t end = n + 1 < sample ? word(n + 2) : packed.size();
    // The most significant byte has the first segment.
    const std::size_t first = std::endian::native == std::endian::little ? sample - 1 - n : n;
    const bool inside = begin >= kHeader && begin <= end && end <= packed.size();
    if (!inside || !unpack_segment(packed.subspan(begin, end - begin), samples, first, sample)) {
      bad_input(slice.path,
                "run lengths of " + std::to_string(bytes / sample) + " bytes in segment " + std::to_string(n), "fewer");
    }
  }
  return samples;
}

void check_frame_header(const DicomSlice& slice, Packed packed) {
  std::optional<FrameHeader> header = jpeg2000_header(packed);
  if (!header) header = jpeg_header(packed);
  if (!header) bad_input(slice.path, "the header of a JPEG frame", "none");
  const auto allocated = static_cast<std::uint32_t>(slice.bits);
  const bool fits = header->columns == slice.columns && header->rows == slice.rows && header->components == 1 &&
                    header->bits <= allocated && (allocated == 8 || header->bits > 8);
  if (fits) return;
  bad_input(slice.path,
            "a packed frame of " + std::to_string(slice.columns) + " x " + std::to_string(slice.rows) + " samples of " +
                std::to_string(allocated) + " bits",
            std::to_string(header->columns) + " x " + std::to_string(header->rows) + " of " +
                std::to_string(header->components) + " times " + std::to_string(header->bits) + " bits");
}

}  // namespace isoweave
