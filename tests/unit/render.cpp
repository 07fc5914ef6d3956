// The rasteriser on triangles small enough to say which pixels they cover.
// Threads: RenderMesh.*
#include "isoweave/render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "meshes.hpp"
#include "render/camera.hpp"
#include "render_scene.hpp"

namespace isoweave::testing::render_test {
namespace {

using namespace render_scene;

// Alpha as the part of the picture that is covered.
double coverage(const Picture& picture) {
  double sum = 0;
  for (const auto& pixel : picture.pixels) sum += pixel[3] / 255.0;
  return sum / static_cast<double>(picture.pixels.size());
}

constexpr double kFilled = 0.92;  // of the frame, by what fits just into it

TEST(RenderCamera, ThePlaceOfARayIsWhereItCameFrom) {
  RenderOptions options = front(80, 60, 2);
  options.view = {40, -25};
  const render::Camera camera(meshes::cube(), options);
  for (const Point& p : meshes::cube().vertices) {
    const Vec3 seen = camera.placed(p);
    EXPECT_GT(seen.z, 0);
    EXPECT_LE(seen.z, 1);
    const Vec3 ray = camera.ray(camera.column_of(seen), camera.row_of(seen));
    EXPECT_NEAR(ray.x * seen.z, seen.x, 1e-12);
    EXPECT_NEAR(ray.y * seen.z, seen.y, 1e-12);
  }
}

TEST(RenderCamera, PixelsAreSquare) {
  for (const RenderOptions& options : {front(100, 60), front(60, 100), front(7, 7, 3)}) {
    const render::Camera camera(meshes::cube(), options);
    EXPECT_NEAR(camera.ray(1, 0).x - camera.ray(0, 0).x, camera.ray(0, 0).y - camera.ray(0, 1).y, 1e-15);
  }
}

TEST(RenderCamera, TheMeshJustFits) {
  for (const View view : {View{0, 0}, View{35, 20}, View{-120, 80}, View{10, -90}}) {
    RenderOptions options = front(100, 60);
    options.view = view;
    const render::Camera camera(meshes::cube(), options);
    double left = 100, right = 0, top = 60, bottom = 0;
    for (const Point& p : meshes::cube().vertices) {
      const Vec3 seen = camera.placed(p);
      left = std::min(left, camera.column_of(seen));
      right = std::max(right, camera.column_of(seen));
      top = std::min(top, camera.row_of(seen));
      bottom = std::max(bottom, camera.row_of(seen));
    }
    // In the middle, and as large as the margin allows in one of the directions.
    EXPECT_NEAR(std::max((right - left) / 100, (bottom - top) / 60), kFilled, 1e-9);
    EXPECT_LT(right, 97);
    EXPECT_GT(left, 3);
    EXPECT_LT(bottom, 58.5);
    EXPECT_GT(top, 1.5);
  }
}

// The square fills 92 of 100 pixels each way, from 4 to 96.
TEST(RenderMesh, ASquareCoversItsPixelsAndNoOthers) {
  const Picture picture = render_mesh(square(1, 0), front(100, 100));
  for (std::int64_t row = 0; row < 100; ++row) {
    for (std::int64_t column = 0; column < 100; ++column) {
      const bool inside = column >= 4 && column < 96 && row >= 4 && row < 96;
      ASSERT_EQ(alpha_at(picture, column, row), inside ? 255 : 0) << column << ' ' << row;
    }
  }
}

// Below the diagonal from the upper left to the lower right; the diagonal's pixels are half covered.
TEST(RenderMesh, ATriangleCoversHalfOfThem) {
  TriangleMesh mesh = square(1, 0);
  mesh.triangles = {{0, 1, 3}};
  const Picture picture = render_mesh(mesh, front(100, 100, 8));
  EXPECT_EQ(alpha_at(picture, 10, 80), 255);
  EXPECT_EQ(alpha_at(picture, 80, 10), 0);
  EXPECT_EQ(alpha_at(picture, 5, 4), 0);
  EXPECT_EQ(alpha_at(picture, 4, 5), 255);
  EXPECT_NEAR(alpha_at(picture, 50, 50), 255 * 0.5, 255 / 8.0);
  EXPECT_NEAR(coverage(picture), kFilled * kFilled / 2, 1e-3);
  EXPECT_NEAR(colour_at(picture, 50, 50).green, colour_at(picture, 48, 52).green, 2);  // alpha is not in the colour
}

// On the side of +x, -y and +z: where the axes point in the picture.
TEST(RenderMesh, ViewsLookFromTheirSides) {
  const TriangleMesh ends{{{3, 0, 0},
                           {2, 0.5F, 0.5F},
                           {2, -0.5F, -0.5F},
                           {0, 3, 0},
                           {0.5F, 2, 0.5F},
                           {-0.5F, 2, -0.5F},
                           {-3, 0, -3},
                           {-2.9F, -3, -3},
                           {-3, -3, 3}},
                          {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}},
                          {}};
  const auto place = [&](View view, const Point& p) {
    RenderOptions options = front(100, 100);
    options.view = view;
    const render::Camera camera(ends, options);
    const Vec3 seen = camera.placed(p);
    return std::array<double, 3>{camera.column_of(seen), camera.row_of(seen), seen.z};
  };
  const Point middle{0, 0, 0};
  EXPECT_GT(place({0, 0}, {1, 0, 0})[0], place({0, 0}, middle)[0]);
  EXPECT_LT(place({0, 0}, {0, 0, 1})[1], place({0, 0}, middle)[1]);
  EXPECT_LT(place({0, 0}, {0, -1, 0})[2], place({0, 0}, middle)[2]);
  EXPECT_LT(place({90, 0}, {1, 0, 0})[2], place({90, 0}, middle)[2]);
  EXPECT_GT(place({90, 0}, {0, 1, 0})[0], place({90, 0}, middle)[0]);
  EXPECT_LT(place({0, 90}, {0, 0, 1})[2], place({0, 90}, middle)[2]);
  EXPECT_LT(place({0, 90}, {0, 1, 0})[1], place({0, 90}, middle)[1]);
}

// A patient is seen from the same side in LPS and in RAS, whose x and y have the other sign.
TEST(RenderMesh, TheFrontIsThatOfTheSpace) {
  TriangleMesh lps = square(1, 0);
  append(lps, {{{-1, -0.5F, -1}, {0.2F, -0.7F, -1}, {0, -0.5F, 0.6F}}, {{0, 1, 2}}, {}});
  lps.space = "LPS";
  TriangleMesh ras = lps;
  ras.space = "RAS";
  for (Point& point : ras.vertices) point = {-point[0], -point[1], point[2]};
  RenderOptions options = front(60, 60);
  options.view = {20, 10};
  options.axes = true;
  options.width = options.height = 80;
  constexpr std::pair<Axis, Axis> kSame[] = {{Axis::kX, Axis::kMinusX}, {Axis::kY, Axis::kMinusY},
                                             {Axis::kZ, Axis::kZ},      {Axis::kMinusX, Axis::kX},
                                             {Axis::kMinusY, Axis::kY}, {Axis::kMinusZ, Axis::kMinusZ}};
  for (const auto& [in_lps, in_ras] : kSame) {
    options.up = in_lps;
    const Picture expected = render_mesh(lps, options);
    options.up = in_ras;
    EXPECT_EQ(render_mesh(ras, options).pixels, expected.pixels);
  }
  options.up = Axis::kZ;
  const Picture of_patient = render_mesh(ras, options);
  ras.space.clear();
  EXPECT_NE(render_mesh(ras, options).pixels, of_patient.pixels);
}

// The axis that is up ascends in the picture, and the others keep their sense: the three directions of the camera are
// no mirror image.
TEST(RenderMesh, TheAxisThatIsUpPointsUp) {
  constexpr std::pair<Axis, Vec3> kUp[] = {{Axis::kX, {1, 0, 0}},       {Axis::kY, {0, 1, 0}},
                                           {Axis::kZ, {0, 0, 1}},       {Axis::kMinusX, {-1, 0, 0}},
                                           {Axis::kMinusY, {0, -1, 0}}, {Axis::kMinusZ, {0, 0, -1}}};
  for (const std::string space : {"", "LPS", "RAS", "index"}) {
    TriangleMesh mesh = meshes::cube();
    mesh.space = space;
    for (const auto& [axis, direction] : kUp) {
      RenderOptions options = front(50, 50);
      options.up = axis;
      const render::Camera camera(mesh, options);
      const Vec3 seen = camera.turned(direction);
      EXPECT_NEAR(seen.x, 0, 1e-15);
      EXPECT_NEAR(seen.y, 1, 1e-15);
      EXPECT_NEAR(seen.z, 0, 1e-15);
      const Vec3 x = camera.turned({1, 0, 0}), y = camera.turned({0, 1, 0}), z = camera.turned({0, 0, 1});
      EXPECT_NEAR(dot(cross(x, y), z), -1, 1e-15) << "the camera looks along z, so its directions are left-handed";
    }
  }
}

// A mesh with y up looks as the one that was turned to have z up.
TEST(RenderMesh, YUpIsZUpTurned) {
  TriangleMesh upright = square(1, 0);
  append(upright, {{{-1, -0.5F, -1}, {0.2F, -0.7F, -1}, {0, -0.5F, 0.6F}}, {{0, 1, 2}}, {}});
  TriangleMesh turned = upright;
  for (Point& point : turned.vertices) point = {point[0], point[2], -point[1]};
  RenderOptions options = front(60, 60);
  options.view = {25, 15};
  const Picture expected = render_mesh(upright, options);
  options.up = Axis::kY;
  EXPECT_EQ(render_mesh(turned, options).pixels, expected.pixels);
}

// The square fills 92 of 100 pixels each way; at half the size 46, from 27 to 73; at twice all of them.
TEST(RenderMesh, ZoomEnlargesTheMiddle) {
  RenderOptions options = front(100, 100);
  options.zoom = 0.5;
  const Picture half = render_mesh(square(1, 0), options);
  for (std::int64_t row = 0; row < 100; ++row) {
    for (std::int64_t column = 0; column < 100; ++column) {
      const bool inside = column >= 27 && column < 73 && row >= 27 && row < 73;
      ASSERT_EQ(alpha_at(half, column, row), inside ? 255 : 0) << column << ' ' << row;
    }
  }
  options.zoom = 2;
  EXPECT_EQ(coverage(render_mesh(square(1, 0), options)), 1);
  TriangleMesh small = square(1, 0);
  append(small, square(0.2F, -0.01F));
  std::vector<float> number(8, 0);
  std::fill(number.begin() + 4, number.end(), 1.0F);
  const Picture twice = render_mesh(small, options, number);
  const double least = 50 * (1 - 0.2 * 2 * kFilled) - 1;  // where the small square begins
  const auto column = static_cast<std::int64_t>(least);
  EXPECT_GT(colour_at(twice, column + 3, 50).red, 2 * colour_at(twice, column - 2, 50).red);
}

// The small square in front is nearer; it is told from the large one by the colour map.
TEST(RenderMesh, NearerHidesFarther) {
  for (const bool near_first : {true, false}) {
    TriangleMesh mesh = square(near_first ? 0.2F : 1.0F, near_first ? -0.3F : 0.3F);
    append(mesh, square(near_first ? 1.0F : 0.2F, near_first ? 0.3F : -0.3F));
    const std::vector<float> number =
        near_first ? std::vector<float>{1, 1, 1, 1, 0, 0, 0, 0} : std::vector<float>{0, 0, 0, 0, 1, 1, 1, 1};
    RenderOptions options = front(100, 100);
    options.shading = Shading::kFlat;
    const Picture picture = render_mesh(mesh, options, number);
    const Colour middle = colour_at(picture, 50, 50);
    const Colour border = colour_at(picture, 8, 50);
    EXPECT_GT(middle.green, 2 * border.green);  // yellow before purple
    EXPECT_GT(middle.red, 2 * middle.blue);
    EXPECT_GT(border.blue, border.green);
  }
}

// Two triangles over the same place: the first of them is seen.
TEST(RenderMesh, OfEquallyNearOnesTheFirstIsSeen) {
  TriangleMesh mesh = square(1, 0);
  append(mesh, square(1, 0));
  const Picture picture = render_mesh(mesh, front(60, 60), std::vector<float>{1, 1, 1, 1, 0, 0, 0, 0});
  EXPECT_GT(colour_at(picture, 30, 30).green, colour_at(picture, 30, 30).blue);
}

TEST(RenderMesh, BackgroundsAreThemselves) {
  RenderOptions options = front(40, 40, 2);
  EXPECT_EQ(alpha_at(render_mesh(square(1, 0), options), 0, 0), 0);
  options.background = Colour{10, 200, 77};
  const Picture picture = render_mesh(square(1, 0), options);
  EXPECT_EQ(alpha_at(picture, 0, 0), 255);
  EXPECT_EQ(colour_at(picture, 0, 0), (Colour{10, 200, 77}));
  EXPECT_NE(colour_at(picture, 20, 20), (Colour{10, 200, 77}));
  for (const auto& pixel : picture.pixels) EXPECT_EQ(pixel[3], 255);
}

// Both sides of a triangle are lit alike.
TEST(RenderMesh, BothSidesAreLit) {
  TriangleMesh mesh = square(1, 0);
  const Picture outside = render_mesh(mesh, front(20, 20));
  for (auto& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(render_mesh(mesh, front(20, 20)).pixels, outside.pixels);
  EXPECT_GT(colour_at(outside, 10, 10).green, 60);
}

// Edges are darker than what they lie on: the square's diagonal and its border.
TEST(RenderMesh, WireframeDrawsEdges) {
  RenderOptions options = front(100, 100, 2);
  const Colour plain = colour_at(render_mesh(square(1, 0), options), 50, 50);
  options.wireframe = true;
  const Picture picture = render_mesh(square(1, 0), options);
  EXPECT_LT(colour_at(picture, 50, 49).green, plain.green * 0.8);
  EXPECT_LT(colour_at(picture, 4, 30).green, plain.green * 0.9);
  EXPECT_NEAR(colour_at(picture, 70, 50).green, plain.green, 8);
}

// Obscurance: both sides of a valley are darker at its bottom, in the middle of the picture, than at their upper ends.
TEST(RenderMesh, HollowsAreDarker) {
  const TriangleMesh valley{{{-1, -1, -1}, {0, 0, -1}, {1, -1, -1}, {-1, -1, 1}, {0, 0, 1}, {1, -1, 1}},
                            {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}},
                            {}};
  RenderOptions options = front(60, 60, 3);
  options.shading = Shading::kFlat;
  const Picture picture = render_mesh(valley, options);
  EXPECT_LT(colour_at(picture, 28, 30).green, colour_at(picture, 6, 30).green - 20);
  EXPECT_LT(colour_at(picture, 31, 30).green, colour_at(picture, 53, 30).green - 20);
}

TEST(RenderMesh, DoesNotDependOnThreads) {
  TriangleMesh mesh = meshes::grid(12);
  append(mesh, meshes::cube());
  append(mesh, square(3, 2));
  RenderOptions options = front(90, 70, 2);
  options.view = {30, 40};
  options.wireframe = true;
  options.threads = 1;
  const Picture expected = render_mesh(mesh, options);
  for (const int threads : {2, 3, 8}) {
    options.threads = threads;
    EXPECT_EQ(render_mesh(mesh, options).pixels, expected.pixels);
  }
}

// Sizes that a square of doubles, or a float, would not hold.
TEST(RenderMesh, AnySizeOfCoordinates) {
  const double expected = coverage(render_mesh(square(1, 0), front(50, 50)));
  for (const float half : {3e38F, 1e-38F, 1e-44F}) {
    EXPECT_NEAR(coverage(render_mesh(square(half, 0), front(50, 50))), expected, 0.05) << half;
  }
}

// Where the mesh lies does not matter, but for the rounding of its coordinates.
TEST(RenderMesh, FarFromTheOrigin) {
  TriangleMesh mesh = square(1, 0);
  const Picture expected = render_mesh(mesh, front(50, 50));
  for (Point& p : mesh.vertices) p = {p[0] + 4096, p[1] + 65536, p[2] - 8192};
  EXPECT_NEAR(coverage(render_mesh(mesh, front(50, 50))), coverage(expected), 1e-9);
}

TEST(RenderMesh, TrianglesWithoutAreaAreNoError) {
  const TriangleMesh point{{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}, {{0, 1, 2}, {0, 0, 0}}, {}};
  EXPECT_EQ(render_mesh(point, front(8, 8)).pixels.size(), 64U);
  const TriangleMesh line{{{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, {{0, 1, 2}}, {}};
  EXPECT_EQ(render_mesh(line, front(8, 8)).pixels.size(), 64U);
}

TEST(RenderMesh, WrongArgumentsAreErrors) {
  const auto refused = [](const TriangleMesh& mesh, const RenderOptions& options, std::span<const float> quality = {}) {
    EXPECT_THROW(render_mesh(mesh, options, quality), std::invalid_argument);
  };
  const TriangleMesh mesh = square(1, 0);
  refused({}, {});
  TriangleMesh wrong = mesh;
  wrong.vertices[2][1] = std::numeric_limits<float>::quiet_NaN();
  refused(wrong, {});
  wrong = mesh;
  wrong.triangles[0][0] = 4;
  refused(wrong, {});
  refused(mesh, {}, std::vector<float>{1, 2});
  refused(mesh, front(0, 10));
  refused(mesh, front(10, 16385));
  refused(mesh, front(10, 10, 9));
  RenderOptions options;
  options.view.elevation = 91;
  refused(mesh, options);
  for (const double zoom : {0.0, -1.0, 0.009, 101.0, std::numeric_limits<double>::quiet_NaN()}) {
    options = {};
    options.zoom = zoom;
    refused(mesh, options);
  }
  options = front(71, 100);
  EXPECT_NO_THROW(render_mesh(mesh, options));
  options.axes = true;
  refused(mesh, options);
  options = {};
  options.range = {{2, 2}};
  refused(mesh, options, std::vector<float>{1, 2, 3, 4});
}

// Numbers that are not there are shown in the plain colour.
TEST(RenderMesh, NumbersThatAreNotFiniteTakeTheColour) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  const Picture plain = render_mesh(square(1, 0), front(20, 20));
  EXPECT_EQ(render_mesh(square(1, 0), front(20, 20), std::vector<float>{none, none, none, none}).pixels, plain.pixels);
}

TEST(RenderMesh, TheRangeIsThatOfFiniteNumbers) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(finite_range(std::vector<float>{3, kNan, -2, HUGE_VALF, 1}), (std::array<double, 2>{-2, 3}));
  const std::array<double, 2> none = finite_range(std::vector<float>{kNan, -HUGE_VALF});
  EXPECT_GT(none[0], none[1]);
}

TEST(RenderMesh, PicturesThatCannotBeWrittenLeaveNothing) {
  const files::Folder folder;
  const Picture picture = render_mesh(square(1, 0), front(8, 8));
  EXPECT_THROW(write_png(folder / "missing/a.png", picture), CannotWrite);
  EXPECT_THROW(require_png(folder / "missing/a.png"), CannotWrite);
  EXPECT_TRUE(folder.entries().empty());
}

// The letters "0", "0.5" and "1" have 19, 40 and 10 dots, of two by two pixels in so high a picture.
TEST(RenderColourBar, TellsTheColoursAndTheirNumbers) {
  Picture picture = render_mesh(square(1, 0), front(50, 700));
  const auto width = colour_bar_width(700);
  for (const std::optional<Colour>& background : {std::optional<Colour>{}, std::optional<Colour>{{20, 20, 40}}}) {
    const Picture wider = with_colour_bar(picture, {0, 1}, background);
    ASSERT_EQ(wider.width, 50 + width);
    ASSERT_EQ(static_cast<std::int64_t>(wider.pixels.size()), wider.width * 700);
    const auto at = [&](std::int64_t column, std::int64_t row) {
      return wider.pixels[static_cast<std::size_t>(row * wider.width + column)];
    };
    std::int64_t ink = 0;
    const std::uint8_t shade = background ? 235 : 30;
    for (std::int64_t row = 0; row < 700; ++row) {
      for (std::int64_t column = 0; column < 50; ++column)
        ASSERT_EQ(at(column, row), picture.pixels[static_cast<std::size_t>(row * 50 + column)]);
      for (std::int64_t column = 50; column < wider.width; ++column)
        ink += at(column, row) == std::array<std::uint8_t, 4>{shade, shade, shade, 255};
    }
    EXPECT_EQ(ink, 4 * (19 + 40 + 10));
    const auto high = at(50 + 20, 700 / 8 + 1), low = at(50 + 20, 699 - 700 / 8);
    EXPECT_TRUE(high[0] > 240 && high[1] > 220 && high[2] < 50);  // yellow
    EXPECT_TRUE(low[0] < 80 && low[1] < 10 && low[2] > 75);       // purple
    EXPECT_EQ(at(50 + width - 1, 0)[3], background ? 255 : 0);
  }
}

}  // namespace
}  // namespace isoweave::testing::render_test
