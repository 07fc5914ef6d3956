// PNG files for tests.
#pragma once

#include <png.h>

#include "volume_helpers.hpp"

namespace isoweave::testing::png_files {

constexpr std::size_t kWidth = 11;
constexpr std::size_t kHeight = 9;

struct PngKind {
  int bits = 16;
  int colour = PNG_COLOR_TYPE_GRAY;
  int interlace = PNG_INTERLACE_NONE;
};

// `samples` are most significant byte first, as PNG keeps them.
inline std::string write_png(const std::string& path, const PngKind& kind, std::string samples) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, kWidth, kHeight, kind.bits, kind.colour, kind.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t row_bytes = png_get_rowbytes(png, info);
  samples.resize(row_bytes * kHeight);
  std::vector<png_bytep> rows;
  for (std::size_t row = 0; row < kHeight; ++row) {
    rows.push_back(reinterpret_cast<png_bytep>(samples.data() + row * row_bytes));
  }
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  return path;
}

}  // namespace isoweave::testing::png_files
