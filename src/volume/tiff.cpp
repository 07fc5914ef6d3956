// TIFF and BigTIFF stacks through libtiff: one directory per slice, in strips or tiles, of any compression that libtiff
// decodes. A band (a strip or a row of tiles) is held at a time.
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/error.hpp"
#include "volume/formats.hpp"
#include "volume/geometry.hpp"
#include "volume/header_text.hpp"
#include "volume/printable.hpp"
#include "volume/stack_description.hpp"
#include "volume/tiff_directory.hpp"

namespace isoweave {
namespace {

// A libtiff handle on an InputFile. Its messages are kept, not printed.
class TiffFile {
 public:
  explicit TiffFile(FilePtr file) : file_(std::move(file)) {
    TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
    if (options == nullptr) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options, drop_message, this);
    // What libtiff keeps is no larger than what is stored, but for the state of the decoders.
    constexpr std::uint64_t kDecoders = 64 << 20;
    TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(file_->size() + kDecoders));
    tiff_ = TIFFClientOpenExt(file_->path().c_str(), "rm", this, read, write, seek, close, size, map, unmap, options);
    TIFFOpenOptionsFree(options);
    if (tiff_ == nullptr) refuse("a readable TIFF file");
  }
  ~TiffFile() { TIFFClose(tiff_); }
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  TIFF* handle() const { return tiff_; }
  const FilePtr& file() const { return file_; }

  [[noreturn]] void refuse(std::string_view expected) const {
    bad_input(file_->path(), expected, message_.empty() ? "damaged data" : quoted(message_));
  }

  template <class Field>
  Field field(std::uint32_t tag, Field otherwise) const {
    Field value{};
    return TIFFGetFieldDefaulted(tiff_, tag, &value) == 1 ? value : otherwise;
  }

  // Steps to the next directory of the chain; false behind the last.
  bool next_directory() {
    if (TIFFLastDirectory(tiff_) != 0) return false;
    if (TIFFReadDirectory(tiff_) == 0) refuse("a readable TIFF directory");
    return true;
  }

 private:
  static TiffFile& self(void* handle) { return *static_cast<TiffFile*>(handle); }

  static int keep_message(TIFF*, void* handle, const char*, const char* format, va_list arguments) {
    if (!self(handle).message_.empty()) return 1;
    std::array<char, 256> text{};
    std::vsnprintf(text.data(), text.size(), format, arguments);
    self(handle).message_ = text.data();
    return 1;
  }
  static int drop_message(TIFF*, void*, const char*, const char*, va_list) { return 1; }

  static tmsize_t read(thandle_t handle, void* out, tmsize_t count) {
    TiffFile& tiff = self(handle);
    try {
      const std::span<std::byte> wanted(static_cast<std::byte*>(out), static_cast<std::size_t>(count));
      const std::size_t got = tiff.file_->read_at(tiff.position_, wanted);
      tiff.position_ += got;
      return static_cast<tmsize_t>(got);
    } catch (const BadInput& error) {
      // libtiff is C: nothing may be thrown through it.
      tiff.message_ = error.what();
      return -1;
    }
  }
  static tmsize_t write(thandle_t, void*, tmsize_t) { return -1; }
  static toff_t seek(thandle_t handle, toff_t offset, int whence) {
    TiffFile& tiff = self(handle);
    const std::uint64_t base = whence == SEEK_CUR ? tiff.position_ : whence == SEEK_END ? tiff.file_->size() : 0;
    return tiff.position_ = base + offset;
  }
  static int close(thandle_t) { return 0; }
  static toff_t size(thandle_t handle) { return self(handle).file_->size(); }
  static int map(thandle_t, void**, toff_t*) { return 0; }
  static void unmap(thandle_t, void*, toff_t) {}

  FilePtr file_;
  std::uint64_t position_ = 0;
  std::string message_;
  TIFF* tiff_ = nullptr;
};

using TiffPtr = std::unique_ptr<TiffFile>;

// What must be the same on all pages.
struct PageKind {
  std::int64_t width = 0;
  std::int64_t height = 0;
  SampleType type = SampleType::kUint8;

  bool operator==(const PageKind&) const = default;
};

