// Numbers in texts, by the standard library and without it, and CRCs of our own files.
#include <gtest/gtest.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "files/crc32.hpp"
#include "files/from_chars.hpp"
#include "files/header_text.hpp"

namespace isoweave::testing::files_numbers_test {
namespace {

struct Parsed {
  std::errc error;
  std::size_t used;
  std::uint64_t bits;
  bool operator==(const Parsed&) const = default;
};

template <class Real>
using Parser = std::from_chars_result (*)(const char*, const char*, Real&);

template <class Real>
using Bits = std::conditional_t<sizeof(Real) == 8, std::uint64_t, std::uint32_t>;

template <class Real>
Parsed parse(std::string_view text, Parser<Real> by) {
  Real value = 5;
  const auto [end, error] = by(text.data(), text.data() + text.size(), value);
  return {error, static_cast<std::size_t>(end - text.data()), std::bit_cast<Bits<Real>>(value)};
}

template <class Real>
void expect_same(std::string_view text) {
  EXPECT_EQ(parse<Real>(text, number_from_chars_by_stream), parse<Real>(text, number_from_chars)) << text;
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
    expect_same<double>(text);
    expect_same<float>(text);
  }
}

// The least numbers and the largest ones, beside those that are none; a number that is no float when a double is
// rounded.
TEST(Numbers, AStreamKnowsTheEndsOfTheRange) {
  for (const std::string_view text :
       {"0e-999", "0.000e999", "-0", "1e-999", "-1e-999", "5e-324", "2e-324", "-4e-320", "1e-310", "1e-40", "1e-45",
        "1e-46", "1.7976931348623157e308", "1.7976931348623159e308", "3.4028235e38", "3.4028236e38", "1e39",
        "1.00000017881393432617187499"}) {
    expect_same<double>(text);
    expect_same<float>(text);
  }
}

// Where the standard library has no function of its own, both are the stream.
TEST(Numbers, TheLeastOnesAreReadAndSmallerOnesRefused) {
  EXPECT_EQ(parse<double>("5e-324", number_from_chars).bits, 1U);
  EXPECT_EQ(parse<double>("-4e-320x", number_from_chars), (Parsed{std::errc{}, 7, 0x8000000000001fa0U}));
  EXPECT_EQ(parse<float>("1e-45", number_from_chars).bits, 1U);
  for (const std::string_view text : {"2e-324", "-1e-999", "2e308"}) {
    EXPECT_EQ(parse<double>(text, number_from_chars).error, std::errc::result_out_of_range) << text;
  }
  for (const std::string_view text : {"5e-46", "3.5e38"}) {
    EXPECT_EQ(parse<float>(text, number_from_chars).error, std::errc::result_out_of_range) << text;
  }
}

template <class Real>
void expect_read_back(std::uint64_t random) {
  const auto value = std::bit_cast<Real>(static_cast<Bits<Real>>(random));
  if (std::isnan(value)) return;
  const std::string text = number_text(value);
  EXPECT_EQ(parse<Real>(text, number_from_chars_by_stream).bits, std::bit_cast<Bits<Real>>(value)) << text;
}

TEST(Numbers, AStreamReadsBackWhatIsWritten) {
  std::mt19937_64 random(3);
  for (int n = 0; n < 2000; ++n) {
    expect_read_back<double>(random());
    expect_read_back<float>(random());
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
}  // namespace isoweave::testing::files_numbers_test
