#include "render/shading.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/colours.hpp"

namespace isoweave::render {
namespace {

// A light: the direction towards it, in camera coordinates, and its strength. Lights move with the camera.
struct Light {
  Vec3 towards;
  double strength;
};

constexpr std::array<Light, 3> kLights{{{{-0.4767, 0.6674, -0.5721}, 0.84},  // key, from the upper left
                                        {{0.8433, 0.1054, -0.527}, 0.13},    // fill, from the right
                                        {{0, 0, -1}, 0.2}}};                 // headlight
constexpr double kAmbientFromAbove = 0.26;
constexpr double kAmbientFromBelow = 0.10;
constexpr std::int64_t kTrianglesPerBlock = 4096;

constexpr double kCreaseCosine = 0.64;  // of 50 degrees

constexpr double kGloss = 0.06;
constexpr double kGlossExponent = 24;

// Obscurance: how far parts count, in parts of the frame's half height; how much; taps per sample, on a spiral.
constexpr double kObscuranceReach = 0.3;
constexpr double kObscuranceStrength = 1.5;
constexpr double kObscuranceBias = 0.012;
constexpr int kTaps = 14;

constexpr double kEdgeHalfWidth = 0.4;  // pixels
constexpr double kEdgeStrength = 0.7;

using Tap = std::array<double, 2>;  // in parts of the reach

// The taps go round five turns: 5/14 of a turn from tap to tap, half of that before the first.
constexpr std::array<Tap, kTaps> spiral_of_taps() {
  constexpr Tap kStep{-0.62348980185873359, 0.78183148246802969};  // cosine and sine
  std::array<Tap, kTaps> taps{};
  Tap way{0.43388373911755823, 0.90096886790241915};
  for (std::size_t n = 0; n < kTaps; ++n) {
    const double part = (static_cast<double>(n) + 0.5) / kTaps;
    taps[n] = {part * way[0], part * way[1]};
    way = {way[0] * kStep[0] - way[1] * kStep[1], way[0] * kStep[1] + way[1] * kStep[0]};
  }
  return taps;
}

constexpr std::array<Tap, kTaps> kSpiral = spiral_of_taps();

double length_of(const Vec3& v) { return std::sqrt(dot(v, v)); }

Vec3 unit(const Vec3& v) {
  const double length = length_of(v);
  return length > 0 ? (1 / length) * v : Vec3{0, 0, -1};
}

// A number in [0, 1) for each sample. Neighbours differ, so what taps miss becomes a grain that the samples of a pixel
// average.
double grain(std::int64_t column, std::int64_t row) {
  const double x = 0.06711056 * static_cast<double>(column) + 0.00583715 * static_cast<double>(row);
  const double y = 52.9829189 * (x - std::floor(x));  // interleaved gradient noise (Jimenez 2014)
  return y - std::floor(y);
}

// The triangles around each vertex: those of vertex v are [first[v], first[v + 1]).
struct Stars {
  std::vector<std::size_t> first;
  std::vector<std::uint32_t> triangles;
};

Stars stars_of(const TriangleMesh& mesh) {
  Stars stars;
  stars.first.assign(mesh.vertices.size() + 1, 0);
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++stars.first[v];
  }
  std::size_t total = 0;
  for (std::size_t& entry : stars.first) {
    total += entry;
    entry = total;  // the end for now; storing from the back turns it into the beginning
  }
  stars.triangles.resize(total);
  for (auto n = static_cast<std::uint32_t>(mesh.triangles.size()); n > 0; --n) {
    for (const std::uint32_t v : mesh.triangles[n - 1]) stars.triangles[--stars.first[v]] = n - 1;
  }
  return stars;
}

// The normal of a triangle, as long as twice its area.
Vec3 area_normal(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const Vec3 a = vec3_of(mesh.vertices[t[0]]);
  return cross(vec3_of(mesh.vertices[t[1]]) - a, vec3_of(mesh.vertices[t[2]]) - a);
}

Point mean_normal(const TriangleMesh& mesh, std::span<const std::uint32_t> star, const Vec3& normal) {
  Vec3 sum;
  for (const std::uint32_t other : star) {
    const Vec3 n = area_normal(mesh, other);
    if (dot(n, normal) >= kCreaseCosine * length_of(n)) sum = sum + n;
  }
  const Vec3 mean = dot(sum, sum) > 0 ? unit(sum) : normal;
  return {static_cast<float>(mean.x), static_cast<float>(mean.y), static_cast<float>(mean.z)};
}

}  // namespace

CornerNormals smooth_normals(const TriangleMesh& mesh, const Executor& executor) {
  CornerNormals normals(mesh.triangles.size());
  const Stars stars = mesh.normals.empty() ? stars_of(mesh) : Stars{};
  executor.for_each(static_cast<std::int64_t>(normals.size()), kTrianglesPerBlock, [&](std::int64_t n) {
    const auto triangle = static_cast<std::uint32_t>(n);
    const Vec3 normal = unit(area_normal(mesh, triangle));
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t v = mesh.triangles[triangle][corner];
      normals[triangle][corner] =
          mesh.normals.empty()
              ? mean_normal(mesh,
                            std::span(stars.triangles).subspan(stars.first[v], stars.first[v + 1] - stars.first[v]),
                            normal)
              : mesh.normals[v];
    }
  });
  return normals;
}

// Where the ray through a sample meets its triangle.
struct Shader::Place {
  std::int64_t column, row;
  std::uint32_t triangle;
  SeenTriangle seen;
  Vec3 ray;
  Vec3 shares;    // of the corners
  Vec3 position;  // in camera coordinates
};

