// One entry of a zip archive, read forward.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "write/mesh_input.hpp"

namespace isoweave::mesh_io {

// The text of the first entry whose name has this ending; stored or deflated. Never gives more than the directory says,
// and checks length and CRC-32 at the end.
class ZipText {
 public:
  ZipText(MeshInput& input, std::string_view ending);
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

  std::uint64_t next_number(int bytes);
  void find_entry(std::string_view ending);
  void find_directory(std::uint64_t& offset, std::uint64_t& entries);
  bool read_entry(std::string_view ending);
  void take_wide_sizes(std::uint64_t extra_bytes);
  void open_entry();
  bool refill();
  std::size_t copy_some();
  std::size_t inflate_some();

  MeshInput& input_;
  std::uint64_t method_ = 0, crc_ = 0, packed_ = 0, bytes_ = 0, offset_ = 0;  // of the entry
  std::uint64_t packed_left_ = 0, left_ = 0;
  std::uint64_t found_crc_ = 0;
  std::vector<std::byte> packed_text_;
  std::string text_;
  std::size_t next_ = 0;
  std::size_t filled_ = 0;
  std::unique_ptr<Inflater> inflater_;
};

}  // namespace isoweave::mesh_io
