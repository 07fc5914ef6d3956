// The ways in which VTK files keep arrays beside numbers as text: base64, and blocks that are compressed one by one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "files/byte_stream.hpp"
#include "volume/text_streams.hpp"

namespace isoweave {

// Base64 in several pieces, each of which may end in padding, with blanks anywhere between groups.
class Base64Stream final : public ByteStream {
 public:
  Base64Stream(std::unique_ptr<ByteStream> text, std::string path) : text_(std::move(text)), path_(std::move(path)) {}

  std::size_t read(std::span<std::byte> out) override;

 private:
  bool next_group();

  TextStream text_;
  std::string path_;
  std::array<std::byte, 3> group_{};
  std::size_t used_ = 0;
  std::size_t size_ = 0;
};

// Bits, the most significant of a byte first, as `count` samples of one byte each.
class BitStream final : public ByteStream {
 public:
  BitStream(std::unique_ptr<ByteStream> bytes, std::uint64_t count) : bytes_(std::move(bytes)), left_(count) {}

  std::size_t read(std::span<std::byte> out) override;

 private:
  std::unique_ptr<ByteStream> bytes_;
  std::uint64_t left_;  // samples
  std::byte byte_{};
  unsigned bits_ = 0;  // of the byte, not handed out yet
};

// Sizes of compressed blocks, as the header before them has them.
struct BlockSizes {
  std::uint64_t block = 0;  // bytes of every block but the last, once inflated
  std::uint64_t last = 0;
  std::vector<std::uint64_t> stored;
};

enum class BlockForm { kZlib, kLz4, kLzma };

// One LZ4 block of `stored` bytes that gives `bytes`, decoded whole when it is first read. Throws BadInput when a block
// of that size cannot give so many, or does not.
std::unique_ptr<ByteStream> open_lz4_block(std::unique_ptr<ByteStream> input, std::uint64_t stored, std::uint64_t bytes,
                                           const std::string& path);

// Opens a block in LZMA likewise.
std::unique_ptr<ByteStream> open_lzma_block(std::unique_ptr<ByteStream> input, std::uint64_t stored,
                                            std::uint64_t bytes, const std::string& path);

// LZMA keeps about a bit per 900 bytes of a long run of one byte.
inline constexpr std::uint64_t kLzmaRatio = 8192;

// Compressed blocks one after another.
class BlockStream final : public ByteStream {
 public:
  BlockStream(std::unique_ptr<ByteStream> input, BlockForm form, BlockSizes sizes, std::string path)
      : input_(std::move(input)), form_(form), sizes_(std::move(sizes)), path_(std::move(path)) {}

  std::size_t read(std::span<std::byte> out) override;

 private:
  void enter_block();
  void leave_block();

  std::shared_ptr<ByteStream> input_;
  BlockForm form_;
  BlockSizes sizes_;
  std::string path_;
  std::size_t next_ = 0;    // block
  std::uint64_t left_ = 0;  // bytes of the current one
  std::unique_ptr<ByteStream> block_;
};

}  // namespace isoweave
