#include "render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace isoweave::render {
namespace {

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kHalfAngle = 12 * kDegree;  // of the shorter side of the frame
constexpr double kFilled = 0.92;             // of the frame; the rest is margin

// The largest value of a linear function over points.
struct Largest {
  double value = std::numeric_limits<double>::lowest();
  void add(double x) { value = std::max(value, x); }
};

}  // namespace

Camera::Camera(const TriangleMesh& mesh, const RenderOptions& options)
    : columns_(std::int64_t{options.width} * options.samples), rows_(std::int64_t{options.height} * options.samples) {
  const double shorter = std::min(options.width, options.height);
  width_ = std::tan(kHalfAngle) * options.width / shorter;
  height_ = std::tan(kHalfAngle) * options.height / shorter;
  // RAS is LPS turned by half a circle about z: the front of a patient is on the other side.
  const double azimuth = (options.view.azimuth + (mesh.space == "RAS" ? 180 : 0)) * kDegree;
  const double elevation = options.view.elevation * kDegree;
  right_ = {std::cos(azimuth), std::sin(azimuth), 0};
  forward_ = {-std::sin(azimuth) * std::cos(elevation), std::cos(azimuth) * std::cos(elevation), -std::sin(elevation)};
  up_ = cross(right_, forward_);
  fit(mesh);
}

// A point is inside the frame when |x - eye.x| <= a (z - eye.z), where a is the frame's filled half width, and likewise
// for y. So the largest x - a z and -x - a z over all points bound eye.x and eye.z: half of their sum is the distance
// that the eye has to be back, half of their difference its place to the side.
void Camera::fit(const TriangleMesh& mesh) {
  const double a = kFilled * width_;
  const double b = kFilled * height_;
  Largest right, left, top, bottom, nearest, farthest;
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t v : triangle) {
      const Vec3 p = turned(vec3_of(mesh.vertices[v]));
      right.add(p.x - a * p.z);
      left.add(-p.x - a * p.z);
      top.add(p.y - b * p.z);
      bottom.add(-p.y - b * p.z);
      nearest.add(-p.z);
      farthest.add(p.z);
    }
  }
  const double depth = farthest.value + nearest.value;
  const double back = std::max((right.value + left.value) / (2 * a), (top.value + bottom.value) / (2 * b));
  const double gap = back - nearest.value;  // from the eye to what is nearest
  // The eye is never on the surface, not even on that of a line or a point.
  const double size = std::max(gap, depth);
  const double eye = -nearest.value - (size > 0 ? std::max(gap, 1e-3 * size) : 1);
  eye_ = {(right.value - left.value) / 2, (top.value - bottom.value) / 2, eye};
  scale_ = 1 / (farthest.value - eye);
  reach_ = scale_ * height_ * ((farthest.value - nearest.value) / 2 - eye);
}

}  // namespace isoweave::render