std::string text_of(const PageKind& kind) {
  return std::to_string(kind.width) + " x " + std::to_string(kind.height) + " " +
         std::string(sample_type_name(kind.type));
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

SampleType sample_type_of(const TiffFile& tiff) {
  const auto bits = tiff.field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE, 1);
  const auto format = tiff.field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
  struct Known {
    int bits;
    int format;
    SampleType type;
  };
  static constexpr std::array<Known, 8> kKnown{{{8, SAMPLEFORMAT_UINT, SampleType::kUint8},
                                                {8, SAMPLEFORMAT_INT, SampleType::kInt8},
                                                {16, SAMPLEFORMAT_UINT, SampleType::kUint16},
                                                {16, SAMPLEFORMAT_INT, SampleType::kInt16},
                                                {32, SAMPLEFORMAT_UINT, SampleType::kUint32},
                                                {32, SAMPLEFORMAT_INT, SampleType::kInt32},
                                                {32, SAMPLEFORMAT_IEEEFP, SampleType::kFloat32},
                                                {64, SAMPLEFORMAT_IEEEFP, SampleType::kFloat64}}};
  const int meant = format == SAMPLEFORMAT_VOID ? SAMPLEFORMAT_UINT : format;
  for (const Known& known : kKnown) {
    if (known.bits == bits && known.format == meant) return known.type;
  }
  bad_input(tiff.file()->path(), "integers of 8, 16 or 32 bits or floats of 32 or 64 bits",
            std::to_string(bits) + " bits of sample format " + std::to_string(format));
}

// How many bytes one stored byte can become.
std::uint64_t largest_ratio(std::uint16_t compression) {
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

// Compares where the page's strips or tiles are said to lie with the file.
void check_stored(const TiffFile& tiff, const PageKind& kind) {
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
  const auto ratio = largest_ratio(tiff.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE));
  const auto page = static_cast<std::uint64_t>(kind.width * kind.height) * sample_bytes(kind.type);
  check_plausible(path, page, std::min(stored, file_bytes), ratio);
}

PageKind page_kind(const TiffFile& tiff) {
  check_grey(tiff);
  const auto width = tiff.field<std::uint32_t>(TIFFTAG_IMAGEWIDTH, 0);
  const auto height = tiff.field<std::uint32_t>(TIFFTAG_IMAGELENGTH, 0);
  return {static_cast<std::int64_t>(width), static_cast<std::int64_t>(height), sample_type_of(tiff)};
}

// The slices of a file that is one page after another.
struct Pages {
  PageKind kind;
  std::vector<std::uint64_t> offsets;  // of their directories
  std::int64_t left_out = 0;           // masks and smaller copies
};

