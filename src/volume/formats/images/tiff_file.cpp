#include "volume/formats/images/tiff_file.hpp"

#include <array>
#include <cstdio>
#include <new>
#include <span>
#include <utility>

#include "files/quoted.hpp"
#include "isoweave/error.hpp"

namespace isoweave {
namespace {

int drop_message(TIFF*, void*, const char*, const char*, va_list) { return 1; }
tmsize_t write(thandle_t, void*, tmsize_t) { return -1; }
int close(thandle_t) { return 0; }
int map(thandle_t, void**, toff_t*) { return 0; }
void unmap(thandle_t, void*, toff_t) {}

TiffFile& self(void* handle) { return *static_cast<TiffFile*>(handle); }

}  // namespace

TiffFile::TiffFile(FilePtr file) : file_(std::move(file)) {
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  if (options == nullptr) throw std::bad_alloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_message, this);
  TIFFOpenOptionsSetWarningHandlerExtR(options, drop_message, this);
  // libtiff keeps no more than the stored bytes, and the state of the decoders.
  constexpr std::uint64_t kDecoders = 64 << 20;
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, static_cast<tmsize_t>(file_->size() + kDecoders));
  tiff_ = TIFFClientOpenExt(file_->path().c_str(), "rm", this, read, write, seek, close, size, map, unmap, options);
  TIFFOpenOptionsFree(options);
  if (tiff_ == nullptr) refuse("a readable TIFF file");
}

void TiffFile::refuse(std::string_view expected) const {
  bad_input(file_->path(), expected, message_.empty() ? "damaged data" : in_quotes(message_));
}

bool TiffFile::next_directory() {
  if (TIFFLastDirectory(tiff_) != 0) return false;
  if (TIFFReadDirectory(tiff_) == 0) refuse("a readable TIFF directory");
  return true;
}

int TiffFile::keep_message(TIFF*, void* handle, const char*, const char* format, va_list arguments) {
  if (!self(handle).message_.empty()) return 1;
  std::array<char, 256> text{};
  std::vsnprintf(text.data(), text.size(), format, arguments);
  self(handle).message_ = text.data();
  return 1;
}

tmsize_t TiffFile::read(thandle_t handle, void* out, tmsize_t count) {
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

toff_t TiffFile::seek(thandle_t handle, toff_t offset, int whence) {
  TiffFile& tiff = self(handle);
  const std::uint64_t base = whence == SEEK_CUR ? tiff.position_ : whence == SEEK_END ? tiff.file_->size() : 0;
  return tiff.position_ = base + offset;
}

toff_t TiffFile::size(thandle_t handle) { return self(handle).file_->size(); }

}  // namespace isoweave
