// The light that a sample sends to the eye.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "render/visibility.hpp"

namespace isoweave::render {

using CornerNormals = std::vector<std::array<Point, 3>>;  // of each triangle

// The normals for smooth shading: the mesh's own where it has some, or at each corner of a triangle the mean, by area,
// of the triangles around the vertex that are not across a crease.
CornerNormals smooth_normals(const TriangleMesh& mesh, const Executor& executor);

class Shader {
 public:
  // All arguments must outlive the shader.
  Shader(const TriangleMesh& mesh, const CornerNormals& normals, std::span<const float> quality,
         const RenderOptions& options, const Camera& camera, const Visibility& visibility);

  // Linear light of a sample that shows a triangle.
  Vec3 light_at(std::int64_t column, std::int64_t row) const;

 private:
  struct Place;
  Place place_at(std::int64_t column, std::int64_t row) const;
  Vec3 normal_at(const Place& place) const;
  Vec3 surface_colour(const Place& place) const;
  double edge_strength(const Place& place) const;
  double openness(const Place& place, const Vec3& normal) const;

  const TriangleMesh& mesh_;
  const CornerNormals& normals_;  // empty for flat shading
  std::span<const float> quality_;
  const RenderOptions& options_;
  const Camera& camera_;
  const Visibility& visibility_;
  Vec3 colour_;
  std::array<double, 2> range_;  // of the colour map
};

}  // namespace isoweave::render
