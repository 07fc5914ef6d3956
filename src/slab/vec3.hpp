// Three doubles. Every sum is written out, left to right: the order is part of the result.
#pragma once

#include "parallel/host_device.hpp"

namespace isoweave {

struct Vec3 {
  double x = 0, y = 0, z = 0;
};

ISOWEAVE_HD inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
ISOWEAVE_HD inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
ISOWEAVE_HD inline Vec3 operator*(double s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
ISOWEAVE_HD inline Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
ISOWEAVE_HD inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
ISOWEAVE_HD inline Vec3 cross(Vec3 a, Vec3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
ISOWEAVE_HD inline Vec3 midpoint(Vec3 a, Vec3 b) { return 0.5 * (a + b); }

}  // namespace isoweave
