// A picture in two passes: which triangle each sample shows, then the mean light of the samples of each pixel.
#include "isoweave/render.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lattice/triangles.hpp"
#include "parallel/float_environment.hpp"
#include "render/axis_marks.hpp"
#include "render/colours.hpp"
#include "render/shading.hpp"

namespace isoweave {
namespace {

using render::Visibility;

constexpr int kMostPixels = 16384;
constexpr int kMostSamples = 8;
constexpr double kMostZoom = 100;

bool within(double x, double low, double high) { return x >= low && x <= high; }

void check_options(const RenderOptions& options) {
  if (!within(options.width, 1, kMostPixels) || !within(options.height, 1, kMostPixels)) {
    throw std::invalid_argument("expected a picture of 1 to 16384 pixels a side");
  }
  if (options.axes && std::min(options.width, options.height) < render::kLeastSideWithAxes) {
    throw std::invalid_argument("axes: expected a picture of 72 pixels or more a side, found " +
                                std::to_string(options.width) + " x " + std::to_string(options.height));
  }
  if (!within(options.samples, 1, kMostSamples)) {
    throw std::invalid_argument("expected 1 to 8 samples a side of a pixel");
  }
  if (!std::isfinite(options.view.azimuth) || !within(options.view.elevation, -90, 90)) {
    throw std::invalid_argument("expected a finite azimuth and an elevation from -90 to 90");
  }
  if (!within(options.zoom, 1 / kMostZoom, kMostZoom)) throw std::invalid_argument("expected a zoom of 0.01 to 100");
  if (options.range &&
      !((*options.range)[0] < (*options.range)[1] && std::isfinite((*options.range)[1] - (*options.range)[0]))) {
    throw std::invalid_argument("expected a range from a finite number to a larger one");
  }
}

void check_mesh(const TriangleMesh& mesh, std::span<const float> quality) {
  if (mesh.triangles.empty()) throw std::invalid_argument("expected a mesh with triangles, found none");
  measure::require_finite_mesh(mesh);
  if (!quality.empty() && quality.size() != mesh.vertices.size()) {
    throw std::invalid_argument("quality: expected one number for each vertex");
  }
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.vertices.size()) {
    throw std::invalid_argument("normals: expected one for each vertex, or none");
  }
}

// Samples that show nothing are as much of the background, or of nothing.
std::array<std::uint8_t, 4> pixel_at(std::int64_t column, std::int64_t row, const RenderOptions& options,
                                     const Visibility& visibility, const render::Shader& shader) {
  Vec3 light;
  int hits = 0;
  for (std::int64_t y = row * options.samples; y < (row + 1) * options.samples; ++y) {
    for (std::int64_t x = column * options.samples; x < (column + 1) * options.samples; ++x) {
      if (visibility.at(x, y) == Visibility::kNothing) continue;
      light = light + shader.light_at(x, y);
      ++hits;
    }
  }
  const int all = options.samples * options.samples;
  if (options.background) {
    light = light + static_cast<double>(all - hits) * render::light_of(*options.background);
  } else if (hits == 0) {
    return {0, 0, 0, 0};
  }
  const Vec3 mean = 1.0 / (options.background ? all : hits) * light;
  const long alpha = options.background ? 255 : std::lround(255.0 * hits / all);
  return {render::byte_of_light(mean.x), render::byte_of_light(mean.y), render::byte_of_light(mean.z),
          static_cast<std::uint8_t>(alpha)};
}

}  // namespace

std::array<double, 2> finite_range(std::span<const float> numbers) {
  std::array<double, 2> range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const float number : numbers) {
    if (std::isfinite(number)) range = {std::min(range[0], double{number}), std::max(range[1], double{number})};
  }
  return range;
}

Picture render_mesh(const TriangleMesh& mesh, const RenderOptions& options, std::span<const float> quality) {
  const StandardFloats floats;
  check_options(options);
  check_mesh(mesh, quality);
  const Executor executor(options.threads);
  const render::Camera camera(mesh, options);
  const render::CornerNormals normals =
      options.shading == Shading::kSmooth ? render::smooth_normals(mesh, executor) : render::CornerNormals{};
  const Visibility visibility(mesh, camera, executor);
  const render::Shader shader(mesh, normals, quality, options, camera, visibility);
  Picture picture{options.width, options.height, {}};
  picture.pixels.resize(static_cast<std::size_t>(picture.width * picture.height));
  executor.for_each(picture.height, 1, [&](std::int64_t row) {
    for (std::int64_t column = 0; column < picture.width; ++column) {
      picture.pixels[static_cast<std::size_t>(row * picture.width + column)] =
          pixel_at(column, row, options, visibility, shader);
    }
  });
  if (options.axes) render::draw_axes(picture, camera, mesh.space, options.background);
  return picture;
}

}  // namespace isoweave