bool is_slice(const TiffFile& tiff) {
  const auto subfile = tiff.field<std::uint32_t>(TIFFTAG_SUBFILETYPE, 0);
  return (subfile & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0;
}

// Looks at every directory, so that a page that does not fit the others is found now.
Pages find_pages(TiffFile& tiff) {
  Pages pages;
  do {
    check_tiff_directory(*tiff.file(), TIFFCurrentDirOffset(tiff.handle()));
    if (!is_slice(tiff)) {
      ++pages.left_out;
      continue;
    }
    const PageKind kind = page_kind(tiff);
    if (pages.offsets.empty()) pages.kind = kind;
    if (kind != pages.kind) {
      bad_input(tiff.file()->path(),
                text_of(pages.kind) + " on page " + std::to_string(pages.offsets.size()) + " as on page 0",
                text_of(kind));
    }
    pages.offsets.push_back(TIFFCurrentDirOffset(tiff.handle()));
    // The samples of a contiguous stack are checked with their number.
    check_stored(tiff, kind);
  } while (tiff.next_directory());
  if (pages.offsets.empty()) bad_input(tiff.file()->path(), "a page that is no smaller copy or mask", "none");
  return pages;
}

// The samples of a list of pages, decoded band by band, in the machine's byte order.
class PageStream final : public ByteStream {
 public:
  PageStream(TiffPtr tiff, const PageKind& kind, std::vector<std::uint64_t> pages)
      : tiff_(std::move(tiff)), kind_(kind), pages_(std::move(pages)) {
    sample_bytes_ = sample_bytes(kind.type);
    row_bytes_ = static_cast<std::size_t>(kind.width) * sample_bytes_;
  }

  std::size_t read(std::span<std::byte> out) override {
    std::size_t done = 0;
    while (done < out.size() && at_band()) {
      if (!decoded_) decode();
      const std::size_t step = std::min(out.size() - done, band_bytes() - used_);
      std::memcpy(out.data() + done, band_.data() + used_, step);
      done += step;
      advance(step);
    }
    return done;
  }

  std::uint64_t skip(std::uint64_t count) override {
    std::uint64_t done = 0;
    while (done < count && at_band()) {
      const std::uint64_t step = std::min<std::uint64_t>(count - done, band_bytes() - used_);
      // A band that is skipped whole need not be decoded.
      if (!decoded_ && step < band_bytes()) decode();
      done += step;
      advance(static_cast<std::size_t>(step));
    }
    return done;
  }

 private:
  // Whether there is a band to read from; enters the next page where one has ended.
  bool at_band() {
    if (page_ >= pages_.size()) return false;
    if (!entered_) enter_page();
    return true;
  }

  void enter_page() {
    TIFF* const handle = tiff_->handle();
    if (TIFFSetSubDirectory(handle, pages_[page_]) == 0) tiff_->refuse("a readable TIFF directory");
    tiled_ = TIFFIsTiled(handle) != 0;
    tile_width_ = tiled_ ? tiff_->field<std::uint32_t>(TIFFTAG_TILEWIDTH, 0) : 0;
    const std::uint32_t rows = tiled_ ? tiff_->field<std::uint32_t>(TIFFTAG_TILELENGTH, 0)
                                      : tiff_->field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP, 0);
    if (rows == 0 || (tiled_ && tile_width_ == 0)) {
      bad_input(tiff_->file()->path(), "strips or tiles of at least one row", "none");
    }
    tile_rows_ = rows;
    band_rows_ = std::min<std::int64_t>(rows, kind_.height);
    ratio_ = largest_ratio(tiff_->field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE));
    entered_ = true;
    row_ = 0;
  }

  std::size_t band_bytes() const {
    return static_cast<std::size_t>(std::min(band_rows_, kind_.height - row_)) * row_bytes_;
  }

  void advance(std::size_t bytes) {
    used_ += bytes;
    if (used_ < band_bytes()) return;
    used_ = 0;
    decoded_ = false;
    row_ += band_rows_;
    if (row_ < kind_.height) return;
    entered_ = false;
    ++page_;
  }

  void decode() {
    band_.resize(band_bytes());
    if (tiled_) {
      decode_tiles();
    } else {
      decode_strip();
    }
    decoded_ = true;
  }

  std::string place(std::uint32_t strile) const {
    return (tiled_ ? "tile " : "strip ") + std::to_string(strile) + " of page " + std::to_string(page_);
  }

  void check_decoded(std::int64_t got, std::size_t wanted, std::uint32_t strile) const {
    if (got == static_cast<std::int64_t>(wanted)) return;
    if (got < 0) tiff_->refuse("a readable " + place(strile));
    bad_input(tiff_->file()->path(), std::to_string(wanted) + " bytes in " + place(strile), std::to_string(got));
  }

  void decode_strip() {
    const auto strip = static_cast<std::uint32_t>(row_ / band_rows_);
    check_plausible(tiff_->file()->path(), band_.size(), TIFFGetStrileByteCount(tiff_->handle(), strip), ratio_);
    const auto got = TIFFReadEncodedStrip(tiff_->handle(), strip, band_.data(), static_cast<tmsize_t>(band_.size()));
    check_decoded(got, band_.size(), strip);
  }

  // A row of tiles, of which the last may hang over the edge.
  void decode_tiles() {
    for (std::int64_t left = 0; left < kind_.width; left += tile_width_) {
      const std::uint32_t tile =
          TIFFComputeTile(tiff_->handle(), static_cast<std::uint32_t>(left), static_cast<std::uint32_t>(row_), 0, 0);
      decode_tile(tile);
      const auto columns = static_cast<std::size_t>(std::min<std::int64_t>(tile_width_, kind_.width - left));
      const std::size_t tile_row = static_cast<std::size_t>(tile_width_) * sample_bytes_;
      for (std::size_t row = 0; row * row_bytes_ < band_.size(); ++row) {
        std::memcpy(band_.data() + row * row_bytes_ + static_cast<std::size_t>(left) * sample_bytes_,
                    tile_.data() + row * tile_row, columns * sample_bytes_);
      }
    }
  }

  void decode_tile(std::uint32_t tile) {
    std::uint64_t bytes = 0;
    const std::uint64_t samples = static_cast<std::uint64_t>(tile_width_) * static_cast<std::uint64_t>(tile_rows_);
    if (__builtin_mul_overflow(samples, sample_bytes_, &bytes)) {
      bad_input(tiff_->file()->path(), "tiles of fewer than 2^63 bytes", "larger ones");
    }
    check_plausible(tiff_->file()->path(), bytes, TIFFGetStrileByteCount(tiff_->handle(), tile), ratio_);
    tile_.resize(static_cast<std::size_t>(bytes));
    const auto got = TIFFReadEncodedTile(tiff_->handle(), tile, tile_.data(), static_cast<tmsize_t>(tile_.size()));
    check_decoded(got, tile_.size(), tile);
  }

  TiffPtr tiff_;
  PageKind kind_;
  std::vector<std::uint64_t> pages_;
  std::size_t sample_bytes_ = 1;
  std::size_t row_bytes_ = 0;

  std::size_t page_ = 0;
  bool entered_ = false;
  bool tiled_ = false;
  std::int64_t tile_width_ = 0;
  std::int64_t tile_rows_ = 0;
  std::int64_t band_rows_ = 0;  // of the page's strips or tiles, no more than it has
  std::uint64_t ratio_ = 1;

  std::int64_t row_ = 0;  // first row of the band
  bool decoded_ = false;
  std::size_t used_ = 0;  // bytes of the band
  std::vector<std::byte> band_;
  std::vector<std::byte> tile_;
};

