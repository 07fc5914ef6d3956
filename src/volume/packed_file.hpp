// A file in gzip, or one that is packed into another one, read as what it holds.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "files/byte_stream.hpp"
#include "files/input_file.hpp"

namespace isoweave {

bool is_gzip(std::string_view head);

// A file that is inflated while it is read, in bounded memory. The first bytes are kept, and the others are read in
// their order. Reading at an earlier place inflates again from the start.
class PackedFile final : public InputFile {
 public:
  using Opener = std::function<std::unique_ptr<ByteStream>()>;

  // A file in gzip. Throws BadInput when the first bytes cannot be inflated, or there are none.
  explicit PackedFile(const FilePtr& stored, std::string_view wanted = kVolumeFile);

  // A file of the bytes that a stream gives, whose number is known before.
  PackedFile(const std::string& path, std::uint64_t bytes, Opener open);

  std::uint64_t exact_size() const override;
  bool jumps() const override { return false; }
  std::size_t read_at(std::uint64_t offset, std::span<std::byte> out) const override;
  void check_end(std::uint64_t offset) const override;

 protected:
  bool knows_size() const override { return is_size_said_ || ended_; }

 private:
  void read_head();
  bool reach(std::uint64_t offset) const;

  Opener from_start_;
  bool is_size_said_ = false;
  std::string head_;
  bool whole_ = false;  // head_ is all there is
  mutable bool ended_ = false;
  mutable std::unique_ptr<ByteStream> stream_;
  mutable std::uint64_t position_ = 0;  // of the stream
};

// The content of a file, which may be in gzip.
FilePtr unpacked(const FilePtr& file, std::string_view wanted = kVolumeFile);

}  // namespace isoweave
