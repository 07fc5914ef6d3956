// The inspection finds fans that are not whole and edges that are there twice.
// Threads: Inspection.*
#include "simplify/inspection.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>
#include <vector>

namespace isoweave::testing::inspection_test {
namespace {

// A surface whose half-edges are linked by hand.
struct Linked {
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;

  Linked(std::size_t vertex_count, const std::vector<std::array<Index, 3>>& corners,
         const std::vector<std::pair<Index, Index>>& twins)
      : vertices(vertex_count), triangles(corners.size()) {
    for (Index t = 0; t < triangles.size(); ++t) {
      for (Index c = 0; c < 3; ++c) triangles[t].sides[c].vertex = corners[t][c];
    }
    for (const auto& [a, b] : twins) {
      view().set_twin(a, b);
      view().set_twin(b, a);
    }
  }

  ZoneView view() {
    ZoneView zone;
    zone.vertices = vertices;
    zone.triangles = triangles;
    return zone;
  }
};

// Inspects vertices many times over, so that walks take turns.
SurfaceDefects inspect(Linked& surface, const std::vector<Index>& once, const std::vector<std::uint32_t>& corners,
                       std::size_t times, int threads) {
  std::vector<Index> vertices;
  for (std::size_t n = 0; n < times; ++n) vertices.insert(vertices.end(), once.begin(), once.end());
  return inspect_fans(surface.view(), vertices, corners, Executor(threads));
}

constexpr std::array<std::size_t, 4> kTimes{1, 4, 5, 301};

// Around vertex 0 lie 1, 2, 1 and 3: the edge to 1 is there twice.
TEST(Inspection, FindsAnEdgeThatIsThereTwice) {
  Linked surface(4, {{0, 1, 2}, {0, 2, 1}, {0, 1, 3}, {0, 3, 1}}, {{2, 4}, {6, 8}, {10, 12}, {14, 0}, {1, 5}, {9, 13}});
  for (Vertex& vertex : surface.vertices) vertex.half_edge = 0;
  for (const std::size_t times : kTimes) {
    const SurfaceDefects found = inspect(surface, {0}, {4}, times, 2);
    EXPECT_EQ(found.nonmanifold_edges, times);
    EXPECT_EQ(found.nonmanifold_vertices, 0U);
  }
}

// Two faces at a border, as one fan, beside a vertex that more faces name, or fewer, than its fan has.
TEST(Inspection, FindsFacesOutsideOfAFan) {
  Linked surface(7, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}}, {{2, 4}});
  surface.vertices[0].half_edge = 0;
  surface.vertices[4].half_edge = 8;
  for (const std::size_t times : kTimes) {
    for (const std::uint32_t named : {0U, 1U, 2U, 7U}) {
      const SurfaceDefects found = inspect(surface, {0, 4}, {2, 0, 0, 0, named}, times, 1);
      EXPECT_EQ(found.nonmanifold_edges, 0U);
      EXPECT_EQ(found.nonmanifold_vertices, named == 1 ? 0 : times);
    }
    EXPECT_EQ(inspect(surface, {0}, {1}, times, 3).nonmanifold_vertices, times) << "a walk ends there";
  }
}

}  // namespace
}  // namespace isoweave::testing::inspection_test