std::string description_of(const TiffFile& tiff) {
  const char* text = nullptr;
  if (TIFFGetField(tiff.handle(), TIFFTAG_IMAGEDESCRIPTION, &text) != 1 || text == nullptr) return {};
  return text;
}

// Samples per unit of length along x and y, as ImageJ uses the tags of a printer's resolution.
void use_resolution(StackDescription& stack, const TiffFile& tiff) {
  constexpr float kPrinter = 72;
  const std::array<float, 2> resolution{tiff.field<float>(TIFFTAG_XRESOLUTION, 0),
                                        tiff.field<float>(TIFFTAG_YRESOLUTION, 0)};
  const auto unit = tiff.field<std::uint16_t>(TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
  if (stack.unit.empty() && unit == RESUNIT_INCH && resolution[0] == kPrinter) return;
  if (stack.unit.empty() && unit == RESUNIT_INCH) stack.unit = "inch";
  if (stack.unit.empty() && unit == RESUNIT_CENTIMETER) stack.unit = "cm";
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (resolution[axis] > 0) stack.spacing[axis] = 1 / static_cast<double>(resolution[axis]);
  }
}

void set_axes(VolumeInfo& info, const StackDescription& stack) {
  const LengthUnit unit = length_unit(stack.unit);
  if (!unit.note.empty()) info.notes.push_back(unit.note);
  Axes axes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = stack.spacing[axis] ? *stack.spacing[axis] * unit.scale : 1;
    axes.steps[axis][axis] = step;
    axes.origin[axis] = stack.origin_samples[axis] == 0 ? 0 : -stack.origin_samples[axis] * step;
    if (!stack.spacing[axis]) {
      info.notes.push_back("the spacing of axis " + std::to_string(axis) + " is not given and taken as 1");
    }
  }
  set_geometry(info.geometry, axes, info.path);
  info.geometry.unit = unit.unit;
}

