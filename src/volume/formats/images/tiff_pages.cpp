#include "volume/formats/images/tiff_pages.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "volume/formats/images/tiff_directory.hpp"
#include "volume/stream_source.hpp"

namespace isoweave {
namespace {

std::string text_of(const TiffPageKind& kind) {
  return std::to_string(kind.width) + " x " + std::to_string(kind.height) + " " +
         std::string(stored_type_name(kind.type));
}

void check_grey(const TiffFile& tiff) {
  const auto photometric = tiff.field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  static constexpr std::array<std::pair<int, std::string_view>, 5> kColours{{{PHOTOMETRIC_RGB, "RGB"},
                                                                             {PHOTOMETRIC_PALETTE, "a palette"},
                                                                             {PHOTOMETRIC_MASK, "a mask"},
                                                                             {PHOTOMETRIC_SEPARATED, "CMYK"},
                                                                             {PHOTOMETRIC_YCBCR, "YCbCr"}}};
  const std::string& path = tiff.file()->path();
  if (photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_MINISWHITE) {
    std::string found = "photometric interpretation " + std::to_string(photometric);
    for (const auto& [code, name] : kColours) {
      if (code == photometric) found = name;
    }
    bad_input(path, "grey samples", found);
  }
  const auto samples = tiff.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1);
  if (samples != 1) bad_input(path, "one sample per pixel", std::to_string(samples));
  const auto depth = tiff.field<std::uint32_t>(TIFFTAG_IMAGEDEPTH, 1);
  if (depth != 1) bad_input(path, "pages of depth 1", "depth " + std::to_string(depth));
}

StoredType stored_type_of(const TiffFile& tiff) {
  const auto bits = tiff.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
  const auto format = tiff.field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  struct Known {
    int format;
    std::string_view name;
  };
  static constexpr std::array<Known, 3> kKnown{
      {{SAMPLEFORMAT_UINT, "uint"}, {SAMPLEFORMAT_INT, "int"}, {SAMPLEFORMAT_IEEEFP, "float"}}};
  const int meant = format == SAMPLEFORMAT_VOID ? SAMPLEFORMAT_UINT : format;
  for (const Known& known : kKnown) {
    const auto type = parse_stored_type(std::string(known.name) + std::to_string(bits));
    if (known.format == meant && type) return *type;
  }
  bad_input(tiff.file()->path(), "integers of 8 to 64 bits or floats of 16 to 64 bits",
            std::to_string(bits) + " bits of sample format " + std::to_string(format));
}

// Compares where the page's strips or tiles are said to lie with the file.
void check_stored(const TiffFile& tiff, const TiffPageKind& kind) {
  TIFF* const handle = tiff.handle();
  const std::string& path = tiff.file()->path();
  const std::uint64_t file_bytes = tiff.file()->size();
  const std::uint32_t count = TIFFIsTiled(handle) != 0 ? TIFFNumberOfTiles(handle) : TIFFNumberOfStrips(handle);
  std::uint64_t stored = 0;
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::uint64_t begin = TIFFGetStrileOffset(handle, n);
    const std::uint64_t bytes = TIFFGetStrileByteCount(handle, n);
    if (begin > file_bytes || bytes > file_bytes - begin) {
      bad_input(path, std::to_string(bytes) + " bytes of samples from byte " + std::to_string(begin) + " on",
                "a file of " + std::to_string(file_bytes));
    }
    stored += bytes;
  }
  const auto ratio = largest_tiff_ratio(tiff.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE));
  const auto page = static_cast<std::uint64_t>(kind.width * kind.height) * sample_bytes(kind.type.type);
  check_plausible(path, page, std::min(stored, file_bytes), ratio);
}

TiffPageKind page_kind(const TiffFile& tiff) {
  check_grey(tiff);
  const auto width = tiff.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  const auto height = tiff.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  return {static_cast<std::int64_t>(width), static_cast<std::int64_t>(height), stored_type_of(tiff)};
}

bool is_slice(const TiffFile& tiff) {
  const auto subfile = tiff.field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0);
  return (subfile & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0;
}

}  // namespace

std::uint64_t largest_tiff_ratio(std::uint16_t compression) {
  constexpr std::uint64_t kPackBits = 64;
  constexpr std::uint64_t kLzw = 4096;  // codes of 9 bits and more stand for strings of up to 4096 bytes
  constexpr std::uint64_t kOther = 1 << 20;
  switch (compression) {
    case COMPRESSION_NONE:
      return 1;
    case COMPRESSION_PACKBITS:
      return kPackBits;
    case COMPRESSION_LZW:
      return kLzw;
    case COMPRESSION_ADOBE_DEFLATE:
    case COMPRESSION_DEFLATE:
      return kDeflateRatio;
    default:
      return kOther;
  }
}

TiffPages find_tiff_pages(TiffFile& tiff) {
  TiffPages pages;
  do {
    check_tiff_directory(*tiff.file(), TIFFCurrentDirOffset(tiff.handle()));
    if (!is_slice(tiff)) {
      ++pages.left_out;
      continue;
    }
    const TiffPageKind kind = page_kind(tiff);
    if (pages.offsets.empty()) pages.kind = kind;
    if (kind != pages.kind) {
      bad_input(tiff.file()->path(),
                text_of(pages.kind) + " on page " + std::to_string(pages.offsets.size()) + " as on page 0",
                text_of(kind));
    }
    pages.numbers.push_back(static_cast<std::int64_t>(pages.offsets.size()) + pages.left_out);
    pages.offsets.push_back(TIFFCurrentDirOffset(tiff.handle()));
    // The samples of a contiguous stack are checked with their number.
    check_stored(tiff, kind);
  } while (tiff.next_directory());
  if (pages.offsets.empty()) bad_input(tiff.file()->path(), "a page that is no smaller copy or mask", "none");
  return pages;
}

}  // namespace isoweave
