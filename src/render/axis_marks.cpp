#include "render/axis_marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/drawing.hpp"

namespace isoweave::render {
namespace {

// In dots. From the middle of the marks to the end of an axis, to its letter and to the sides of the picture.
constexpr double kArm = 22, kToLetter = 29, kToSide = kLeastSideWithAxes / 2.0;
constexpr double kWidth = 1.5;
constexpr double kShortest = 0.3;  // part of an axis that a picture shows, for its letters to be apart
constexpr double kFaint = 0.35;    // cover of an end that points away ...
constexpr double kAway = 0.2;      // ... by more than this part of it
constexpr char kNone = '\0';

using Ends = std::array<char, 2>;  // the letters of the lower and of the upper end
using Colours = std::array<Colour, 3>;

// Colours of the x, y and z axes, as on the page.
constexpr Colours kOnLight{{{179, 38, 30}, {27, 122, 67}, {31, 95, 174}}};
constexpr Colours kOnDark{{{255, 143, 134}, {111, 209, 154}, {127, 180, 238}}};

std::array<Ends, 3> letters_of(const std::string& space) {
  if (space == "RAS") return {{{'L', 'R'}, {'P', 'A'}, {'I', 'S'}}};
  if (space == "LPS") return {{{'R', 'L'}, {'A', 'P'}, {'I', 'S'}}};
  return {{{kNone, 'x'}, {kNone, 'y'}, {kNone, 'z'}}};
}

// Draws one end of an axis. end: as the camera sees it, of length 1
void draw_end(Picture& picture, const Vec3& end, char letter, const Colour& colour) {
  const std::int64_t dot = dot_of(std::min(picture.width, picture.height));
  const auto size = static_cast<double>(dot);
  const Place middle{kToSide * size, static_cast<double>(picture.height) - kToSide * size};
  const auto at = [&](double dots) {
    return Place{middle.column + dots * size * end.x, middle.row - dots * size * end.y};
  };
  const Ink ink{colour, end.z > kAway ? kFaint : 1};
  draw_line(picture, middle, at(kArm), kWidth * size, ink);
  if (std::hypot(end.x, end.y) >= kShortest) draw_letter(picture, at(kToLetter), letter, dot, ink);
}

}  // namespace

void draw_axes(Picture& picture, const Camera& camera, const std::string& space,
               const std::optional<Colour>& background) {
  const Colours& colours = is_dark(background) ? kOnDark : kOnLight;
  const std::array<Ends, 3> letters = letters_of(space);
  const std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (const bool near : {false, true}) {
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      const Vec3 seen = camera.turned(axes[axis]);
      for (std::size_t end = 0; end < 2; ++end) {
        const Vec3 way = end == 1 ? seen : -seen;
        const bool is_near = way.z <= kAway;
        if (letters[axis][end] != kNone && is_near == near) draw_end(picture, way, letters[axis][end], colours[axis]);
      }
    }
  }
}

}  // namespace isoweave::render
