// TIFF files for tests: by libtiff, and by hand where libtiff would not write such a file.
#pragma once

#include <tiffio.h>

#include "volume_helpers.hpp"

namespace isoweave::testing {

struct TiffPage {
  std::uint32_t width = 5;
  std::uint32_t height = 4;
  std::uint16_t bits = 16;
  std::uint16_t format = SAMPLEFORMAT_UINT;
  std::uint16_t samples = 1;
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  std::uint16_t compression = COMPRESSION_NONE;
  std::uint16_t predictor = 1;
  std::uint32_t rows_per_strip = 3;
  std::uint32_t tile = 0;  // side of the tiles; 0: strips
  std::uint32_t subfile = 0;
  std::string description = {};
  float resolution = 0;
  std::uint16_t resolution_unit = RESUNIT_NONE;
};

// Writes one directory; `samples` are the machine's bytes.
inline void write_page(TIFF* tiff, const TiffPage& page, const std::string& samples) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, page.width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, page.height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, page.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, page.format);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, page.samples);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, page.photometric);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, page.compression);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  if (page.predictor != 1) TIFFSetField(tiff, TIFFTAG_PREDICTOR, page.predictor);
  if (page.subfile != 0) TIFFSetField(tiff, TIFFTAG_SUBFILETYPE, page.subfile);
  if (!page.description.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, page.description.c_str());
  if (page.resolution > 0) {
    TIFFSetField(tiff, TIFFTAG_XRESOLUTION, static_cast<double>(page.resolution));
    TIFFSetField(tiff, TIFFTAG_YRESOLUTION, static_cast<double>(page.resolution));
    TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, page.resolution_unit);
  }
  if (page.photometric == PHOTOMETRIC_PALETTE) {
    std::vector<std::uint16_t> map(std::size_t{1} << page.bits);
    TIFFSetField(tiff, TIFFTAG_COLORMAP, map.data(), map.data(), map.data());
  }
  const std::size_t bytes = page.bits / std::size_t{8} * page.samples;
  const std::size_t row_bytes = page.width * bytes;
  if (page.tile == 0) {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, page.rows_per_strip);
    for (std::uint32_t row = 0; row < page.height; row += page.rows_per_strip) {
      std::string strip = samples.substr(row * row_bytes, page.rows_per_strip * row_bytes);
      TIFFWriteEncodedStrip(tiff, row / page.rows_per_strip, strip.data(), static_cast<tmsize_t>(strip.size()));
    }
  } else {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, page.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, page.tile);
    for (std::uint32_t top = 0; top < page.height; top += page.tile) {
      for (std::uint32_t left = 0; left < page.width; left += page.tile) {
        std::string tile(std::size_t{page.tile} * page.tile * bytes, '\x5a');
        for (std::uint32_t row = top; row < std::min(page.height, top + page.tile); ++row) {
          const std::size_t columns = std::min(page.tile, page.width - left) * bytes;
          tile.replace((row - top) * page.tile * bytes, columns, samples, row * row_bytes + left * bytes, columns);
        }
        TIFFWriteTile(tiff, tile.data(), left, top, 0, 0);
      }
    }
  }
  TIFFWriteDirectory(tiff);
}

// Pages of one kind. `mode` is libtiff's: "w", "wb" for big-endian, "w8" for BigTIFF.
inline std::string write_stack(const std::string& path, const TiffPage& page, const std::string& samples,
                               const std::string& mode = "w") {
  std::filesystem::remove(path);
  TIFF* tiff = TIFFOpen(path.c_str(), mode.c_str());
  const std::size_t bytes = page.bits / std::size_t{8} * page.width * page.height * page.samples;
  TiffPage later = page;
  later.description.clear();
  for (std::size_t at = 0; at < samples.size(); at += bytes) {
    write_page(tiff, at == 0 ? page : later, samples.substr(at, bytes));
  }
  TIFFClose(tiff);
  return path;
}

// A classic TIFF of one directory whose samples, of 16 bits, end the file.
struct HandMade {
  std::uint32_t width = 5;
  std::uint32_t height = 4;
  std::uint16_t bits = 16;
  std::uint16_t compression = 1;
  std::uint32_t strip_bytes = 40;
  std::string description = {};
  bool big = true;
};

inline std::string hand_made(const HandMade& page, const std::string& samples) {
  constexpr std::uint16_t kShort = 3;
  constexpr std::uint16_t kLong = 4;
  constexpr std::uint32_t kEntries = 9;
  const std::uint32_t behind = 8 + 2 + 12 * kEntries + 4;
  const std::string text = page.description + std::string(8, '\0');
  const auto entry = [&](std::uint16_t tag, std::uint16_t type, std::uint32_t count, std::uint32_t value) {
    std::string bytes = bytes_of(tag, page.big) + bytes_of(type, page.big) + bytes_of(count, page.big);
    if (type == kShort) return bytes + bytes_of(static_cast<std::uint16_t>(value), page.big) + std::string(2, '\0');
    return bytes + bytes_of(value, page.big);
  };
  std::string file = page.big ? std::string("MM\0*", 4) : std::string("II*\0", 4);
  file += bytes_of(std::uint32_t{8}, page.big) + bytes_of(static_cast<std::uint16_t>(kEntries), page.big);
  file += entry(256, kLong, 1, page.width) + entry(257, kLong, 1, page.height) + entry(258, kShort, 1, page.bits);
  file += entry(259, kShort, 1, page.compression) + entry(262, kShort, 1, 1);
  file += entry(270, 2, static_cast<std::uint32_t>(text.size()), behind);
  file += entry(273, kLong, 1, behind + static_cast<std::uint32_t>(text.size())) + entry(278, kLong, 1, page.height);
  file += entry(279, kLong, 1, page.strip_bytes) + std::string(4, '\0');
  return file + text + samples;
}

}  // namespace isoweave::testing
