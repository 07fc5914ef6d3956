// The marks of the axes in pictures, by their letters.
// Threads: none, marks are drawn by one thread
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "isoweave/render.hpp"
#include "meshes.hpp"
#include "render_scene.hpp"

namespace isoweave::testing::render_axes_test {
namespace {

using namespace render_scene;

// Whether a letter, drawn by its dots here, is somewhere in the marks of the axes with nothing around it, and where its
// middle is.
std::optional<std::array<double, 2>> find_letter(const Picture& marks, const std::vector<std::string_view>& letter) {
  const auto is_ink = [&](std::int64_t column, std::int64_t row) {
    return column >= 0 && row >= 0 && column < marks.width && row < marks.height && alpha_at(marks, column, row) != 0;
  };
  const auto is_here = [&](std::int64_t left, std::int64_t top) {
    for (std::int64_t row = -1; row < 8; ++row) {
      for (std::int64_t column = -1; column < 6; ++column) {
        const bool within = row >= 0 && row < 7 && column >= 0 && column < 5;
        const bool expected = within && letter[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] == '#';
        if (is_ink(left + column, top + row) != expected) return false;
      }
    }
    return true;
  };
  for (std::int64_t top = 0; top + 7 <= marks.height; ++top) {
    for (std::int64_t left = 0; left + 5 <= marks.width; ++left) {
      if (is_here(left, top)) return {{static_cast<double>(left) + 2.5, static_cast<double>(top) + 3.5}};
    }
  }
  return std::nullopt;
}

const std::vector<std::string_view> kS{" ####", "#    ", "#    ", " ### ", "    #", "    #", "#### "};
const std::vector<std::string_view> kI{" ### ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", " ### "};
const std::vector<std::string_view> kL{"#    ", "#    ", "#    ", "#    ", "#    ", "#    ", "#####"};
const std::vector<std::string_view> kR{"#### ", "#   #", "#   #", "#### ", "# #  ", "#  # ", "#   #"};
const std::vector<std::string_view> kA{" ### ", "#   #", "#   #", "#####", "#   #", "#   #", "#   #"};
const std::vector<std::string_view> kP{"#### ", "#   #", "#   #", "#### ", "#    ", "#    ", "#    "};
const std::vector<std::string_view> kSmallX{"     ", "     ", "#   #", " # # ", "  #  ", " # # ", "#   #"};
const std::vector<std::string_view> kSmallY{"     ", "     ", "#   #", "#   #", " ####", "    #", " ### "};
const std::vector<std::string_view> kSmallZ{"     ", "     ", "#####", "   # ", "  #  ", " #   ", "#####"};

// The marks alone: a mesh too small to be seen, in a picture of the marks' own size. Their middle is at 36, 36.
Picture marks_of(const std::string& space, View view, Axis up) {
  TriangleMesh mesh = square(1, 0);
  mesh.space = space;
  RenderOptions options = front(72, 72);
  options.view = view;
  options.up = up;
  options.axes = true;
  options.zoom = 0.01;
  Picture marks = render_mesh(mesh, options);
  options.axes = false;
  const Picture without = render_mesh(mesh, options);
  for (std::size_t n = 0; n < marks.pixels.size(); ++n) {
    if (marks.pixels[n] == without.pixels[n]) marks.pixels[n][3] = 0;
  }
  return marks;
}

constexpr double kMiddle = 36, kToLetter = 29;

// Patient's right is at the left of a picture from the front, and the head is up.
TEST(RenderAxes, APatientHasTheLettersOfItsSides) {
  for (const std::string space : {"LPS", "RAS"}) {
    const Picture from_front = marks_of(space, {0, 0}, Axis::kZ);
    const auto s = find_letter(from_front, kS), i = find_letter(from_front, kI);
    const auto l = find_letter(from_front, kL), r = find_letter(from_front, kR);
    ASSERT_TRUE(s && i && l && r) << space;
    EXPECT_NEAR((*s)[1], kMiddle - kToLetter, 1);
    EXPECT_NEAR((*i)[1], kMiddle + kToLetter, 1);
    EXPECT_NEAR((*l)[0], kMiddle + kToLetter, 1);
    EXPECT_NEAR((*r)[0], kMiddle - kToLetter, 1);
    EXPECT_FALSE(find_letter(from_front, kA) || find_letter(from_front, kP)) << "they point along the view";
    const Picture from_right = marks_of(space, {-90, 0}, Axis::kZ);  // of the patient: the side of -x in LPS
    ASSERT_TRUE(find_letter(from_right, kA) && find_letter(from_right, kP));
    EXPECT_NEAR((*find_letter(from_right, kA))[0], kMiddle + kToLetter, 1);
  }
}

TEST(RenderAxes, TheMarkOfTheAxisThatIsUpIsUp) {
  const std::pair<Axis, std::vector<std::string_view>> cases[] = {
      {Axis::kX, kSmallX}, {Axis::kY, kSmallY}, {Axis::kZ, kSmallZ}};
  for (const auto& [axis, letter] : cases) {
    const auto place = find_letter(marks_of("", {0, 0}, axis), letter);
    ASSERT_TRUE(place);
    EXPECT_NEAR((*place)[0], kMiddle, 1);
    EXPECT_NEAR((*place)[1], kMiddle - kToLetter, 1);
  }
  const auto below = find_letter(marks_of("index", {0, 0}, Axis::kMinusZ), kSmallZ);
  ASSERT_TRUE(below);
  EXPECT_NEAR((*below)[1], kMiddle + kToLetter, 1);
  // Anterior up, from the feet, as a slice of a CT is shown: the patient's right is at the left.
  const Picture as_slice = marks_of("RAS", {0, 0}, Axis::kY);
  ASSERT_TRUE(find_letter(as_slice, kA) && find_letter(as_slice, kR));
  EXPECT_LT((*find_letter(as_slice, kA))[1], kMiddle - 20);
  EXPECT_LT((*find_letter(as_slice, kR))[0], kMiddle - 20);
}

// Nothing but the corner of the marks differs, for any background.
TEST(RenderAxes, MarksStayInTheirCorner) {
  for (const std::optional<Colour>& background : {std::optional<Colour>{}, std::optional<Colour>{{20, 20, 40}}}) {
    RenderOptions options = front(120, 100);
    options.view = {35, 20};
    options.background = background;
    const Picture without = render_mesh(meshes::cube(), options);
    options.axes = true;
    const Picture with = render_mesh(meshes::cube(), options);
    std::size_t changed = 0;
    for (std::int64_t row = 0; row < 100; ++row) {
      for (std::int64_t column = 0; column < 120; ++column) {
        const auto n = static_cast<std::size_t>(row * 120 + column);
        if (with.pixels[n] == without.pixels[n]) continue;
        ++changed;
        ASSERT_TRUE(column < 72 && row >= 28) << column << ' ' << row;
      }
    }
    EXPECT_GT(changed, 150U);
  }
}

}  // namespace
}  // namespace isoweave::testing::render_axes_test
