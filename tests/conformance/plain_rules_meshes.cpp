// Whole meshes of mesh files, compared bit for bit with those of rules that were written a second time.
// Threads: none, the loops are those of schedules.cpp
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "conformance/plain_scenes.hpp"
#include "meshes.hpp"
#include "plain_rules/volume_surface.hpp"

namespace isoweave::testing::plain_rules_meshes_test {

using namespace plain_scenes;

namespace {

// A hub with spokes, flat but for a wave; a double one has two hubs, one above the other, and no border.
TriangleMesh wheel(std::uint32_t spokes, bool twice) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0.4F}, {0, 0, -0.5F}};
  for (std::uint32_t n = 0; n < spokes; ++n) {
    const std::uint32_t next = 2 + (n + 1) % spokes;
    const double angle = 6.283185307179586 * n / spokes;
    mesh.vertices.push_back(
        {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), n % 2 == 0 ? 0.01F : 0.0F});
    mesh.triangles.push_back({0, 2 + n, next});
    if (twice) mesh.triangles.push_back({1, next, 2 + n});
  }
  return mesh;
}

// A flat grid whose vertices have moved within it, some of them to others: all costs are equal, many places turn a
// face over, and there are edges without length and faces without area.
TriangleMesh crumpled_grid(std::uint32_t n) {
  TriangleMesh mesh = meshes::grid(n);
  std::mt19937 random(7);
  for (Point& p : mesh.vertices) {
    for (std::size_t axis = 0; axis < 2; ++axis) p[axis] += static_cast<float>(random() % 129) / 128 - 0.5F;
    mesh.values.push_back(static_cast<float>(random() % 100));
  }
  for (std::size_t v = 0; v + 1 < mesh.vertices.size(); v += 7) mesh.vertices[v] = mesh.vertices[v + 1];
  return mesh;
}

// Cuts each triangle into four.
TriangleMesh refined(const TriangleMesh& mesh) {
  TriangleMesh out;
  out.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(out.vertices.size()));
    if (is_new) {
      const Point& p = mesh.vertices[a];
      const Point& q = mesh.vertices[b];
      out.vertices.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
    }
    return found->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    out.triangles.insert(out.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return out;
}

// A cube that has been sheared: beside its corners large errors cancel but for rounding.
TriangleMesh skewed_cube() {
  TriangleMesh mesh = refined(refined(refined(meshes::cube())));
  for (auto& [x, y, z] : mesh.vertices) {
    x += 0.37F * y + 0.11F * z;
    y += 0.23F * z - 0.41F * x;
    z += 0.31F * x;
  }
  return mesh;
}

// Meshes of files: ids are positions there, lengths are in roots of twice the mean area of a triangle.
plain::Outcome compare(const TriangleMesh& mesh, const MeshOptions& options, const std::string& what) {
  RunControl control;
  control.threads = 1;
  control.piece = 50;
  MeshInMemory sink;
  const MeshReport report = simplify_mesh(mesh, sink, options, control);
  const plain::Surface surface = plain::surface_of(mesh);
  plain::Outcome plain = plain::simplify(surface, plain_options(options, std::sqrt(surface.face)));
  expect_same(sink.copy(), report, plain,
              what + ", error " + std::to_string(options.error.value) + ", quality " +
                  std::to_string(static_cast<int>(options.quality)));
  return plain;
}

void compare_all(const TriangleMesh& mesh, const std::string& what) {
  for (const double error : {0.02, 0.5, 3.0}) {
    for (const Quality quality : kQualities) {
      MeshOptions options;
      options.error = Length::voxels(error);
      options.quality = quality;
      options.drop_specks = error > 1;
      compare(mesh, options, what);
    }
  }
}

