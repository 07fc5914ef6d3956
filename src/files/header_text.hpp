// Pieces of text headers: lines, words, numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isoweave {

// No header is read further than this, whatever it claims.
inline constexpr std::size_t kLargestHeader = 1 << 20;

std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

// Words between blanks. They point into the text, which must not be a temporary.
std::vector<std::string_view> words_of(std::string_view text);
std::vector<std::string_view> words_of(std::string&& text) = delete;

// The whole text as one number; nothing if it is not one or does not fit.
std::optional<std::int64_t> parse_integer(std::string_view text);
std::optional<double> parse_double(std::string_view text);

// A number with E before its exponent, where Fortran and FITS may write D.
std::string with_exponent_e(std::string_view number);

// The shortest text that reads back as the same number.
std::string number_text(double value);

// A number for people, to six digits.
std::string rounded_text(double value);

// Cuts a text into lines ended by "\n" or "\r\n".
class LineReader {
 public:
  explicit LineReader(std::string_view text) : text_(text) {}

  // The next line without its end; nothing when the text is used up.
  std::optional<std::string_view> next();

  // Bytes used up so far, line ends included.
  std::size_t position() const { return position_; }

  // Whether the last line returned had a line end.
  bool ended() const { return ended_; }

 private:
  std::string_view text_;
  std::size_t position_ = 0;
  bool ended_ = false;
};

}  // namespace isoweave
