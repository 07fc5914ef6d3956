// PNG slices through libpng: grey of 8 or 16 bits. The slice is decoded whole, as interlaced images must be.
#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "files/quoted.hpp"
#include "isoweave/error.hpp"
#include "volume/formats/formats.hpp"

namespace isoweave {
namespace {

// libpng's state. It reports errors by jumping, so what it calls and what calls it holds nothing that needs destroying.
class PngFile {
 public:
  explicit PngFile(const FilePtr& file) : file_(file) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, keep_message, drop_message);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, &info_, nullptr);
      throw std::bad_alloc();
    }
    png_set_read_fn(png_, this, read);
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  }
  ~PngFile() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngFile(const PngFile&) = delete;
  PngFile& operator=(const PngFile&) = delete;

  [[noreturn]] void refuse(std::string_view expected) {
    const std::string found = message_[0] != '\0' ? in_quotes(message_.data()) : "damaged data";
    bad_input(file_->path(), expected, found);
  }

  std::int64_t width() const { return png_get_image_width(png_, info_); }
  std::int64_t height() const { return png_get_image_height(png_, info_); }
  int bits() const { return png_get_bit_depth(png_, info_); }
  int colour() const { return png_get_color_type(png_, info_); }

  // Reads the header. Must be called before any other member.
  bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_info(png_, info_);
    return true;
  }

  // Fills rows of the image, in the machine's byte order.
  bool read_rows(png_bytep* rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    if (std::endian::native == std::endian::little) png_set_swap(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    png_read_image(png_, rows);
    // The end of the file makes the sum of the data count.
    png_read_end(png_, nullptr);
    return true;
  }

 private:
  static void keep_message(png_structp png, png_const_charp text) {
    auto& self = *static_cast<PngFile*>(png_get_error_ptr(png));
    std::strncpy(self.message_.data(), text, self.message_.size() - 1);
    png_longjmp(png, 1);
  }
  static void drop_message(png_structp, png_const_charp) {}

  // The number of bytes read; 0 where the file cannot be read, since nothing may be thrown through libpng.
  std::size_t read_some(std::span<std::byte> out) noexcept {
    try {
      return file_->read_at(position_, out);
    } catch (const BadInput&) {
      return 0;
    }
  }

  static void read(png_structp png, png_bytep out, std::size_t count) {
    auto& self = *static_cast<PngFile*>(png_get_io_ptr(png));
    const std::size_t got = self.read_some(std::span(reinterpret_cast<std::byte*>(out), count));
    if (got < count) png_error(png, "the file ends early");
    self.position_ += count;
  }

  FilePtr file_;
  std::uint64_t position_ = 0;
  std::array<char, 128> message_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

std::vector<std::byte> decoded(PngFile& png, std::size_t bytes) {
  std::vector<std::byte> samples(bytes);
  std::vector<png_bytep> rows(static_cast<std::size_t>(png.height()));
  const std::size_t row_bytes = bytes / rows.size();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    rows[row] = reinterpret_cast<png_bytep>(samples.data() + row * row_bytes);
  }
  if (!png.read_rows(rows.data())) png.refuse("readable PNG samples");
  return samples;
}

std::string kind_of(const PngFile& png) {
  std::string colour = "colour type " + std::to_string(png.colour());
  if (png.colour() == PNG_COLOR_TYPE_GRAY) colour = "grey";
  if (png.colour() == PNG_COLOR_TYPE_GRAY_ALPHA) colour = "grey with transparency";
  if (png.colour() == PNG_COLOR_TYPE_PALETTE) colour = "a palette";
  if (png.colour() == PNG_COLOR_TYPE_RGB) colour = "RGB";
  if (png.colour() == PNG_COLOR_TYPE_RGB_ALPHA) colour = "RGB with transparency";
  return colour + " of " + std::to_string(png.bits()) + " bits";
}

}  // namespace

OpenedVolume open_png(const FilePtr& file) {
  const auto png = std::make_shared<PngFile>(file);
  if (!png->read_header()) png->refuse("a readable PNG header");
  if (png->colour() != PNG_COLOR_TYPE_GRAY || (png->bits() != 8 && png->bits() != 16)) {
    bad_input(file->path(), "grey samples of 8 or 16 bits", kind_of(*png));
  }
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "png";
  info.type = png->bits() == 8 ? SampleType::kUint8 : SampleType::kUint16;
  info.dims = {png->width(), png->height(), 1};
  info.notes.emplace_back("the spacing is not given and taken as 1");
  check_plausible(info.path, checked_volume_bytes(info), file->size(), kDeflateRatio);
  volume.held_bytes = info.slice_bytes();
  volume.samples = std::make_unique<DecodedStream>([png, bytes = info.slice_bytes()] { return decoded(*png, bytes); });
  return volume;
}

}  // namespace isoweave
