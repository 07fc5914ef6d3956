// The values of options, of all verbs: numbers, sizes, lengths, words. Every wrong value is a std::invalid_argument
// that names the option, what was expected and what was found.
#pragma once

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "isoweave/simplify_options.hpp"

namespace isoweave::cli {

[[noreturn]] void wrong_value(std::string_view option, std::string_view expected, std::string_view found);

// The parts of a text between separators: one more than there are separators.
std::vector<std::string_view> split(std::string_view text, char separator);

// The whole text as a number, or nothing.
template <class T>
std::optional<T> to_number(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// A part: "0.1" or "10%".
double parse_share(std::string_view option, std::string_view text);

double parse_number(std::string_view option, std::string_view text);
// At least 1. The example is shown where the text is no number.
std::int64_t parse_count(std::string_view option, std::string_view text, std::string_view example = "5000 or 50k");
int parse_port(std::string_view option, std::string_view text);                      // 0 to 65535
std::uint64_t parse_bytes(std::string_view option, std::string_view text);           // "800M", "2G", "1.5Gi"
std::array<double, 3> parse_triple(std::string_view option, std::string_view text);  // "x,y,z"
// Three numbers, or one for all three.
std::array<double, 3> parse_spacing(std::string_view option, std::string_view text);

// The name of a type of samples: "uint8" for "u8" or "byte", anything else as it is.
std::string type_name(std::string_view text);

std::array<std::int64_t, 3> parse_size(std::string_view option, std::string_view text);  // "N" or "WxHxD"

// Parses a text that must be one of a few words.
template <class T>
T parse_choice(std::string_view option, std::string_view text,
               std::initializer_list<std::pair<std::string_view, T>> of) {
  std::string expected;
  for (const auto& [name, value] : of) {
    if (name == text) return value;
    expected += (expected.empty() ? "" : ", ") + std::string(name);
  }
  wrong_value(option, "one of " + expected, text);
}

Quality parse_quality(std::string_view text);
int parse_threads(std::string_view text);  // 0: all

}  // namespace isoweave::cli
