// Entries of a zip archive, read forward one at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "write/mesh_input.hpp"

namespace isoweave::mesh_io {

// What the directory says of an entry.
struct ZipRecord {
  std::string name;
  std::uint64_t flags = 0, method = 0, crc = 0, packed = 0, bytes = 0, offset = 0;
};

// The directory, which may have a comment behind it.
std::vector<ZipRecord> read_zip_directory(MeshInput& input);

// The text of an entry, stored or deflated. Never gives more than the directory says, and checks length and CRC-32 at
// the end. The input moves with it, so one is read at a time.
class ZipText {
 public:
  ZipText(MeshInput& input, const ZipRecord& record);
  ~ZipText();
  ZipText(const ZipText&) = delete;
  ZipText& operator=(const ZipText&) = delete;

  // The next character, or -1 at the end.
  int get() {
    if (next_ == filled_ && !refill()) return -1;
    return static_cast<unsigned char>(text_[next_++]);
  }

 private:
  struct Inflater;

  void open_entry();
  bool refill();
  std::size_t copy_some();
  std::size_t inflate_some();

  MeshInput& input_;
  ZipRecord record_;
  std::uint64_t packed_left_ = 0, left_ = 0;
  std::uint64_t found_crc_ = 0;
  std::vector<std::byte> packed_text_;
  std::string text_;
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
  std::unique_ptr<Inflater> inflater_;
};

}  // namespace isoweave::mesh_io
