// A TIFF file opened by libtiff.
#pragma once

#include <tiffio.h>

#include <cstdarg>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "volume/formats/formats.hpp"

namespace isoweave {

// A libtiff handle on an InputFile. Its messages are kept, not printed.
class TiffFile {
 public:
  // Throws BadInput for what libtiff cannot open.
  explicit TiffFile(FilePtr file);
  ~TiffFile() { TIFFClose(tiff_); }
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  TIFF* handle() const { return tiff_; }
  const FilePtr& file() const { return file_; }

  // Throws BadInput with libtiff's first message.
  [[noreturn]] void refuse(std::string_view expected) const;

  template <class Field>
  Field field(std::uint32_t tag, Field otherwise) const {
    Field value{};
    return TIFFGetFieldDefaulted(tiff_, tag, &value) == 1 ? value : otherwise;
  }

  // Steps to the next directory of the chain; false behind the last.
  bool next_directory();

 private:
  static int keep_message(TIFF* tiff, void* handle, const char* module, const char* format, va_list arguments);
  static tmsize_t read(thandle_t handle, void* out, tmsize_t count);
  static toff_t seek(thandle_t handle, toff_t offset, int whence);
  static toff_t size(thandle_t handle);

  FilePtr file_;
  std::uint64_t position_ = 0;
  std::string message_;
  TIFF* tiff_ = nullptr;
};

using TiffPtr = std::unique_ptr<TiffFile>;

}  // namespace isoweave
