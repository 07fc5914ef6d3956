// Texts in a zip archive, read character by character.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mesh/read/mesh_input.hpp"
#include "volume/zip_file.hpp"

namespace isoweave::mesh_io {

using isoweave::ZipRecord;

inline std::vector<ZipRecord> read_zip_directory(const MeshInput& input) {
  return isoweave::read_zip_directory(input.file());
}

// The text of an entry. Fails where it is not as the directory says.
class ZipText {
 public:
  ZipText(const MeshInput& input, const ZipRecord& record)
      : bytes_(open_zip_entry(input.file(), record)),
        text_(static_cast<std::size_t>(std::min<std::uint64_t>(kBufferBytes, record.bytes)), '\0') {}

  // The next character, or -1 at the end.
  int get() {
    if (next_ == filled_ && !refill()) return -1;
    return static_cast<unsigned char>(text_[next_++]);
  }

 private:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 18;

  bool refill() {
    next_ = 0;
    filled_ = bytes_->read(std::as_writable_bytes(std::span(text_)));
    return filled_ > 0;
  }

  std::unique_ptr<ByteStream> bytes_;
  std::string text_;
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
};

}  // namespace isoweave::mesh_io
