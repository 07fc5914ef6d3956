// Text from files and paths on its way to a terminal: a name must not move the cursor, turn the direction of writing or
// hide.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#pragma GCC visibility push(default)
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

// The first character of a text.
// @pre The text is not empty.
TextCharacter first_character(std::string_view text);

// The text as it may appear in a message of one line: every character that is not printable becomes '?', and what is
// longer than 4096 characters is cut and ends in "...". All messages of the library are made so.
std::string printable(std::string_view text);

// The same for text of several lines: the line ends stay, and nothing is cut.
std::string printable_lines(std::string_view text);

}  // namespace isoweave
#pragma GCC visibility pop
