#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>
#include <new>

#include "isoweave/error.hpp"
#include "render/png.hpp"

namespace isoweave::render {
namespace {

// libpng's state. It reports errors by jumping, so what it calls and what calls it holds nothing that needs destroying.
class PngWriter {
 public:
  PngWriter() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, this, keep_message, drop_message)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, &info_);
      throw std::bad_alloc();
    }
    png_set_write_fn(png_, this, append, nullptr);
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  // Rows of `channels` bytes a pixel.
  bool write(std::int64_t width, std::int64_t height, int channels, const png_byte* samples) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
                 channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(png_, 9);
    png_write_info(png_, info_);
    for (std::int64_t row = 0; row < height; ++row) png_write_row(png_, samples + row * width * channels);
    png_write_end(png_, nullptr);
    return true;
  }

  std::vector<std::byte> take() { return std::move(bytes_); }
  const char* message() const { return message_.data(); }

 private:
  static void keep_message(png_structp png, png_const_charp text) {
    auto& self = *static_cast<PngWriter*>(png_get_error_ptr(png));
    std::strncpy(self.message_.data(), text, self.message_.size() - 1);
    png_longjmp(png, 1);
  }
  static void drop_message(png_structp, png_const_charp) {}

  // False where memory is short, since nothing may be thrown through libpng.
  bool grow(std::span<const std::byte> more) noexcept {
    try {
      bytes_.insert(bytes_.end(), more.begin(), more.end());
      return true;
    } catch (const std::bad_alloc&) {
      return false;
    }
  }

  static void append(png_structp png, png_bytep bytes, std::size_t count) {
    auto& self = *static_cast<PngWriter*>(png_get_io_ptr(png));
    if (!self.grow(std::as_bytes(std::span(bytes, count)))) png_error(png, "not enough memory");
  }

  std::vector<std::byte> bytes_;
  std::array<char, 128> message_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

void require_libpng(const std::string&) {}

std::vector<std::byte> png_bytes(const Picture& picture, const std::string& path) {
  const bool opaque =
      std::all_of(picture.pixels.begin(), picture.pixels.end(), [](const auto& p) { return p[3] == 255; });
  const std::size_t channels = opaque ? 3 : 4;
  std::vector<png_byte> samples;
  samples.reserve(picture.pixels.size() * channels);
  for (const auto& pixel : picture.pixels) {
    samples.insert(samples.end(), pixel.begin(), pixel.begin() + static_cast<std::ptrdiff_t>(channels));
  }
  PngWriter png;
  if (!png.write(picture.width, picture.height, static_cast<int>(channels), samples.data())) {
    throw CannotWrite(path + ": cannot be written as PNG: " + png.message());
  }
  return png.take();
}

}  // namespace isoweave::render
