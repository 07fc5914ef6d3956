#include "volume/text_streams.hpp"

#include <charconv>
#include <cstring>
#include <system_error>

#include "volume/printable.hpp"
#include "volume/samples.hpp"

namespace isoweave {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

char TextStream::next() {
  if (used_ == filled_ && !ended_) {
    filled_ = input_->read(buffer_);
    used_ = 0;
  }
  if (ended_ || used_ == filled_) return '\0';
  const char c = std::to_integer<char>(buffer_[used_++]);
  ended_ = c == '<';
  return ended_ ? '\0' : c;
}

NumberStream::NumberStream(std::unique_ptr<ByteStream> text, SampleType type, std::uint64_t count, std::string path)
    : text_(std::move(text)), type_(type), left_(count), path_(std::move(path)) {}

std::string NumberStream::next_word() {
  constexpr std::size_t kLongest = 64;
  char c = text_.next();
  while (is_blank(c)) c = text_.next();
  std::string word;
  for (; c != '\0' && !is_blank(c) && word.size() < kLongest; c = text_.next()) word += c;
  return word;
}

bool NumberStream::next_sample() {
  if (left_ == 0) return false;
  const std::string word = next_word();
  if (word.empty()) return false;
  --left_;
  visit_sample_type(type_, [&]<class Sample>() {
    Sample value{};
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc{} || stop != end) {
      bad_input(path_, "numbers of type " + std::string(sample_type_name(type_)), quoted(word));
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
  if (error != std::errc{}) bad_input(path_, "hexadecimal digits", quoted(std::string_view(&c, 1)));
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
