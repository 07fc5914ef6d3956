#include "render/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

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

// Where the camera of View{0, 0} looks, and what is at the right of its picture.
struct Front {
  Vec3 right, forward;
};

// x and y of RAS are those of LPS with the other sign.
constexpr Vec3 other_space(const Vec3& direction) { return {-direction.x, -direction.y, direction.z}; }

constexpr Axis other_space(Axis axis) {
  switch (axis) {
    case Axis::kX:
      return Axis::kMinusX;
    case Axis::kY:
      return Axis::kMinusY;
    case Axis::kMinusX:
      return Axis::kX;
    case Axis::kMinusY:
      return Axis::kY;
    default:
      return axis;
  }
}

constexpr Front front_of(Axis up) {
  switch (up) {
    case Axis::kX:
      return {{0, 0, -1}, {0, 1, 0}};
    case Axis::kY:
      return {{1, 0, 0}, {0, 0, -1}};
    case Axis::kMinusX:
      return {{0, 0, 1}, {0, 1, 0}};
    case Axis::kMinusY:
      return {{1, 0, 0}, {0, 0, 1}};
    case Axis::kMinusZ:
      return {{-1, 0, 0}, {0, 1, 0}};
    default:
      return {{1, 0, 0}, {0, 1, 0}};
  }
}

Front front_of(Axis up, const std::string& space) {
  if (space != "RAS") return front_of(up);
  const Front lps = front_of(other_space(up));
  return {other_space(lps.right), other_space(lps.forward)};
}

}  // namespace

Camera::Camera(const TriangleMesh& mesh, const RenderOptions& options)
    : columns_(std::int64_t{options.width} * options.samples), rows_(std::int64_t{options.height} * options.samples) {
  const double shorter = std::min(options.width, options.height);
  width_ = std::tan(kHalfAngle) * options.width / shorter;
  height_ = std::tan(kHalfAngle) * options.height / shorter;
  const double azimuth = options.view.azimuth * kDegree;
  const double elevation = options.view.elevation * kDegree;
  const Front front = front_of(options.up, mesh.space);
  const Vec3 level = std::cos(azimuth) * front.forward - std::sin(azimuth) * front.right;
  right_ = std::cos(azimuth) * front.right + std::sin(azimuth) * front.forward;
  forward_ = std::cos(elevation) * level - std::sin(elevation) * cross(front.right, front.forward);
  up_ = cross(right_, forward_);
  fit(mesh);
  width_ /= options.zoom;
  height_ /= options.zoom;
  reach_ /= options.zoom;
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
