#include "render/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace isoweave::render {
namespace {

using Pixel = std::array<std::uint8_t, 4>;
using Glyph = std::array<std::uint8_t, kLetterRows>;  // rows from the top, five bits each, the highest at the left

constexpr std::string_view kLetters = "0123456789.-+exyzLRAPSI";
constexpr std::array<Glyph, kLetters.size()> kGlyphs = {
    {{0b01110, 0b10001, 0b10011, 0b10101, 0b11001, 0b10001, 0b01110},
     {0b00100, 0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110},
     {0b01110, 0b10001, 0b00001, 0b00010, 0b00100, 0b01000, 0b11111},
     {0b11111, 0b00010, 0b00100, 0b00010, 0b00001, 0b10001, 0b01110},
     {0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010},
     {0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110},
     {0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110},
     {0b11111, 0b00001, 0b00010, 0b00100, 0b01000, 0b01000, 0b01000},
     {0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110},
     {0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100},
     {0, 0, 0, 0, 0, 0b01100, 0b01100},
     {0, 0, 0, 0b11111, 0, 0, 0},
     {0, 0b00100, 0b00100, 0b11111, 0b00100, 0b00100, 0},
     {0, 0, 0b01110, 0b10001, 0b11111, 0b10000, 0b01110},
     {0, 0, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001},
     {0, 0, 0b10001, 0b10001, 0b01111, 0b00001, 0b01110},
     {0, 0, 0b11111, 0b00010, 0b00100, 0b01000, 0b11111},
     {0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b10000, 0b11111},
     {0b11110, 0b10001, 0b10001, 0b11110, 0b10100, 0b10010, 0b10001},
     {0b01110, 0b10001, 0b10001, 0b11111, 0b10001, 0b10001, 0b10001},
     {0b11110, 0b10001, 0b10001, 0b11110, 0b10000, 0b10000, 0b10000},
     {0b01111, 0b10000, 0b10000, 0b01110, 0b00001, 0b00001, 0b11110},
     {0b01110, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110}}};
constexpr std::int64_t kRowsPerDot = 350;

void blend(Pixel& pixel, const Ink& ink) {
  const double below = pixel[3] / 255.0 * (1 - ink.cover);
  const double alpha = ink.cover + below;
  if (alpha <= 0) return;
  const std::array<std::uint8_t, 3> over{ink.colour.red, ink.colour.green, ink.colour.blue};
  for (std::size_t n = 0; n < over.size(); ++n) {
    pixel[n] = static_cast<std::uint8_t>(std::lround((ink.cover * over[n] + below * pixel[n]) / alpha));
  }
  pixel[3] = static_cast<std::uint8_t>(std::lround(255 * alpha));
}

// Calls a function with each pixel of a box that the picture has, and the middle of the pixel.
template <class Function>
void for_each_pixel(Picture& picture, const Box& box, Function&& function) {
  const std::int64_t right = std::min(box.left + box.width, picture.width);
  const std::int64_t bottom = std::min(box.top + box.height, picture.height);
  for (std::int64_t row = std::max<std::int64_t>(box.top, 0); row < bottom; ++row) {
    for (std::int64_t column = std::max<std::int64_t>(box.left, 0); column < right; ++column) {
      function(picture.pixels[static_cast<std::size_t>(row * picture.width + column)],
               Place{static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5});
    }
  }
}

double distance_to_line(const Place& p, const Place& from, const Place& to) {
  const double x = to.column - from.column, y = to.row - from.row;
  const double length = x * x + y * y;
  const double along = length > 0 ? ((p.column - from.column) * x + (p.row - from.row) * y) / length : 0;
  const double part = std::clamp(along, 0.0, 1.0);
  return std::hypot(p.column - from.column - part * x, p.row - from.row - part * y);
}

}  // namespace

std::int64_t dot_of(std::int64_t side) { return std::max<std::int64_t>(1, side / kRowsPerDot); }

bool is_dark(const std::optional<Colour>& background) {
  return background && background->red + background->green + background->blue < 3 * 128;
}

void fill(Picture& picture, const Box& box, const Ink& ink) {
  for_each_pixel(picture, box, [&](Pixel& pixel, const Place&) { blend(pixel, ink); });
}

void draw_letter(Picture& picture, const Place& middle, char letter, std::int64_t dot, const Ink& ink) {
  const Glyph& glyph = kGlyphs[kLetters.find(letter)];
  const auto start = [dot](double at, std::int64_t dots) {
    return std::llround(at - static_cast<double>(dots * dot) / 2);
  };
  const std::int64_t left = start(middle.column, kLetterColumns), top = start(middle.row, kLetterRows);
  for (std::int64_t row = 0; row < kLetterRows; ++row) {
    for (std::int64_t column = 0; column < kLetterColumns; ++column) {
      if ((glyph[static_cast<std::size_t>(row)] >> (kLetterColumns - 1 - column) & 1) == 0) continue;
      fill(picture, {left + column * dot, top + row * dot, dot, dot}, ink);
    }
  }
}

void draw_line(Picture& picture, const Place& from, const Place& to, double width, const Ink& ink) {
  const auto before = [&](double a, double b) { return static_cast<std::int64_t>(std::floor(std::min(a, b) - width)); };
  const auto after = [&](double a, double b) { return static_cast<std::int64_t>(std::ceil(std::max(a, b) + width)); };
  const std::int64_t left = before(from.column, to.column), top = before(from.row, to.row);
  const Box box{left, top, after(from.column, to.column) - left, after(from.row, to.row) - top};
  for_each_pixel(picture, box, [&](Pixel& pixel, const Place& middle) {
    const double inside = width / 2 + 0.5 - distance_to_line(middle, from, to);
    blend(pixel, {ink.colour, ink.cover * std::clamp(inside, 0.0, 1.0)});
  });
}

}  // namespace isoweave::render
