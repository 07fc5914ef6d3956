// The entropy-coded part of JPEG (ITU-T T.81, 1992, annexes C and F): Huffman codes and the numbers behind them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace isoweave {

// Codes of 1 to 16 bits, given by how many there are of each length and the symbols in the order of their codes.
class HuffmanCode {
 public:
  static constexpr int kLongest = 16;

  // False when the counts are those of no code.
  bool define(std::span<const std::byte, kLongest> counts, std::span<const std::byte> symbols);

  // Symbol of the code that the 16 bits begin with, and the code's length; 0 where there is no such code.
  struct Match {
    std::uint8_t symbol = 0;
    std::uint8_t length = 0;
  };
  Match match(std::uint32_t bits) const;

 private:
  static constexpr int kQuick = 9;  // bits looked up at once

  std::array<Match, std::size_t{1} << kQuick> quick_{};
  std::array<std::uint32_t, kLongest + 1> end_{};    // behind the last code of each length, moved up to 16 bits
  std::array<std::int32_t, kLongest + 1> offset_{};  // from a code to the place of its symbol
  std::vector<std::uint8_t> symbols_;
};

// Bits between two markers of a stream. Whoever reads past their end gets zeros; failed() tells.
class JpegBits {
 public:
  explicit JpegBits(std::span<const std::byte> stream) : stream_(stream) {}

  // The next symbol. Where no code fits the reader has failed, and it is 0.
  int symbol(const HuffmanCode& code);

  // A signed number of `bits` bits, up to 16 (T.81, F.2.2.1).
  int number(int bits);

  // Goes past the n-th restart marker, which must be next.
  void restart(std::uint32_t n);

  bool failed() const { return failed_; }

 private:
  void fill();
  std::uint32_t take(int bits);

  std::span<const std::byte> stream_;
  std::size_t at_ = 0;
  std::uint64_t bits_ = 0;  // the uppermost are next
  int count_ = 0;           // of them from the stream
  bool failed_ = false;
};

}  // namespace isoweave
