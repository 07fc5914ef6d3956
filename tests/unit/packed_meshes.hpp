// A mesh that is written packed, and how near another one is.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "mesh/write/mesh_file_sink.hpp"
#include "meshes.hpp"

namespace isoweave::packed {

inline MeshFileOptions packed_options() {
  MeshFileOptions options;
  options.unit = "mm";
  options.compress = true;
  return options;
}

// A bent sheet, away from the origin, with a vertex of no triangle.
inline TriangleMesh sheet() {
  TriangleMesh mesh = meshes::grid(20);
  for (Point& p : mesh.vertices) p = {p[0] + 100, p[1] * 0.7F - 50, std::sin(p[0] * 0.3F) * 3};
  mesh.vertices.push_back({120, -36, 0});
  return mesh;
}

inline std::vector<std::string> write(const std::string& path, const TriangleMesh& mesh,
                                      const MeshFileOptions& options) {
  std::vector<Triangle64> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  const auto sink = open_mesh_file(path, options);
  sink->append({.vertices = mesh.vertices, .normals = mesh.normals, .triangles = triangles});
  sink->finish();
  return sink->notes();
}

using Corners = std::array<std::array<double, 3>, 3>;

// Triangles by their centres, to match them whatever their order.
inline std::vector<Corners> sorted(std::vector<Corners> triangles) {
  const auto centre = [](const Corners& t) {
    std::array<long, 3> c{};
    for (std::size_t axis = 0; axis < 3; ++axis) c[axis] = std::lround((t[0][axis] + t[1][axis] + t[2][axis]) * 20);
    return c;
  };
  std::sort(triangles.begin(), triangles.end(),
            [&](const Corners& a, const Corners& b) { return centre(a) < centre(b); });
  return triangles;
}

inline std::vector<Corners> corners_of(const TriangleMesh& mesh) {
  std::vector<Corners> all;
  for (const auto& t : mesh.triangles) {
    Corners corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t axis = 0; axis < 3; ++axis) corners[c][axis] = mesh.vertices[t[c]][axis];
    }
    all.push_back(corners);
  }
  return sorted(all);
}

// The same triangles, each corner within `error`, wherever a triangle begins.
inline void expect_close(const std::vector<Corners>& a, const std::vector<Corners>& b, double error) {
  ASSERT_EQ(a.size(), b.size());
  double worst = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    double best = 1e9;
    for (std::size_t turn = 0; turn < 3; ++turn) {
      double far = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const auto& p = a[n][c];
        const auto& q = b[n][(c + turn) % 3];
        far = std::max(far, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
      }
      best = std::min(best, far);
    }
    worst = std::max(worst, best);
  }
  EXPECT_LE(worst, error);
}

}  // namespace isoweave::packed
