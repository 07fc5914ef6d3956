// isoweave render: pictures as another program reads them.
#include <gtest/gtest.h>

#ifdef ISOWEAVE_HAS_PNG
#include <png.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_pictures_test {
namespace {

using program::listing;
using program::Result;
using program::run;

void make_sphere(const files::Folder& folder) {
  ASSERT_EQ(run(folder.path(), {"mesh", "generate:sphere:64x64x64", "-o", "s.ply", "--iso", "0", "--quiet"}).code, 0);
}

std::vector<std::string> render(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"render", "s.ply", "-o", "s.png", "--size", "200x150"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(CliRender, WrongValuesAreRefused) {
  const files::Folder folder;
  make_sphere(folder);
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--size", "200x"}, "--size"},
      {{"--size", "0x10"}, "--size"},
      {{"--size", "10x16385"}, "--size"},
      {{"--view", "above"}, "--view"},
      {{"--view", "10,91"}, "--view"},
      {{"--view", "10"}, "--view"},
      {{"--up", "w"}, "--up"},
      {{"--up", "+z"}, "--up"},
      {{"--zoom", "0"}, "--zoom"},
      {{"--zoom", "101"}, "--zoom"},
      {{"--axes", "--size", "71x100"}, "axes"},
      {{"--background", "#12345"}, "--background"},
      {{"--background", "#12345g"}, "--background"},
      {{"--color", "transparent"}, "--color"},
      {{"--color-by", "height"}, "--color-by"},
      {{"--range", "0,1"}, "--range"},
      {{"--color-by", "quality", "--range", "1,0"}, "--range"},
      {{"--shading", "round"}, "--shading"},
      {{"--samples", "9"}, "--samples"},
      {{"--threads", "0"}, "--threads"},
  };
  for (const auto& [more, says] : cases) {
    std::vector<std::string> arguments{"render", "s.ply", "-o", "s.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    program::expect_failed(run(folder.path(), arguments), 2, says);
  }
  program::expect_failed(run(folder.path(), {"render", "s.ply", "-o", "s.ply"}), 2, "different files");
  program::expect_failed(run(folder.path(), {"render", "s.ply", "-o", "s.jpg"}), 4, "s.jpg");
  program::expect_failed(run(folder.path(), {"render", "nothing.ply", "-o", "missing/s.png"}), 4, "missing/s.png");
  EXPECT_EQ(listing(folder), std::vector<std::string>{"s.ply"});
}

#ifdef ISOWEAVE_HAS_PNG
struct Png {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> pixels;  // red, green, blue, alpha
  bool has_alpha = false;

  const std::uint8_t* at(std::uint32_t column, std::uint32_t row) const { return &pixels[4 * (row * width + column)]; }
};

// By libpng's simplified interface.
Png read_png(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << image.message;
  Png png{image.width, image.height, {}, (image.format & PNG_FORMAT_FLAG_ALPHA) != 0};
  image.format = PNG_FORMAT_RGBA;
  png.pixels.resize(PNG_IMAGE_SIZE(image));
  EXPECT_NE(png_image_finish_read(&image, nullptr, png.pixels.data(), 0, nullptr), 0) << image.message;
  return png;
}

// A disc that fills 92 % of the frame's height.
TEST(CliRender, ASphereIsADiscOfItsSize) {
  const files::Folder folder;
  make_sphere(folder);
  const Result result = run(folder.path(), render({"--background", "transparent"}));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(program::is_one_line(result.err)) << result.err;
  const Png png = read_png(folder / "s.png");
  EXPECT_TRUE(png.has_alpha);
  ASSERT_EQ(png.width, 200U);
  ASSERT_EQ(png.height, 150U);
  double area = 0, columns = 0, rows = 0;
  for (std::uint32_t row = 0; row < png.height; ++row) {
    for (std::uint32_t column = 0; column < png.width; ++column) {
      const double part = png.at(column, row)[3] / 255.0;
      area += part;
      columns += part * (column + 0.5);
      rows += part * (row + 0.5);
    }
  }
  EXPECT_NEAR(area / (std::acos(-1.0) * std::pow(0.92 * 75, 2)), 1, 0.01);
  EXPECT_NEAR(columns / area, 100, 0.3);
  EXPECT_NEAR(rows / area, 75, 0.3);
}

TEST(CliRender, OptionsAreFollowed) {
  const files::Folder folder;
  make_sphere(folder);
  ASSERT_EQ(run(folder.path(), render({"--background", "#102030", "--color", "#ff0000", "--quiet"})).code, 0);
  const Png red = read_png(folder / "s.png");
  EXPECT_FALSE(red.has_alpha);
  EXPECT_EQ(std::vector<int>(red.at(0, 0), red.at(0, 0) + 3), (std::vector<int>{0x10, 0x20, 0x30}));
  EXPECT_GT(red.at(100, 75)[0], 3 * red.at(100, 75)[1]);
  const std::string bytes = files::read_bytes(folder / "s.png");
  ASSERT_EQ(
      run(folder.path(), render({"--background", "#102030", "--color", "#ff0000", "--quiet", "--threads", "1"})).code,
      0);
  EXPECT_TRUE(files::read_bytes(folder / "s.png") == bytes);
  ASSERT_EQ(run(folder.path(), render({"--wireframe", "--shading", "flat", "--view", "top", "--samples", "1"})).code,
            0);
  EXPECT_FALSE(files::read_bytes(folder / "s.png") == bytes);
}

// A sphere shows nothing of the axis that is up, but for the marks of the axes.
TEST(CliRender, AxesAndZoomAreFollowed) {
  const files::Folder folder;
  make_sphere(folder);
  const auto picture = [&](const std::vector<std::string>& more) {
    const Result result = run(folder.path(), render(more));
    EXPECT_EQ(result.code, 0) << result.err;
    return read_png(folder / "s.png");
  };
  const auto is_white = [](const Png& png, std::uint32_t column, std::uint32_t row) {
    return png.at(column, row)[0] == 255 && png.at(column, row)[1] == 255;
  };
  const Png plain = picture({"--view", "front"});
  // The disc of 138 pixels becomes one of 69, out of the way of the marks.
  const Png small = picture({"--view", "front", "--zoom", "0.5"});
  EXPECT_FALSE(is_white(plain, 100, 12));
  EXPECT_FALSE(is_white(small, 100, 45));
  EXPECT_TRUE(is_white(small, 100, 35));
  EXPECT_TRUE(is_white(small, 36, 100));
  // The axis of z goes up from the middle of the marks, at 36, 114, or down.
  const Png upright = picture({"--view", "front", "--zoom", "0.5", "--axes"});
  const Png turned = picture({"--view", "front", "--zoom", "0.5", "--axes", "--up", "-z"});
  EXPECT_FALSE(is_white(upright, 36, 100));
  EXPECT_TRUE(is_white(upright, 36, 128));
  EXPECT_TRUE(is_white(turned, 36, 100));
  EXPECT_FALSE(is_white(turned, 36, 128));
}

TEST(CliRender, ColoursByQuality) {
  const files::Folder folder;
  make_sphere(folder);
  program::expect_failed(run(folder.path(), render({"--color-by", "quality"})), 3, "quality");
  EXPECT_EQ(listing(folder), std::vector<std::string>{"s.ply"});
  ASSERT_EQ(run(folder.path(), {"compare", "s.ply", "s.ply", "--distances", "d.ply", "--samples", "100"}).code, 0);
  const std::vector<std::string> picture{"render", "d.ply", "-o", "d.png", "--size", "40x40", "--color-by", "quality"};
  ASSERT_EQ(run(folder.path(), picture).code, 0);
  const Png low = read_png(folder / "d.png");
  EXPECT_GT(low.at(20, 20)[2], low.at(20, 20)[1]);  // all distances are 0: the dark end, purple
  std::vector<std::string> ranged = picture;
  ranged.insert(ranged.end(), {"--range", "-2,-1"});
  const Result result = run(folder.path(), ranged);
  ASSERT_EQ(result.code, 0);
  EXPECT_NE(result.err.find("colours from -2 to -1"), std::string::npos) << result.err;
  const Png high = read_png(folder / "d.png");
  EXPECT_GT(high.at(20, 20)[1], 2 * high.at(20, 20)[2]);  // beyond the bright end, yellow

  // A picture with room for a bar of the colours has one, unless it is not wanted.
  std::vector<std::string> large = picture;
  large[5] = "480x200";
  ASSERT_EQ(run(folder.path(), large).code, 0);
  const Png with_bar = read_png(folder / "d.png");
  constexpr std::uint32_t column = 402;  // of the bar, in a strip of 88
  EXPECT_LT(with_bar.at(column, 100)[0], 200);
  large.emplace_back("--no-color-bar");
  ASSERT_EQ(run(folder.path(), large).code, 0);
  EXPECT_EQ(read_png(folder / "d.png").at(column, 100)[0], 255);
}
#else
TEST(CliRender, WithoutLibpngItSaysSo) {
  const files::Folder folder;
  make_sphere(folder);
  program::expect_failed(run(folder.path(), render({})), 4, "expected a build with libpng");
  EXPECT_EQ(listing(folder), std::vector<std::string>{"s.ply"});
}
#endif

}  // namespace
}  // namespace isoweave::testing::cli_pictures_test
