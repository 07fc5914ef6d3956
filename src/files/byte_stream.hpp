// Forward-only streams of bytes in bounded memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "files/input_file.hpp"

namespace isoweave {

class ByteStream {
 public:
  virtual ~ByteStream() = default;

  // Reads up to out.size() bytes; fewer only at the end of the stream. Throws BadInput for data that are
  // corrupt, cut off inside a compressed stream, or cannot be read.
  virtual std::size_t read(std::span<std::byte> out) = 0;

  // Skips up to `count` bytes and returns the number skipped. Reads and drops them unless overridden.
  virtual std::uint64_t skip(std::uint64_t count);

  // Whether skipping costs next to nothing.
  virtual bool skips() const { return false; }
};

// Bytes [begin, end) of a file, read straight into the caller's memory.
class FileStream final : public ByteStream {
 public:
  FileStream(FilePtr file, std::uint64_t begin, std::uint64_t end);

  std::size_t read(std::span<std::byte> out) override;
  std::uint64_t skip(std::uint64_t count) override;
  bool skips() const override { return file_->jumps(); }

 private:
  FilePtr file_;
  std::uint64_t position_;
  std::uint64_t end_;
};

// Inflates a zlib stream or the members of a gzip stream, told apart by their first bytes, or a deflate stream without
// any wrapping.
class InflateStream final : public ByteStream {
 public:
  enum class Form { kZlibOrGzip, kRaw };

  // `path` names the input in messages.
  InflateStream(std::unique_ptr<ByteStream> input, std::string path, Form form = Form::kZlibOrGzip);
  ~InflateStream() override;

  std::size_t read(std::span<std::byte> out) override;

 private:
  struct State;
  void refill();
  bool at_end();
  void inflate_some();

  std::unique_ptr<ByteStream> input_;
  std::string path_;
  std::unique_ptr<State> state_;
};

// Bytes that can only be had all at once, such as a decoded slice. They are made when the first one is read.
class DecodedStream final : public ByteStream {
 public:
  using Decoder = std::function<std::vector<std::byte>()>;

  explicit DecodedStream(Decoder decode) : decode_(std::move(decode)) {}

  std::size_t read(std::span<std::byte> out) override;

 private:
  Decoder decode_;  // empty once it was called
  std::vector<std::byte> bytes_;
  std::size_t used_ = 0;
};

// Several files one after another, each giving exactly `bytes_each` bytes; one is open at a time.
class FileSequence final : public ByteStream {
 public:
  using Opener = std::function<std::unique_ptr<ByteStream>(std::int64_t index)>;
  using Namer = std::function<std::string(std::int64_t index)>;

  FileSequence(std::int64_t count, std::uint64_t bytes_each, Opener open, Namer name);

  std::size_t read(std::span<std::byte> out) override;
  std::uint64_t skip(std::uint64_t count) override;

 private:
  bool open_current();
  void advance(std::uint64_t bytes);

  std::int64_t count_;
  std::uint64_t bytes_each_;
  Opener open_;
  Namer name_;
  std::int64_t index_ = 0;
  std::uint64_t position_ = 0;  // in the current file
  std::unique_ptr<ByteStream> current_;
};

}  // namespace isoweave
