// Every vertex has one owner, who meets all triangles that name it, in their order.
// Threads: VertexOwners.*
#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "parallel/vertex_owners.hpp"

namespace isoweave::testing::parallel_vertex_owners_test {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Strips of neighbours, as surfaces have them, or any three vertices.
Triangles make_triangles(std::size_t count, std::uint32_t vertices, bool shuffled) {
  std::mt19937 random(7);
  std::uniform_int_distribution<std::uint32_t> any(0, vertices - 1);
  Triangles triangles(count);
  for (std::size_t n = 0; n < count; ++n) {
    const auto near = static_cast<std::uint32_t>(n * (vertices - 2) / count);
    triangles[n] = {near, near + 1, near + 2};
    if (shuffled) triangles[n] = {any(random), any(random), any(random)};
  }
  return triangles;
}

using Uses = std::vector<std::vector<std::size_t>>;  // triangles at each vertex

Uses uses_by_owners(const Triangles& triangles, std::uint32_t vertices, int threads) {
  const Executor executor(threads);
  Uses uses(vertices);
  VertexOwners(executor, triangles).for_parts(vertices, [&](const VertexOwners::Part& part) {
    part.each_triangle([&](std::size_t n) {
      for (const std::uint32_t v : triangles[n]) {
        if (part.has(v)) uses[v].push_back(n);
      }
    });
  });
  return uses;
}

Uses plain_uses(const Triangles& triangles, std::uint32_t vertices) {
  Uses uses(vertices);
  for (std::size_t n = 0; n < triangles.size(); ++n) {
    for (const std::uint32_t v : triangles[n]) uses[v].push_back(n);
  }
  return uses;
}

TEST(VertexOwners, MeetAllTrianglesOfTheirVertices) {
  for (const bool shuffled : {false, true}) {
    for (const std::size_t count : {0u, 1u, 2048u, 2049u, 20000u}) {
      const Triangles triangles = make_triangles(count, 5000, shuffled);
      const Uses expected = plain_uses(triangles, 5000);
      for (const int threads : {1, 3, 4}) {
        EXPECT_EQ(uses_by_owners(triangles, 5000, threads), expected) << shuffled << count << threads;
      }
    }
  }
}

TEST(VertexOwners, CoverVerticesThatNobodyNames) {
  const Executor executor(4);
  const Triangles triangles{{2, 3, 4}};
  std::vector<int> seen(11, 0);
  VertexOwners(executor, triangles).for_parts(seen.size(), [&](const VertexOwners::Part& part) {
    for (std::uint32_t v = part.first; v < part.first + part.size; ++v) ++seen[v];
  });
  EXPECT_EQ(seen, std::vector<int>(11, 1));
}

TEST(VertexOwners, VisitNothingFarAway) {
  const Executor executor(2);
  const Triangles triangles = make_triangles(200000, 100000, false);
  std::vector<std::size_t> visited(2, 0);
  VertexOwners(executor, triangles).for_parts(100000, [&](const VertexOwners::Part& part) {
    part.each_triangle([&](std::size_t) { ++visited[part.first == 0 ? 0 : 1]; });
  });
  for (const std::size_t count : visited) EXPECT_LT(count, 110000u);
}

TEST(VertexOwners, KnowTheLargestVertex) {
  const Executor executor(3);
  Triangles triangles = make_triangles(9000, 4000, true);
  triangles[5000][1] = 123456;
  EXPECT_EQ(VertexOwners(executor, triangles).largest_vertex(), 123456u);
  EXPECT_EQ(VertexOwners(executor, Triangles{}).largest_vertex(), 0u);
}

}  // namespace
}  // namespace isoweave::testing::parallel_vertex_owners_test
