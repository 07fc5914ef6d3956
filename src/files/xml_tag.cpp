#include "files/xml_tag.hpp"

#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

namespace isoweave {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

// The bytes of a character in UTF-8.
std::string utf8(std::uint32_t code) {
  constexpr std::uint32_t kTail = 0x3f;
  const auto byte = [](std::uint32_t bits) { return static_cast<char>(bits); };
  if (code < 0x80) return {byte(code)};
  if (code < 0x800) return {byte(0xc0 | code >> 6), byte(0x80 | (code & kTail))};
  if (code < 0x10000) return {byte(0xe0 | code >> 12), byte(0x80 | (code >> 6 & kTail)), byte(0x80 | (code & kTail))};
  return {byte(0xf0 | code >> 18), byte(0x80 | (code >> 12 & kTail)), byte(0x80 | (code >> 6 & kTail)),
          byte(0x80 | (code & kTail))};
}

// "&#181;" or "&#xB5;" at the beginning of a text; nothing for what is no character.
std::optional<std::string> numbered_character(std::string_view text, std::size_t& used) {
  constexpr std::uint32_t kLast = 0x10ffff;
  const std::size_t end = text.find(';');
  if (!text.starts_with("&#") || end == std::string_view::npos) return std::nullopt;
  const bool hexadecimal = text.substr(2).starts_with('x') || text.substr(2).starts_with('X');
  const char* const first = text.data() + (hexadecimal ? 3 : 2);
  std::uint32_t code = 0;
  const auto [stop, error] = std::from_chars(first, text.data() + end, code, hexadecimal ? 16 : 10);
  if (error != std::errc{} || stop != text.data() + end || code == 0 || code > kLast) return std::nullopt;
  used = end + 1;
  return utf8(code);
}

std::string without_entities(std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
      {{"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}, {"&amp;", '&'}}};
  std::string result;
  while (!text.empty()) {
    std::size_t used = 1;
    std::string shown(1, text[0]);
    for (const auto& [entity, character] : kEntities) {
      if (!text.starts_with(entity)) continue;
      used = entity.size();
      shown = character;
    }
    if (auto character = numbered_character(text, used)) shown = std::move(*character);
    result += shown;
    text.remove_prefix(used);
  }
  return result;
}

}  // namespace

std::string xml_attribute(std::string_view tag, std::string_view name) {
  // Attribute by attribute, so that a name inside a value is not taken for one.
  std::size_t at = tag.find_first_of(kBlanks);
  while (at < tag.size()) {
    at = tag.find_first_not_of(kBlanks, at);
    if (at == std::string_view::npos) return {};
    const std::size_t equals = tag.find('=', at);
    const std::size_t open = equals == std::string_view::npos ? equals : tag.find_first_of("\"'", equals);
    if (open == std::string_view::npos) return {};
    const std::size_t close = tag.find(tag[open], open + 1);
    if (close == std::string_view::npos) return {};
    const std::string_view written = tag.substr(at, equals - at);
    if (written.substr(0, written.find_first_of(kBlanks)) == name) {
      return without_entities(tag.substr(open + 1, close - open - 1));
    }
    at = close + 1;
  }
  return {};
}

}  // namespace isoweave