Shader::Shader(const TriangleMesh& mesh, const CornerNormals& normals, std::span<const float> quality,
               const RenderOptions& options, const Camera& camera, const Visibility& visibility)
    : mesh_(mesh),
      normals_(normals),
      quality_(quality),
      options_(options),
      camera_(camera),
      visibility_(visibility),
      colour_(light_of(options.colour)),
      range_(options.range ? *options.range : finite_range(quality)) {}

Shader::Place Shader::place_at(std::int64_t column, std::int64_t row) const {
  const std::uint32_t triangle = Visibility::triangle_of(visibility_.at(column, row));
  Place place{column, row, triangle, SeenTriangle(mesh_, triangle, camera_), {}, {}, {}};
  place.ray = camera_.ray(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
  const Vec3 w = place.seen.weights(place.ray);
  place.shares = 1 / (w.x + w.y + w.z) * w;
  const auto& [a, b, c] = place.seen.corners;
  place.position = (place.shares.x * a.z + place.shares.y * b.z + place.shares.z * c.z) * place.ray;
  return place;
}

// The normal towards the eye, whichever side of the surface is seen.
Vec3 Shader::normal_at(const Place& place) const {
  const auto& [a, b, c] = place.seen.corners;
  const Vec3 of_triangle = unit(cross(b - a, c - a));
  const bool away = dot(of_triangle, place.position) > 0;
  if (normals_.empty()) return away ? -of_triangle : of_triangle;
  const auto& at = normals_[place.triangle];
  const Vec3 sum = place.shares.x * vec3_of(at[0]) + place.shares.y * vec3_of(at[1]) + place.shares.z * vec3_of(at[2]);
  const Vec3 normal = camera_.turned(unit(sum));
  return dot(normal, of_triangle) * (away ? -1 : 1) < 0 ? -normal : normal;
}

Vec3 Shader::surface_colour(const Place& place) const {
  if (quality_.empty()) return colour_;
  const auto& t = mesh_.triangles[place.triangle];
  const double number =
      place.shares.x * quality_[t[0]] + place.shares.y * quality_[t[1]] + place.shares.z * quality_[t[2]];
  if (!std::isfinite(number)) return colour_;
  const auto [low, high] = range_;
  return viridis(high > low ? (number - low) / (high - low) : 0);
}

// The share of a sample that is an edge: 1 within half a line's width of a side, by the distance in the frame.
double Shader::edge_strength(const Place& place) const {
  const double step_x = camera_.ray(1, 0).x - camera_.ray(0, 0).x;
  const double step_y = camera_.ray(0, 1).y - camera_.ray(0, 0).y;
  double nearest = std::numeric_limits<double>::infinity();
  for (const Vec3& side : place.seen.sides) {
    const double slope = std::hypot(side.x * step_x, side.y * step_y);
    if (slope > 0) nearest = std::min(nearest, std::abs(dot(side, place.ray)) / slope);
  }
  return nearest < kEdgeHalfWidth * options_.samples ? kEdgeStrength : 0;
}

// The openness of a place: 1 in the open, less where other parts rise beside it. The estimator is that of McGuire,
// Osman, Bukowski and Hennessy 2011, "The Alchemy screen-space ambient obscurance algorithm".
double Shader::openness(const Place& place, const Vec3& normal) const {
  const double reach = kObscuranceReach * camera_.reach();
  const double radius = reach * camera_.samples_per_unit(place.position.z);
  const double turn = 2 * std::numbers::pi * grain(place.column, place.row);
  const double x = radius * std::cos(turn);
  const double y = radius * std::sin(turn);
  double sum = 0;
  for (const auto& [along, across] : kSpiral) {
    const auto column = place.column + static_cast<std::int64_t>(std::floor(0.5 + x * along - y * across));
    const auto row = place.row + static_cast<std::int64_t>(std::floor(0.5 + y * along + x * across));
    if (column < 0 || row < 0 || column >= camera_.columns() || row >= camera_.rows()) continue;
    const std::uint64_t word = visibility_.at(column, row);
    if (word == Visibility::kNothing) continue;
    const Vec3 other =
        Visibility::distance_of(word) * camera_.ray(static_cast<double>(column) + 0.5, static_cast<double>(row) + 0.5);
    const Vec3 way = (1 / reach) * (other - place.position);
    const double squared = dot(way, way);
    sum += std::max(0.0, dot(way, normal) - kObscuranceBias) / (squared + 1e-3);
  }
  return std::max(0.0, 1 - kObscuranceStrength * sum / kTaps);
}

Vec3 Shader::light_at(std::int64_t column, std::int64_t row) const {
  const Place place = place_at(column, row);
  const Vec3 normal = normal_at(place);
  const Vec3 to_eye = unit(-place.position);
  const double open = openness(place, normal);
  const double above = (1 + normal.y) / 2;
  double strength = open * (above * kAmbientFromAbove + (1 - above) * kAmbientFromBelow);
  for (const Light& light : kLights) {
    strength += (0.25 + 0.75 * open) * light.strength * std::max(0.0, dot(normal, light.towards));
  }
  const double gloss =
      kGloss * open * std::pow(std::max(0.0, dot(normal, unit(kLights[0].towards + to_eye))), kGlossExponent);
  const double ink = options_.wireframe ? edge_strength(place) : 0;
  return (1 - ink) * (strength * surface_colour(place) + Vec3{gloss, gloss, gloss});
}

}  // namespace isoweave::render
