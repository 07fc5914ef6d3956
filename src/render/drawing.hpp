// Boxes, lines and letters that are drawn onto a finished picture.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "isoweave/render.hpp"

namespace isoweave::render {

struct Place {
  double column = 0, row = 0;  // in pixels, from the picture's upper left corner
};

struct Box {
  std::int64_t left = 0, top = 0, width = 0, height = 0;  // in pixels
};

// A colour and the part of the light from below that it hides.
struct Ink {
  Colour colour;
  double cover = 1;
};

constexpr std::int64_t kLetterColumns = 5, kLetterRows = 7;  // in dots

// The side of a dot in pixels, for a picture whose side is as long.
std::int64_t dot_of(std::int64_t side);

// Whether a background is so dark that light colours show on it. A transparent one is not.
bool is_dark(const std::optional<Colour>& background);

void fill(Picture& picture, const Box& box, const Ink& ink);

// Draws a letter of digits, '.', '-', '+', 'e', 'x', 'y', 'z' and the ends of a patient's axes, with its middle at a
// place.
void draw_letter(Picture& picture, const Place& middle, char letter, std::int64_t dot, const Ink& ink);

// Draws a line of some width with smooth sides.
void draw_line(Picture& picture, const Place& from, const Place& to, double width, const Ink& ink);

}  // namespace isoweave::render
