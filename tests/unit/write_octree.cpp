// The parts of the multi-resolution writer: cutting along an octree, sorting in bounded memory, vertices out of a
// file, and the list of nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "files.hpp"
#include "mesh/write/node_grid.hpp"
#include "mesh/write/octree_manifest.hpp"
#include "mesh/write/triangle_sorter.hpp"
#include "mesh/write/waiting_vertices.hpp"

namespace isoweave::testing::write_octree_test {
namespace {

using Corners = std::array<NodePlace, 3>;

Corners corners_of(const NodeTriangle& triangle) {
  const std::array<std::uint32_t, 3> node = node_at(node_of(triangle));
  Corners corners{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      corners[c][axis] = std::int64_t{node[axis]} * 65535 + triangle[3 + 3 * c + axis];
    }
  }
  return corners;
}

// A closed surface of random corners: two fans over one ring, far through many nodes.
std::vector<Corners> random_spindle(std::mt19937_64& random, std::int64_t size) {
  std::uniform_int_distribution<std::int64_t> place(0, size);
  const auto any = [&] { return NodePlace{place(random), place(random), place(random)}; };
  const NodePlace top = any(), bottom = any();
  std::vector<NodePlace> ring;
  for (int n = 0; n < 7; ++n) ring.push_back(any());
  std::vector<Corners> triangles;
  for (std::size_t n = 0; n < ring.size(); ++n) {
    triangles.push_back({top, ring[n], ring[(n + 1) % ring.size()]});
    triangles.push_back({bottom, ring[(n + 1) % ring.size()], ring[n]});
  }
  return triangles;
}

// Edges that are not gone through as often one way as the other.
int count_open_edges(const std::vector<Corners>& triangles) {
  std::map<std::array<NodePlace, 2>, int> edges;
  for (const Corners& t : triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      ++edges[{t[c], t[(c + 1) % 3]}];
      --edges[{t[(c + 1) % 3], t[c]}];
    }
  }
  return static_cast<int>(std::ranges::count_if(edges, [](const auto& edge) { return edge.second > 0; }));
}

double volume_of(const std::vector<Corners>& triangles) {
  double sum = 0;
  for (const Corners& t : triangles) {
    const auto at = [&](std::size_t c, std::size_t axis) { return static_cast<double>(t[c][axis]); };
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      sum += at(0, a) * (at(1, b) * at(2, c) - at(1, c) * at(2, b));
    }
  }
  return sum / 6;
}

void expect_inside(const NodeTriangle& triangle, bool eighths) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({triangle[3 + axis], triangle[6 + axis], triangle[9 + axis]});
    EXPECT_TRUE(!eighths || high <= 32768 || low >= 32768) << low << " to " << high;
  }
}

