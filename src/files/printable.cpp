#include "isoweave/printable.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "files/quoted.hpp"

namespace isoweave {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

// Bytes of the character that starts with this one, and the bits of its code that it holds; 0 where none starts so.
struct Lead {
  std::size_t bytes = 0;
  char32_t bits = 0;
};

Lead lead_of(unsigned char byte) {
  if (byte < 0x80U) return {1, byte};
  if (byte >= 0xc2U && byte <= 0xdfU) return {2, byte & 0x1fU};
  if (byte >= 0xe0U && byte <= 0xefU) return {3, byte & 0x0fU};
  if (byte >= 0xf0U && byte <= 0xf4U) return {4, byte & 0x07U};
  return {};
}

// Longer than it need be, half of a pair of UTF-16, or beyond Unicode.
bool is_misused(char32_t code, std::size_t bytes) {
  constexpr std::array<char32_t, 5> kSmallest{0, 0, 0x80, 0x800, 0x10000};
  return code < kSmallest.at(bytes) || (code >= 0xd800 && code <= 0xdfff) || code > 0x10ffff;
}

// Takes up to `most` characters off the text. `keep_lines`: ends of lines stay.
std::string take_printable(std::string_view& text, bool keep_lines, std::size_t most) {
  std::string result;
  for (std::size_t count = 0; !text.empty() && count < most; ++count) {
    const TextCharacter character = first_character(text);
    const bool keep = character.is_printable() || (keep_lines && character.code == U'\n');
    result += keep ? text.substr(0, character.bytes) : "?";
    text.remove_prefix(character.bytes);
  }
  return result;
}

}  // namespace

bool TextCharacter::is_printable() const {
  struct Range {
    char32_t first, last;
  };
  // Controls; soft hyphen and other invisible ones; marks and overrides of direction; joiners and ends of lines; the
  // mark of the byte order; notes between lines; tags.
  static constexpr std::array<Range, 12> kHidden{{{0, 0x1f},
                                                  {0x7f, 0x9f},
                                                  {0xad, 0xad},
                                                  {0x61c, 0x61c},
                                                  {0x180e, 0x180e},
                                                  {0x200b, 0x200f},
                                                  {0x2028, 0x202e},
                                                  {0x2060, 0x206f},
                                                  {0xfeff, 0xfeff},
                                                  {0xfff9, 0xfffb},
                                                  {0xfffe, 0xffff},
                                                  {0xe0000, 0xe007f}}};
  return valid && std::ranges::none_of(kHidden, [this](const Range& r) { return code >= r.first && code <= r.last; });
}

TextCharacter first_character(std::string_view text) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(text[n]); };
  const Lead lead = lead_of(byte(0));
  if (lead.bytes == 0 || lead.bytes > text.size()) return {};
  char32_t code = lead.bits;
  for (std::size_t n = 1; n < lead.bytes; ++n) {
    if ((byte(n) & 0xc0U) != 0x80U) return {};
    code = code << 6U | (byte(n) & 0x3fU);
  }
  if (is_misused(code, lead.bytes)) return {};
  return {code, lead.bytes, true};
}

std::string printable(std::string_view text) {
  constexpr std::size_t kLongest = 4096;
  const std::string result = take_printable(text, false, kLongest);
  return text.empty() ? result : result + "...";
}

std::string printable_lines(std::string_view text) { return take_printable(text, true, kAll); }

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kShown = 60;
  return "'" + take_printable(text, false, kShown) + "'";
}

}  // namespace isoweave
