#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>

#include "isoweave/render.hpp"
#include "render/colours.hpp"
#include "render/drawing.hpp"

namespace isoweave {
namespace {

using render::kLetterColumns;

constexpr int kDigits = 4;
// In dots, of which a letter has five by seven: from left to right.
constexpr std::int64_t kGap = 6, kBar = 12, kBeside = 4, kLetter = kLetterColumns + 1, kMostLetters = 10;
constexpr std::int64_t kStrip = kGap + kBar + kBeside + kMostLetters * kLetter + kGap;
constexpr std::int64_t kMargin = 8;  // an eighth of the height lies above the bar and below

std::string text_of(double number) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, kDigits);
  return {text.data(), end.ptr};
}

// Draws a number from a column on, with the middle of its letters at a row.
void draw_number(Picture& picture, std::int64_t left, std::int64_t middle, double number, const Colour& colour) {
  const std::int64_t dot = render::dot_of(picture.height);
  for (const char letter : text_of(number)) {
    const render::Place place{static_cast<double>(left) + static_cast<double>(kLetterColumns * dot) / 2,
                              static_cast<double>(middle)};
    render::draw_letter(picture, place, letter, dot, {colour});
    left += kLetter * dot;
  }
}

}  // namespace

std::int64_t colour_bar_width(std::int64_t height) { return kStrip * render::dot_of(height); }

Picture with_colour_bar(const Picture& picture, const std::array<double, 2>& range,
                        const std::optional<Colour>& background) {
  Picture wider{picture.width + colour_bar_width(picture.height), picture.height, {}};
  wider.pixels.resize(static_cast<std::size_t>(wider.width * wider.height));
  if (background) render::fill(wider, {0, 0, wider.width, wider.height}, {*background});
  for (std::int64_t row = 0; row < picture.height; ++row) {
    std::copy_n(picture.pixels.begin() + row * picture.width, picture.width, wider.pixels.begin() + row * wider.width);
  }
  const std::int64_t dot = render::dot_of(picture.height);
  const std::int64_t top = picture.height / kMargin, rows = picture.height - 2 * top;
  const std::int64_t left = picture.width + kGap * dot;
  for (std::int64_t row = 0; row < rows; ++row) {
    const Vec3 light = render::viridis(1 - (static_cast<double>(row) + 0.5) / static_cast<double>(rows));
    const Colour colour{render::byte_of_light(light.x), render::byte_of_light(light.y), render::byte_of_light(light.z)};
    render::fill(wider, {left, top + row, kBar * dot, 1}, {colour});
  }
  const std::uint8_t shade = render::is_dark(background) ? 235 : 30;
  for (const double part : {0.0, 0.5, 1.0}) {
    draw_number(wider, left + (kBar + kBeside) * dot,
                top + static_cast<std::int64_t>((1 - part) * static_cast<double>(rows)),
                (1 - part) * range[0] + part * range[1], {shade, shade, shade});
  }
  return wider;
}

}  // namespace isoweave
