// A pinhole camera, and the frame of samples behind it.
#pragma once

#include <cstdint>

#include "isoweave/render.hpp"
#include "lattice/vec3.hpp"

namespace isoweave::render {

inline Vec3 vec3_of(const Point& p) { return {double{p[0]}, double{p[1]}, double{p[2]}}; }

// In camera coordinates x goes to the right, y up, z away from the eye. Visible points have 0 < z <= 1. A point of the
// frame stands for the ray x, y, 1.
class Camera {
 public:
  // Looks at the mesh so that all of its triangles just fit into the frame, but for a margin.
  Camera(const TriangleMesh& mesh, const RenderOptions& options);

  std::int64_t columns() const { return columns_; }
  std::int64_t rows() const { return rows_; }

  Vec3 turned(const Vec3& direction) const {
    return {dot(right_, direction), dot(up_, direction), dot(forward_, direction)};
  }
  Vec3 placed(const Point& p) const { return scale_ * (turned(vec3_of(p)) - eye_); }

  // The ray through a sample, from the left and from the top.
  Vec3 ray(double column, double row) const {
    return {(2 * column / static_cast<double>(columns_) - 1) * width_,
            (1 - 2 * row / static_cast<double>(rows_)) * height_, 1};
  }

  // The column and row of a point in camera coordinates; the inverse of ray().
  double column_of(const Vec3& p) const { return (p.x / p.z / width_ + 1) / 2 * static_cast<double>(columns_); }
  double row_of(const Vec3& p) const { return (1 - p.y / p.z / height_) / 2 * static_cast<double>(rows_); }

  // Half of the height that the frame shows at the distance of the mesh's middle.
  double reach() const { return reach_; }

  // Samples per unit of length at a distance.
  double samples_per_unit(double z) const { return static_cast<double>(rows_) / (2 * height_ * z); }

 private:
  void fit(const TriangleMesh& mesh);

  std::int64_t columns_, rows_;
  double width_, height_;  // half of the frame at distance 1
  Vec3 right_, up_, forward_;
  Vec3 eye_;  // turned
  double scale_ = 1;
  double reach_ = 1;
};

}  // namespace isoweave::render
