// Text of others in our messages.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace isoweave {

// A character of a text in UTF-8, or one byte that belongs to none.
struct TextCharacter {
  char32_t code = 0;
  std::size_t bytes = 1;
  bool valid = false;

  // Whether the character shows as itself: it is no control character (of ASCII or C1), does not turn the direction of
  // writing, and is not invisible.
  bool is_printable() const;
};

// The first character of a text that is not empty.
TextCharacter first_character(std::string_view text);

// Text from a file or a path as it may appear in a one-line message: every character that is not printable becomes
// '?', and long text is cut.
std::string printable(std::string_view text);

// Makes text of several lines printable; the line ends stay, and nothing is cut.
std::string printable_lines(std::string_view text);

// The first characters of a text, printable, in single quotes.
std::string quoted(std::string_view text);

}  // namespace isoweave
