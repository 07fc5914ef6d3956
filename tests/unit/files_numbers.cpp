// Numbers in texts, by the standard library and without it, and CRCs of our own files.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "files/crc32.hpp"
#include "files/from_chars.hpp"
#include "files/header_text.hpp"

namespace isoweave::testing {
namespace {

struct Parsed {
  std::errc error;
  std::size_t used;
  std::uint64_t bits;
  bool operator==(const Parsed&) const = default;
};

Parsed parse(std::string_view text, decltype(double_from_chars)* by) {
  double value = 5;
  const auto [end, error] = by(text.data(), text.data() + text.size(), value);
  return {error, static_cast<std::size_t>(end - text.data()), std::bit_cast<std::uint64_t>(value)};
}

TEST(Numbers, AStreamReadsThemAsTheLibraryDoes) {
  for (const std::string_view text : {"",
                                      "-",
                                      "+1",
                                      "1",
                                      "-1",
                                      "1.",
                                      ".5",
                                      "-.5",
                                      ".",
                                      "-.",
                                      "1e5",
                                      "1e",
                                      "1e+",
                                      "1E-3x",
                                      "1.5mm",
                                      "0.1vox",
                                      "e5",
                                      "--1",
                                      "-+1",
                                      "1e999",
                                      "-1e999",
                                      "inf",
                                      "-INF",
                                      "Infinity",
                                      "infinit",
                                      "nan",
                                      "-nan",
                                      "0x10",
                                      "1,5",
                                      " 1",
                                      "123456789012345678901234567890",
                                      "2.2250738585072014e-308",
                                      "1_000",
                                      "1e5.5",
                                      "..5",
                                      "5e-"}) {
    EXPECT_EQ(parse(text, double_from_chars_by_stream), parse(text, double_from_chars)) << text;
  }
}

TEST(Numbers, AStreamReadsBackWhatIsWritten) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 2000; ++n) {
    const auto value = std::bit_cast<double>(random() & 0xffefffffffffffffULL);
    const std::string text = number_text(value);
    EXPECT_EQ(parse(text, double_from_chars_by_stream).bits, std::bit_cast<std::uint64_t>(value)) << text;
  }
}

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST(Crc32, OfATextByItsPartsInAnyWay) {
  EXPECT_EQ(add_to_crc(0, bytes_of("123456789")), 0xcbf43926U);
  EXPECT_EQ(add_to_crc(0, {}), 0U);
  const std::vector<std::byte> text = bytes_of("The quick brown fox jumps over the lazy dog");
  const std::uint32_t whole = add_to_crc(0, text);
  EXPECT_EQ(whole, 0x414fa339U);
  for (std::size_t n = 0; n <= text.size(); ++n) {
    const auto first = std::span(text).first(n);
    const auto second = std::span(text).subspan(n);
    EXPECT_EQ(add_to_crc(add_to_crc(0, first), second), whole) << n;
    EXPECT_EQ(join_crcs(add_to_crc(0, first), add_to_crc(0, second), second.size()), whole) << n;
  }
}

}  // namespace
}  // namespace isoweave::testing
