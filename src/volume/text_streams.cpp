#include "volume/text_streams.hpp"

#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "files/from_chars.hpp"
#include "files/quoted.hpp"
#include "volume/samples.hpp"

namespace isoweave {
namespace {

// The whole word as a number; for a float, numbers too small for it are the nearest that it has.
template <class Number>
bool parse(std::string_view word, Number& value) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [stop, error] = number_from_chars(word.data(), word.data() + word.size(), value);
  if (stop != word.data() + word.size()) return false;
  if constexpr (std::is_same_v<Number, float>) {
    double wide = 0;
    if (error == std::errc::result_out_of_range && parse(word, wide) && std::abs(wide) < 1) {
      value = static_cast<float>(wide);
      return true;
    }
  }
  return error == std::errc{};
}

}  // namespace

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

char TextStream::next() {
  if (used_ == filled_ && !ended_) {
    filled_ = input_->read(buffer_);
    used_ = 0;
  }
  if (ended_ || used_ == filled_) return '\0';
  const char c = std::to_integer<char>(buffer_[used_++]);
  ended_ = c == '<';
  if (!ended_) ++position_;
  return ended_ ? '\0' : c;
}

std::string TextStream::next_word() {
  constexpr std::size_t kLongest = 64;
  char c = next();
  while (is_blank(c)) c = next();
  std::string word;
  for (; c != '\0' && !is_blank(c) && word.size() < kLongest; c = next()) word += c;
  return word;
}

NumberStream::NumberStream(std::unique_ptr<ByteStream> text, const NumberText& layout, std::string path)
    : text_(std::move(text)), type_(layout.type), left_(layout.count), commas_(layout.commas), path_(std::move(path)) {}

// The next word without commas around it; empty behind the last. A word of commas alone is none.
std::string NumberStream::next_number() {
  std::string word = text_.next_word();
  while (commas_ && !word.empty()) {
    const std::size_t first = word.find_first_not_of(',');
    if (first != std::string::npos) return word.substr(first, word.find_last_not_of(',') - first + 1);
    word = text_.next_word();
  }
  return word;
}

bool NumberStream::next_sample() {
  if (left_ == 0) return false;
  const std::string word = next_number();
  if (word.empty()) return false;
  --left_;
  visit_sample_type(type_, [&]<class Sample>() {
    Sample value{};
    if (!parse(word, value)) {
      bad_input(path_, "numbers of type " + std::string(sample_type_name(type_)) + (commas_ ? ", between blanks" : ""),
                in_quotes(word));
    }
    std::memcpy(sample_.data(), &value, sizeof(Sample));
    size_ = sizeof(Sample);
  });
  used_ = 0;
  return true;
}

std::size_t NumberStream::read(std::span<std::byte> out) {
  std::size_t done = 0;
  while (done < out.size() && (used_ < size_ || next_sample())) out[done++] = sample_[used_++];
  return done;
}

// The value of the next digit; -1 at the end.
int HexStream::next_digit() {
  char c = text_.next();
  while (is_blank(c)) c = text_.next();
  if (c == '\0') return -1;
  int value = 0;
  const auto [stop, error] = std::from_chars(&c, &c + 1, value, 16);
  if (error != std::errc{}) bad_input(path_, "hexadecimal digits", in_quotes(std::string_view(&c, 1)));
  return value;
}

std::size_t HexStream::read(std::span<std::byte> out) {
  for (std::size_t done = 0; done < out.size(); ++done) {
    const int high = next_digit();
    const int low = high < 0 ? -1 : next_digit();
    if (low < 0) return done;
    out[done] = static_cast<std::byte>(high << 4 | low);
  }
  return out.size();
}

}  // namespace isoweave
