// Meshes small enough to check by hand.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave::meshes {

using Triangle = std::array<std::uint32_t, 3>;

// Names that stand for every format of files that is written.
inline constexpr std::array<const char*, 7> kFileNames{"a.ply", "a.stl", "a.obj", "a.off", "a.glb", "a.vtp", "a.3mf"};

// The corner of the unit cube: closed, outward, volume 1/6.
inline TriangleMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}, {}};
}

// The unit cube, 12 triangles: closed, outward, area 6, volume 1. Vertex bits are x, y, z.
inline TriangleMesh cube() {
  TriangleMesh mesh;
  for (unsigned i = 0; i < 8; ++i) {
    mesh.vertices.push_back(
        {static_cast<float>(i & 1U), static_cast<float>(i >> 1U & 1U), static_cast<float>(i >> 2U & 1U)});
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// n x n unit squares in the plane z, two triangles each, facing up: a disc with 4n boundary edges.
inline TriangleMesh grid(std::uint32_t n, float z = 0) {
  TriangleMesh mesh;
  for (std::uint32_t j = 0; j <= n; ++j) {
    for (std::uint32_t i = 0; i <= n; ++i) mesh.vertices.push_back({static_cast<float>(i), static_cast<float>(j), z});
  }
  for (std::uint32_t j = 0; j < n; ++j) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t v = j * (n + 1) + i;
      mesh.triangles.push_back({v, v + 1, v + n + 2});
      mesh.triangles.push_back({v, v + n + 2, v + n + 1});
    }
  }
  return mesh;
}

// Two tetrahedra with nothing in common but vertex 0.
inline TriangleMesh two_tetrahedra_sharing_a_vertex() {
  TriangleMesh mesh = tetrahedron();
  for (const Point& p : {Point{-1, 0, 0}, Point{0, -1, 0}, Point{0, 0, -1}}) mesh.vertices.push_back(p);
  // A point reflection turns a tetrahedron inside out, so the triangles are flipped.
  for (const Triangle& t : {Triangle{0, 4, 5}, Triangle{0, 6, 4}, Triangle{4, 6, 5}, Triangle{5, 6, 0}}) {
    mesh.triangles.push_back(t);
  }
  return mesh;
}

// Two tetrahedra with nothing in common but the edge between vertices 0 and 1: it has four triangles.
inline TriangleMesh two_tetrahedra_sharing_an_edge() {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.push_back({0, -1, 0});
  mesh.vertices.push_back({0, 0, -1});
  // The first one turned by half a turn about the x axis: 2 becomes 4, 3 becomes 5.
  for (const Triangle& t : {Triangle{0, 4, 1}, Triangle{0, 1, 5}, Triangle{1, 4, 5}, Triangle{4, 0, 5}}) {
    mesh.triangles.push_back(t);
  }
  return mesh;
}

// The five-vertex Moebius strip: triangle i joins vertices i, i+1, i+2 of a ring of five. One-sided, so at least one
// edge is run along twice in the same direction however the triangles are turned; one boundary loop of five edges.
inline TriangleMesh moebius_strip() {
  return {{{0, 0, 0}, {1, 0, 1}, {2, 1, 0}, {1, 2, 1}, {0, 1, 2}},
          {{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {3, 0, 4}, {4, 0, 1}},
          {}};
}

// A cube with one triangle turned over: its three edges are run along in the same direction by both triangles.
inline TriangleMesh cube_with_a_flipped_triangle() {
  TriangleMesh mesh = cube();
  std::swap(mesh.triangles[4][1], mesh.triangles[4][2]);
  return mesh;
}

}  // namespace isoweave::meshes
