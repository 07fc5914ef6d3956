// A mesh in memory holds what it was given, appended or written into its room.
#include <gtest/gtest.h>

#include <utility>

#include "isoweave/mesh.hpp"

namespace isoweave::testing::write_mesh_in_memory_test {
namespace {

template <class T>
std::vector<T> list(std::span<const T> part) {
  return {part.begin(), part.end()};
}

class NoRoom final : public MeshSink {
 public:
  void append(const MeshPiece&) override {}
  void finish() override {}
};

TEST(MeshInMemory, KeepsPiecesInOrderHoweverTheyCome) {
  MeshInMemory mesh;
  const std::vector<Point> vertices{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const std::vector<Point> normals{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<float> values{0.5F, 1.5F, 2.5F};
  const std::vector<std::array<std::uint64_t, 3>> triangles{{0, 1, 2}};
  mesh.append({vertices, normals, values, triangles});
  const MeshRoom room = mesh.room({.vertices = 1, .triangles = 2, .normals = true, .values = true});
  ASSERT_EQ(room.vertices.size(), 1U);
  ASSERT_EQ(room.normals.size(), 1U);
  ASSERT_EQ(room.values.size(), 1U);
  ASSERT_EQ(room.triangles.size(), 2U);
  room.vertices[0] = {10, 11, 12};
  room.normals[0] = {0, 0, -1};
  room.values[0] = 3.5F;
  room.triangles[0] = {0, 3, 1};
  room.triangles[1] = {2, 1, 3};

  const TriangleMesh copy = mesh.copy();
  EXPECT_EQ(copy.vertices, (std::vector<Point>{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}}));
  EXPECT_EQ(copy.normals, (std::vector<Point>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}}));
  EXPECT_EQ(copy.values, (std::vector<float>{0.5F, 1.5F, 2.5F, 3.5F}));
  EXPECT_EQ(copy.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 3, 1}, {2, 1, 3}}));

  const MeshInMemory moved = std::move(mesh);
  EXPECT_EQ(list(moved.vertices()), copy.vertices);
  EXPECT_EQ(list(moved.normals()), copy.normals);
  EXPECT_EQ(list(moved.values()), copy.values);
  EXPECT_EQ(list(moved.triangles()), copy.triangles);
}

TEST(MeshInMemory, HasNormalsAndValuesOnlyIfPiecesHaveThem) {
  MeshInMemory mesh;
  const MeshRoom room = mesh.room({.vertices = 5, .triangles = 1});
  EXPECT_EQ(room.vertices.size(), 5U);
  EXPECT_TRUE(room.normals.empty());
  EXPECT_TRUE(room.values.empty());
  EXPECT_TRUE(mesh.normals().empty());
  EXPECT_TRUE(mesh.values().empty());
}

TEST(MeshInMemory, KeepsWhatItHasWhenItGrows) {
  constexpr std::uint32_t kPieces = 30;
  constexpr std::uint32_t kCount = 100'000;  // of each, 36 MB in all
  MeshInMemory mesh;
  for (std::uint32_t piece = 0; piece < kPieces; ++piece) {
    const MeshRoom room = mesh.room({.vertices = kCount, .triangles = kCount});
    for (std::uint32_t n = 0; n < kCount; ++n) {
      room.vertices[n] = {static_cast<float>(piece), static_cast<float>(n), 0};
      room.triangles[n] = {piece, n, piece + n};
    }
  }
  ASSERT_EQ(mesh.vertices().size(), std::size_t{kPieces} * kCount);
  ASSERT_EQ(mesh.triangles().size(), std::size_t{kPieces} * kCount);
  for (std::uint32_t at = 0; at < kPieces * kCount; ++at) {
    const std::uint32_t piece = at / kCount;
    const std::uint32_t n = at % kCount;
    ASSERT_EQ(mesh.vertices()[at], (Point{static_cast<float>(piece), static_cast<float>(n), 0}));
    ASSERT_EQ(mesh.triangles()[at], (std::array<std::uint32_t, 3>{piece, n, piece + n}));
  }
}

TEST(MeshInMemory, RefusesMoreVerticesThanIndicesCanName) {
  MeshInMemory mesh;
  mesh.room({.vertices = 2});
  EXPECT_THROW(mesh.room({.vertices = 0xfffffffe}), std::length_error);
  EXPECT_EQ(mesh.vertices().size(), 2U);
}

TEST(MeshInMemory, OtherSinksHaveNoRoom) {
  NoRoom sink;
  EXPECT_FALSE(sink.has_room());
  EXPECT_THROW(sink.room({.vertices = 1}), std::logic_error);
}

}  // namespace
}  // namespace isoweave::testing::write_mesh_in_memory_test