void note_peculiarities(VolumeInfo& info, const TiffFile& tiff, const Pages& pages) {
  if (tiff.field<std::uint16_t>(TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) == PHOTOMETRIC_MINISWHITE) {
    info.notes.push_back("0 stands for white in this file; samples are read as stored");
  }
  const auto orientation = tiff.field<std::uint16_t>(TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
  if (orientation != ORIENTATION_TOPLEFT) {
    info.notes.push_back("the display orientation " + std::to_string(orientation) + " is not applied");
  }
  if (pages.left_out > 0) {
    info.notes.push_back(std::to_string(pages.left_out) + " pages are masks or smaller copies and are left out");
  }
}

// The pages of the first channel and frame.
std::vector<std::uint64_t> first_of(const Pages& pages, const StackDescription& stack, const std::string& path) {
  const auto found = static_cast<std::int64_t>(pages.offsets.size());
  if (stack.images == 0) return pages.offsets;
  if (stack.images != found) {
    bad_input(path, std::to_string(stack.images) + " pages by its description", std::to_string(found));
  }
  if (stack.slices == 0) return pages.offsets;
  std::vector<std::uint64_t> slices;
  for (std::int64_t n = 0; n < stack.slices; ++n) {
    slices.push_back(pages.offsets[static_cast<std::size_t>(n * stack.step)]);
  }
  return slices;
}

// ImageJ writes stacks beyond 4 GB as one directory, with the samples of all images behind one another.
bool is_contiguous(const TiffFile& tiff, const Pages& pages, const StackDescription& stack) {
  return stack.writer == StackDescription::Writer::kImageJ && stack.images > 1 && pages.offsets.size() == 1 &&
         tiff.field<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_NONE;
}

std::unique_ptr<ByteStream> contiguous_samples(const TiffFile& tiff, const VolumeInfo& info,
                                               const StackDescription& stack) {
  const FilePtr& file = tiff.file();
  const std::uint64_t begin = TIFFGetStrileOffset(tiff.handle(), 0);
  const std::uint64_t slice = info.slice_bytes();
  std::uint64_t bytes = 0;
  const bool overflow = __builtin_mul_overflow(slice, static_cast<std::uint64_t>(stack.images), &bytes);
  if (overflow || bytes > file->size() - std::min(begin, file->size())) {
    bad_input(file->path(),
              std::to_string(stack.images) + " images of " + std::to_string(slice) + " bytes from byte " +
                  std::to_string(begin) + " on",
              "a file of " + std::to_string(file->size()));
  }
  const std::uint64_t step = slice * static_cast<std::uint64_t>(stack.step);
  const auto open = [=](std::int64_t n) {
    const std::uint64_t first = begin + static_cast<std::uint64_t>(n) * step;
    return std::make_unique<FileStream>(file, first, first + slice);
  };
  return std::make_unique<FileSequence>(info.dims[2], slice, open, [file](std::int64_t) { return file->path(); });
}

// Every file of an OME series describes the whole of it.
void describe_one_slice(StackDescription& stack, const std::string& path) {
  if (stack.writer != StackDescription::Writer::kOme) return;
  if (stack.images != stack.slices) {
    bad_input(path, "one channel and one frame in a series of files",
              std::to_string(stack.images) + " planes of " + std::to_string(stack.slices) + " slices");
  }
  stack.images = 0;
}

}  // namespace

OpenedVolume open_tiff(const FilePtr& file, bool one_of_series) {
  auto tiff = std::make_unique<TiffFile>(file);
  StackDescription stack = parse_stack_description(description_of(*tiff), file->path());
  if (one_of_series) describe_one_slice(stack, file->path());
  if (stack.writer == StackDescription::Writer::kImageJ) use_resolution(stack, *tiff);
  OpenedVolume volume;
  VolumeInfo& info = volume.info;
  info.path = file->path();
  info.format = "tiff";
  const std::uint64_t first_directory = TIFFCurrentDirOffset(tiff->handle());
  const Pages pages = find_pages(*tiff);
  if (TIFFSetSubDirectory(tiff->handle(), first_directory) == 0) tiff->refuse("a readable TIFF directory");
  info.type = pages.kind.type;
  info.dims = {pages.kind.width, pages.kind.height, 1};
  note_peculiarities(info, *tiff, pages);
  info.notes.insert(info.notes.end(), stack.notes.begin(), stack.notes.end());
  set_axes(info, stack);
  info.slope = stack.slope;
  info.intercept = stack.intercept;
  if (is_contiguous(*tiff, pages, stack)) {
    info.dims[2] = stack.slices > 0 ? stack.slices : stack.images;
    checked_volume_bytes(info);
    volume.swap_bytes = (TIFFIsBigEndian(tiff->handle()) != 0) != (std::endian::native == std::endian::big);
    volume.samples = contiguous_samples(*tiff, info, stack);
    return volume;
  }
  std::vector<std::uint64_t> slices = first_of(pages, stack, info.path);
  info.dims[2] = static_cast<std::int64_t>(slices.size());
  checked_volume_bytes(info);
  volume.samples = std::make_unique<PageStream>(std::move(tiff), pages.kind, std::move(slices));
  return volume;
}

}  // namespace isoweave
