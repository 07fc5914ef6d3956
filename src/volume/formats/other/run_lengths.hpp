// Bytes packed by run lengths, as AmiraMesh and SLC have them: a count of 7 bits, and a bit that says whether so many
// bytes follow, or one that is repeated.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "files/byte_stream.hpp"

namespace isoweave {

// Bytes of a stream one at a time.
class ByteReader {
 public:
  explicit ByteReader(std::unique_ptr<ByteStream> input) : input_(std::move(input)) {}

  // The next byte; nothing behind the last.
  std::optional<std::uint8_t> next();

 private:
  std::unique_ptr<ByteStream> input_;
  std::array<std::byte, 64 * 1024> buffer_;
  std::size_t used_ = 0;
  std::size_t filled_ = 0;
};

// Runs one after another, which may begin and end anywhere in what is asked for.
class RunLengths {
 public:
  // Decodes up to out.size() bytes, fewer at the end of the reader. Takes no more than it needs.
  std::size_t decode(ByteReader& reader, std::span<std::byte> out);

  // Stored bytes that were taken so far.
  std::uint64_t taken() const { return taken_; }

 private:
  std::optional<std::uint8_t> take(ByteReader& reader);

  std::uint64_t taken_ = 0;
  unsigned left_ = 0;  // bytes of the run
  bool literal_ = false;
  std::uint8_t value_ = 0;
};

// A stream of nothing but runs.
class RunStream final : public ByteStream {
 public:
  RunStream(std::unique_ptr<ByteStream> input) : reader_(std::move(input)) {}

  std::size_t read(std::span<std::byte> out) override { return runs_.decode(reader_, out); }

 private:
  ByteReader reader_;
  RunLengths runs_;
};

// The most bytes that one stored byte can stand for: two bytes are a run of 127.
inline constexpr std::uint64_t kRunRatio = 64;

}  // namespace isoweave
