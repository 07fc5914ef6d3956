// Polygons that are not convex: their triangles cover them once, whichever corner they begin with.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "isoweave/measure.hpp"
#include "mesh_file_helpers.hpp"
#include "meshes.hpp"

namespace isoweave::testing::read_mesh_polygons_test {
namespace {

using mesh_files::parse;
using Triangles = std::vector<meshes::Triangle>;
using Outline = std::vector<std::pair<int, int>>;

// The outline in a plane of space: axes say which coordinates run along it.
std::string vertices(const Outline& outline, int across, const std::string& keyword) {
  std::string text;
  for (const auto& [a, b] : outline) {
    std::array<int, 3> place{a, b, 5};
    std::rotate(place.begin(), place.begin() + across, place.end());
    text += keyword;
    for (const int coordinate : place) text += " " + std::to_string(coordinate);
    text += "\n";
  }
  return text;
}

std::string face(std::size_t corners, int first) {
  std::string text;
  for (std::size_t n = 0; n < corners; ++n) text += " " + std::to_string(static_cast<int>(n) + first);
  return text + "\n";
}

TriangleMesh in_obj(const Outline& outline, int across = 0) {
  return parse("a.obj", vertices(outline, across, "v") + "f" + face(outline.size(), 1));
}

struct Shape {
  const char* name;
  Outline outline;
  double area;
};

const std::vector<Shape> kShapes{
    {"dart", {{0, 0}, {2, 1}, {4, 0}, {2, 4}}, 6},
    {"L", {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}, 7},
    {"U", {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 7},
    {"comb",
     {{0, 0}, {9, 0}, {9, 4}, {8, 4}, {8, 1}, {7, 1}, {7, 4}, {6, 4}, {6, 1}, {5, 1}, {5, 4}, {4, 4}, {4, 1}, {0, 1}},
     18},
    {"corners on a line", {{0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 1}, {1, 1}, {0, 1}}, 6},
    {"keyhole", {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}, 12}};

TEST(ReadMeshPolygons, AreCoveredOnce) {
  for (const Shape& shape : kShapes) {
    Outline outline = shape.outline;
    for (std::size_t turn = 0; turn < outline.size(); ++turn) {
      for (int across = 0; across < 3; ++across) {
        for (const bool other_side : {false, true}) {
          Outline seen = outline;
          if (other_side) std::reverse(seen.begin(), seen.end());
          const TriangleMesh mesh = in_obj(seen, across);
          EXPECT_EQ(mesh.triangles.size(), outline.size() - 2);
          EXPECT_NEAR(check_mesh(mesh).area, shape.area, 1e-9) << shape.name << " from " << turn << " axis " << across;
          EXPECT_TRUE(mesh.notes.empty()) << shape.name;
          // A prism's volume has the sign of its side: the triangles look where the polygon does.
          double turned = 0;
          for (const auto& t : mesh.triangles) {
            const auto at = [&](int c, int axis) {
              return double{
                  mesh.vertices[t[static_cast<std::size_t>(c)]][static_cast<std::size_t>((axis - across + 3) % 3)]};
            };
            turned += (at(1, 0) - at(0, 0)) * (at(2, 1) - at(0, 1)) - (at(1, 1) - at(0, 1)) * (at(2, 0) - at(0, 0));
          }
          EXPECT_EQ(turned, (other_side ? -2 : 2) * shape.area) << shape.name;
        }
      }
      std::rotate(outline.begin(), outline.begin() + 1, outline.end());
    }
  }
}

TEST(ReadMeshPolygons, ConvexOnesAreFans) {
  EXPECT_EQ(in_obj({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}}).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
  EXPECT_EQ(in_obj({{2, 1}, {4, 0}, {2, 4}, {0, 0}}).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}))
      << "a dart from its inner corner";
  EXPECT_EQ(in_obj({{0, 0}, {1, 0}, {2, 0}, {2, 2}}).triangles, (Triangles{{0, 1, 2}, {0, 2, 3}})) << "on a line";
}

TEST(ReadMeshPolygons, OfEveryFormat) {
  const Outline& dart = kShapes[0].outline;
  const std::string corners = face(4, 0);
  const std::string places = vertices(dart, 0, "");
  const auto sorted = [](TriangleMesh mesh) {
    for (auto& t : mesh.triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    std::sort(mesh.triangles.begin(), mesh.triangles.end());
    return mesh.triangles;
  };
  const Triangles expected{{0, 1, 3}, {1, 2, 3}};
  EXPECT_EQ(sorted(in_obj(dart)), expected);
  EXPECT_EQ(sorted(parse("a.obj", "f" + face(4, 1) + vertices(dart, 0, "v"))), expected) << "before its vertices";
  EXPECT_EQ(sorted(parse("a.off", "OFF\n4 1 0\n" + places + "4" + corners)), expected);
  const std::string element = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_index\n";
  const std::string ply = "ply\nformat ascii 1.0\n";
  EXPECT_EQ(sorted(parse("a.ply", ply + element + faces + "end_header\n" + places + "4" + corners)), expected);
  EXPECT_EQ(sorted(parse("a.ply", ply + faces + element + "end_header\n4" + corners + places)), expected)
      << "before its vertices";
}

TEST(ReadMeshPolygons, ThoseThatCrossThemselvesAreTold) {
  const TriangleMesh star = in_obj({{0, 0}, {4, 0}, {1, 3}, {2, -2}, {3, 3}});
  EXPECT_EQ(star.triangles.size(), 3U);
  EXPECT_EQ(star.notes, std::vector<std::string>{"1 polygons cross themselves: their triangles overlap"});
}

// What a polygon may take is bounded; beyond that it is a fan.
TEST(ReadMeshPolygons, OfVeryManyCorners) {
  Outline comb;
  for (int n = 0; n < 40'000; ++n) {
    comb.emplace_back(2 * n, 3);
    comb.emplace_back(2 * n + 1, n % 7);
  }
  comb.emplace_back(80'000, -10);
  comb.emplace_back(0, -10);
  std::reverse(comb.begin(), comb.end());
  EXPECT_EQ(in_obj(comb).triangles.size(), 80'000U);
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_polygons_test