// Vertices and triangles in another order.
TriangleMesh shuffled(const TriangleMesh& mesh) {
  std::mt19937 random(11);
  std::vector<std::uint32_t> from(mesh.vertices.size());
  std::iota(from.begin(), from.end(), 0U);
  std::shuffle(from.begin(), from.end(), random);
  TriangleMesh out = mesh;
  std::vector<std::uint32_t> to(from.size());
  for (std::uint32_t v = 0; v < from.size(); ++v) {
    to[from[v]] = v;
    out.vertices[v] = mesh.vertices[from[v]];
  }
  for (auto& triangle : out.triangles) {
    for (std::uint32_t& v : triangle) v = to[v];
  }
  std::shuffle(out.triangles.begin(), out.triangles.end(), random);
  return out;
}

TriangleMesh unsimplified(const std::string& kind, bool closed) {
  Scene scene = generated(kind);
  scene.options.error = {};
  scene.options.closed = closed;
  return mesh_of(scene, scene.options).mesh;
}

TEST(PlainRules, MeshesOfFiles) {
  for (const std::string& kind : some({"noise", "torus", "white"})) {
    for (const bool closed : {true, false}) {
      TriangleMesh mesh = shuffled(unsimplified(kind, closed));
      for (std::size_t v = 0; v < mesh.vertices.size(); ++v) mesh.values.push_back(static_cast<float>(v % 17));
      compare_all(mesh, kind);
    }
  }
}

// Of more triangles than the mean area is summed over at a time.
TEST(PlainRules, ObliquePlanesOfAFile) {
  Scene scene = planes(true, 36);
  scene.options.error = {};
  const TriangleMesh mesh = shuffled(mesh_of(scene, scene.options).mesh);
  EXPECT_GT(mesh.triangles.size(), 5000U);
  MeshOptions options;
  options.error = Length::voxels(0.3);
  compare(mesh, options, "planes");
}

// Some collapses are forbidden by a ring of many neighbours, by borders and by what is no manifold.
TEST(PlainRules, MeshesOfOddShapes) {
  compare_all(meshes::tetrahedron(), "tetrahedron");
  compare_all(meshes::cube(), "cube");
  compare_all(meshes::grid(9), "grid");
  compare_all(crumpled_grid(14), "crumpled grid");
  compare_all(skewed_cube(), "skewed cube");
  compare_all(meshes::two_tetrahedra_sharing_a_vertex(), "two tetrahedra at a vertex");
  compare_all(meshes::two_tetrahedra_sharing_an_edge(), "two tetrahedra at an edge");
  compare_all(meshes::moebius_strip(), "Moebius strip");
  compare_all(meshes::cube_with_a_flipped_triangle(), "flipped triangle");
  for (const std::uint32_t spokes : {3U, 24U, 25U, 26U, 27U, 29U, 40U}) {
    compare_all(wheel(spokes, false), "open wheel of " + std::to_string(spokes));
    compare_all(wheel(spokes, true), "double wheel of " + std::to_string(spokes));
  }
}

// Where triangles are left out of a surface at random it has borders, and vertices of several fans.
TEST(PlainRules, MeshesWithHoles) {
  for (const std::string& kind : some({"noise", "gyroid", "box"})) {
    TriangleMesh mesh = unsimplified(kind, true);
    std::mt19937 random(3);
    std::erase_if(mesh.triangles, [&](const auto&) { return random() % 8 == 0; });
    for (std::size_t n = 0; n < mesh.triangles.size(); n += 40) std::swap(mesh.triangles[n][0], mesh.triangles[n][1]);
    for (std::size_t n = 0; n < mesh.triangles.size(); n += 90) mesh.triangles[n][2] = mesh.triangles[n][0];
    compare_all(mesh, kind);
    MeshOptions options;
    options.error = Length::voxels(1);
    options.max_distance = Length::voxels(0.4);
    EXPECT_GT(compare(mesh, options, kind).locked, 0U);
    options.max_distance = {};
    options.triangles = 300;
    compare(mesh, options, kind);
  }
}

}  // namespace
}  // namespace isoweave::testing::plain_rules_meshes_test
