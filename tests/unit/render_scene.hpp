// Meshes and pictures small enough to say which pixels they cover.
#pragma once

#include <cstddef>
#include <cstdint>

#include "isoweave/render.hpp"

namespace isoweave::render_scene {

// Looks along +y: x to the right, z up.
inline RenderOptions front(int width, int height, int samples = 1) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.view = {0, 0};
  options.background.reset();
  options.samples = samples;
  return options;
}

inline std::uint8_t alpha_at(const Picture& picture, std::int64_t column, std::int64_t row) {
  return picture.pixels[static_cast<std::size_t>(row * picture.width + column)][3];
}

inline Colour colour_at(const Picture& picture, std::int64_t column, std::int64_t row) {
  const auto& p = picture.pixels[static_cast<std::size_t>(row * picture.width + column)];
  return {p[0], p[1], p[2]};
}

// A square in the plane y, seen from the front.
inline TriangleMesh square(float half, float y) {
  return {{{-half, y, -half}, {half, y, -half}, {half, y, half}, {-half, y, half}}, {{0, 1, 2}, {0, 2, 3}}, {}};
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

}  // namespace isoweave::render_scene