TEST(NodeCutter, LeavesNoGapsInAClosedSurface) {
  std::mt19937_64 random(7);
  for (const std::size_t level : {std::size_t{0}, std::size_t{1}}) {
    for (const std::int64_t size : {40'000, 300'000, 1'500'000}) {
      for (int round = 0; round < 20; ++round) {
        const std::vector<Corners> whole = random_spindle(random, size);
        NodeCutter cutter(level);
        std::vector<Corners> cut;
        for (const Corners& corners : whole) {
          for (const NodeTriangle& triangle : cutter.cut(corners)) {
            expect_inside(triangle, level > 0);
            cut.push_back(corners_of(triangle));
          }
        }
        EXPECT_EQ(count_open_edges(cut), 0);
        const double room = 1e-3 * static_cast<double>(size) * static_cast<double>(size) * static_cast<double>(size);
        EXPECT_NEAR(volume_of(cut), volume_of(whole), room);
        EXPECT_TRUE(size < 100'000 || cut.size() > 2 * whole.size());
      }
    }
  }
}

TEST(NodeCutter, DoesNotDependOnTheFirstCorner) {
  std::mt19937_64 random(8);
  NodeCutter cutter(1);
  for (const Corners& corners : random_spindle(random, 400'000)) {
    const auto cut = [&](const Corners& turned) {
      const auto found = cutter.cut(turned);
      return std::vector<NodeTriangle>(found.begin(), found.end());
    };
    const std::vector<NodeTriangle> expected = cut(corners);
    EXPECT_EQ(cut({corners[1], corners[2], corners[0]}), expected);
    EXPECT_EQ(cut({corners[2], corners[0], corners[1]}), expected);
  }
}

// A corner on a side needs no cut, a triangle in a side belongs to the lower node, one that is a line to none.
TEST(NodeCutter, PutsSidesWhereTheyBelong) {
  NodeCutter cutter(0);
  ASSERT_EQ(cutter.cut({{{0, 0, 0}, {65535, 0, 0}, {0, 65535, 65535}}}).size(), 1U);
  const auto side = cutter.cut({{{65535, 1, 1}, {65535, 9, 1}, {65535, 1, 9}}});
  ASSERT_EQ(side.size(), 1U);
  EXPECT_EQ(node_of(side[0]), 0U);
  EXPECT_EQ(side[0], (NodeTriangle{0, 0, 0, 65535, 1, 1, 65535, 9, 1, 65535, 1, 9}));
  const auto begin = cutter.cut({{{0, 65536, 1}, {0, 65537, 1}, {0, 65536, 9}}});
  ASSERT_EQ(begin.size(), 1U);
  EXPECT_EQ(node_of(begin[0]), 2U);
  EXPECT_TRUE(cutter.cut({{{1, 2, 3}, {1, 2, 3}, {70000, 0, 0}}}).empty());
}

TEST(NodeGrid, NumbersNodesInZOrder) {
  EXPECT_EQ(node_number({1, 0, 0}), 1U);
  EXPECT_EQ(node_number({0, 1, 0}), 2U);
  EXPECT_EQ(node_number({0, 0, 1}), 4U);
  EXPECT_EQ(node_number({2, 3, 1}), 0b011110U);
  std::mt19937_64 random(9);
  for (int n = 0; n < 100; ++n) {
    std::array<std::uint32_t, 3> node{};
    for (std::uint32_t& axis : node) axis = static_cast<std::uint32_t>(random() % 4096);
    EXPECT_EQ(node_at(node_number(node)), node);
    EXPECT_EQ(node_number({node[0] / 2, node[1] / 2, node[2] / 2}), node_number(node) >> 3) << "of the node above";
  }
}

TEST(NodeGrid, HasTheBoxInWholeNodesHoweverManyTriangles) {
  const std::array<Point, 2> corners{Point{-3, 5, 0.1F}, Point{17, 9, 1.3F}};
  for (const std::uint64_t triangles : {12ULL, 1'000'000ULL, 1'000'000'000ULL, 1'000'000'000'000ULL}) {
    const std::array<std::uint64_t, 2> counts{triangles, triangles / 2};
    const NodeGrid grid(corners, counts);
    EXPECT_EQ(grid.origin(), corners[0]);
    const double along = 20.0 / double{grid.side()};
    EXPECT_GT(along, std::ceil(along) - 1e-3) << "the box ends with a node";
    EXPECT_LE(along, std::ceil(along));
    EXPECT_EQ(std::ceil(along) > 1, triangles > 20'000);
    EXPECT_EQ(grid.place(corners[0], 0), (NodePlace{0, 0, 0}));
    EXPECT_LE(grid.place(corners[1], 0)[0], std::int64_t{65535} * std::lround(std::ceil(along)));
    EXPECT_DOUBLE_EQ(grid.step(3), 8 * grid.step(0));
  }
}

TEST(TriangleSorter, SortsWhatDoesNotFit) {
  std::mt19937 random(10);
  for (const std::size_t count : {0U, 5U, 64U, 3000U}) {
    const files::Folder folder;
    TriangleSorter sorter(folder / "a", {.at_once = 16, .ways = 3, .ahead = 5});
    std::vector<NodeTriangle> all(count);
    for (NodeTriangle& triangle : all) {
      for (std::uint16_t& word : triangle) word = static_cast<std::uint16_t>(random() % 3);
      sorter.add({&triangle, 1});
    }
    std::vector<NodeTriangle> found;
    sorter.take_all([&](const NodeTriangle& triangle) { found.push_back(triangle); });
    std::sort(all.begin(), all.end());
    EXPECT_TRUE(found == all) << count;
  }
}

TEST(WaitingVertices, AreThoseOfTheFile) {
  constexpr std::uint64_t kCount = (std::uint64_t{1} << 20) + 5000;  // more than are kept in memory
  const files::Folder folder;
  OutputDescriptor file(open_scratch(folder / "a"), "a");
  const auto expected = [](std::uint64_t n) { return Point{static_cast<float>(n), static_cast<float>(n % 7), -1}; };
  std::vector<Point> points;
  for (std::uint64_t n = 0; n < kCount; ++n) points.push_back(expected(n));
  file.write(std::as_bytes(std::span(points)));
  const ByteReader reader = [&](std::uint64_t first, std::span<std::byte> bytes) { file.read_back(first, bytes); };
  WaitingVertices vertices(reader, kCount);
  std::mt19937_64 random(11);
  EXPECT_EQ(vertices.at(kCount - 1), expected(kCount - 1));
  for (int n = 0; n < 20'000; ++n) {
    const std::uint64_t near = random() % 100;
    for (const std::uint64_t vertex : {near, near + (std::uint64_t{1} << 20), random() % kCount}) {
      ASSERT_EQ(vertices.at(vertex), expected(vertex));
    }
  }
}

std::vector<std::pair<std::uint64_t, std::uint32_t>> nodes_of(const OctreeLevel& level) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> nodes;
  for (const OctreeNode& node : level.nodes) nodes.emplace_back(node.number, node.bytes);
  return nodes;
}

// The finest level has a node 20 that the next one lost; that one has triangles in the eighths 8 and 11, of which the
// finest has 8 alone; the coarsest has nothing above node 2.
TEST(OctreeManifest, NodesThatAreMissingAreThereWithoutAFragment) {
  std::vector<OctreeLevel> levels(3);
  levels[0].nodes = {{8, 100}, {20, 50}};
  levels[1].nodes = {{1, 70}};
  levels[1].eighths = {8, 11};
  levels[2].nodes = {{0, 30}};
  levels[2].eighths = {1};
  complete_octree(levels);
  using Nodes = std::vector<std::pair<std::uint64_t, std::uint32_t>>;
  EXPECT_EQ(nodes_of(levels[0]), (Nodes{{8, 100}, {11, 0}, {20, 50}}));
  EXPECT_EQ(nodes_of(levels[1]), (Nodes{{1, 70}, {2, 0}}));
  EXPECT_EQ(nodes_of(levels[2]), (Nodes{{0, 30}}));
}

}  // namespace
}  // namespace isoweave::testing::write_octree_test
