// The rasteriser on triangles small enough to say which pixels they cover.
// Threads: RenderMesh.*
#include "isoweave/render.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "meshes.hpp"
#include "render/camera.hpp"

namespace isoweave {
namespace {

// Looks along +y: x to the right, z up.
RenderOptions front(int width, int height, int samples = 1) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.view = {0, 0};
  options.background.reset();
  options.samples = samples;
  return options;
}

std::uint8_t alpha_at(const Picture& picture, std::int64_t column, std::int64_t row) {
  return picture.pixels[static_cast<std::size_t>(row * picture.width + column)][3];
}

Colour colour_at(const Picture& picture, std::int64_t column, std::int64_t row) {
  const auto& p = picture.pixels[static_cast<std::size_t>(row * picture.width + column)];
  return {p[0], p[1], p[2]};
}

// A square in the plane y, seen from the front.
TriangleMesh square(float half, float y) {
  return {{{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}}, {{0, 1, 2}, {0, 2, 3}}, {}};
}

void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

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

// The small square in front is nearer; it is told from the large one by the colour map.
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
  const Picture expected = render_mesh(lps, options);
  const Picture found = render_mesh(ras, options);
  std::size_t other = 0;
  for (std::size_t n = 0; n < expected.pixels.size(); ++n) {
    for (std::size_t part = 0; part < 4; ++part) {
      if (std::abs(int{expected.pixels[n][part]} - int{found.pixels[n][part]}) > 2) ++other;
    }
  }
  EXPECT_LT(other, 8U) << "but for pixels at an edge that rounding decides";
  ras.space.clear();
  EXPECT_NE(render_mesh(ras, options).pixels, found.pixels);
}

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

}  // namespace
}  // namespace isoweave
