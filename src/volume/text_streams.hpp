// Samples that are kept as text: numbers between blanks, or two hexadecimal digits for each byte.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "files/byte_stream.hpp"
#include "isoweave/volume.hpp"

namespace isoweave {

bool is_blank(char c);

// Characters of a stream one at a time, up to a '<' or the end.
class TextStream {
 public:
  explicit TextStream(std::unique_ptr<ByteStream> input) : input_(std::move(input)) {}

  // The next character; 0 behind the last.
  char next();

  // The next run of characters that are not blanks, at most 64 of them; empty behind the last.
  std::string next_word();

  // Characters that were handed out.
  std::uint64_t position() const { return position_; }

 private:
  std::unique_ptr<ByteStream> input_;
  std::uint64_t position_ = 0;
  std::array<std::byte, 64 * 1024> buffer_;
  std::size_t used_ = 0;
  std::size_t filled_ = 0;
  bool ended_ = false;
};

struct NumberText {
  SampleType type = SampleType::kUint8;
  std::uint64_t count = 0;  // of samples
  bool commas = false;      // may stand before and behind numbers
};

// Numbers between blanks as samples in the machine's byte order; what follows them is not read. A comma inside of a
// number is refused: it may be that of a decimal fraction.
class NumberStream final : public ByteStream {
 public:
  NumberStream(std::unique_ptr<ByteStream> text, const NumberText& layout, std::string path);

  std::size_t read(std::span<std::byte> out) override;

 private:
  std::string next_number();
  bool next_sample();

  TextStream text_;
  SampleType type_;
  std::uint64_t left_;  // samples
  bool commas_;
  std::string path_;
  std::array<std::byte, 8> sample_{};
  std::size_t used_ = 0;  // bytes of the sample
  std::size_t size_ = 0;
};

// Bytes in hexadecimal digits, two for each, with blanks anywhere.
class HexStream final : public ByteStream {
 public:
  HexStream(std::unique_ptr<ByteStream> text, std::string path) : text_(std::move(text)), path_(std::move(path)) {}

  std::size_t read(std::span<std::byte> out) override;

 private:
  int next_digit();

  TextStream text_;
  std::string path_;
};

}  // namespace isoweave
