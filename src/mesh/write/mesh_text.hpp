// Numbers and points as text, for the formats that are text.
#pragma once

#include <array>
#include <charconv>
#include <string>

#include "isoweave/mesh.hpp"

namespace isoweave {

inline constexpr std::size_t kTextAtOnce = std::size_t{1} << 16;  // handed on when there is so much of it

// The fewest digits that read back as the same number.
template <class Number>
void print(std::string& text, Number number) {
  char digits[32];
  const std::to_chars_result result = std::to_chars(digits, digits + sizeof(digits), number);
  text.append(digits, result.ptr);
}

// Three numbers with a blank before each.
template <class Coordinate>
void print_point(std::string& text, const std::array<Coordinate, 3>& point) {
  for (const Coordinate coordinate : point) {
    text += ' ';
    print(text, coordinate);
  }
}

}  // namespace isoweave
