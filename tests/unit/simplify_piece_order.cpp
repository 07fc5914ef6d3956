// The order in which the zone holds a piece.
// Threads: PieceOrders.*
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "simplify/columns.hpp"
#include "simplify/piece_order.hpp"

namespace isoweave::testing::simplify_piece_order_test {
namespace {

constexpr double kFace = 4;    // voxels of 2 x 2 x 2
constexpr double kWidth = 48;  // of a column

TEST(Columns, AreAsWideAsAFewVoxels) {
  const Columns column(kFace);
  EXPECT_EQ(column({1, 1, 0}), column({kWidth - 1, kWidth - 1, 1e9}));
  EXPECT_NE(column({1, 1, 0}), column({kWidth + 1, 1, 0}));
  EXPECT_NE(column({1, 1, 0}), column({1, kWidth + 1, 0}));
  EXPECT_NE(column({kWidth + 1, 1, 0}), column({1, kWidth + 1, 0}));
  EXPECT_NE(column({1, 1, 0}), column({-1, 1, 0}));
  EXPECT_EQ(column({1, 1, 0}), column({1 + Columns::kAlong * kWidth, 1 - Columns::kAlong * kWidth, 0}));
}

TEST(Columns, HaveANumberAnywhere) {
  const Columns column(kFace);
  const double far[] = {1e18, 1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()};
  for (const double p : far) {
    EXPECT_LT(column({p, 0, 0}), Columns::kCount);
    EXPECT_LT(column({0, -p, 0}), Columns::kCount);
    EXPECT_LT(column({-p, p, p}), Columns::kCount);
  }
}

class PieceOrders : public ::testing::Test {
 protected:
  // Points anywhere in some columns, and triangles between any of them.
  PieceOrders() {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-3 * kWidth, 5 * kWidth);
    const auto point = [&] { return Vec3{place(random), place(random), place(random)}; };
    for (Vertex& vertex : held_) vertex.position = point();
    zone_.vertices = held_;
    zone_.options.a0 = kFace;
    piece_.inherited = static_cast<std::uint32_t>(front_.size());
    piece_.positions.resize(20000);
    for (Vec3& position : piece_.positions) position = point();
    piece_.triangles.resize(40000);
    std::uniform_int_distribution<std::uint32_t> corner(0, vertices() - 1);
    for (auto& triangle : piece_.triangles) triangle = {corner(random), corner(random), corner(random)};
  }

  std::uint32_t vertices() const { return piece_.inherited + static_cast<std::uint32_t>(piece_.positions.size()); }

  // Of a vertex by its number in the piece.
  std::uint32_t column(std::uint32_t n) const {
    const Columns column(kFace);
    return column(n < piece_.inherited ? held_[front_[n]].position : piece_.positions[n - piece_.inherited]);
  }

  void sort(int threads) { order_.sort(piece_, zone_, front_, Executor(threads)); }

  std::vector<Vertex> held_{std::vector<Vertex>(9)};
  const std::vector<Index> front_{7, 2, 5};
  ZoneView zone_;
  SurfacePiece piece_;
  PieceOrder order_;
};

TEST_F(PieceOrders, GroupVerticesByColumns) {
  sort(3);
  for (std::uint32_t n = 0; n < piece_.inherited; ++n) EXPECT_EQ(order_.number(n), n);
  std::uint32_t in_order = 0;
  for (std::uint32_t n = 0; n < piece_.positions.size(); ++n) {
    const std::uint32_t place = order_.place_of_vertex(n);
    ASSERT_LT(place, piece_.positions.size());
    ASSERT_EQ(order_.number(piece_.inherited + place), piece_.inherited + n);
    if (n == 0) continue;
    const std::uint32_t before = order_.place_of_vertex(n - 1);
    const std::uint32_t columns[] = {column(piece_.inherited + before), column(piece_.inherited + place)};
    in_order += columns[0] < columns[1] || (columns[0] == columns[1] && before < place);
  }
  EXPECT_EQ(in_order, piece_.positions.size() - 1);
}

TEST_F(PieceOrders, GroupTrianglesByColumnsOfTheirFirstCorners) {
  sort(3);
  ASSERT_EQ(order_.triangles().size(), piece_.triangles.size());
  std::vector<std::array<std::uint32_t, 3>> expected(piece_.triangles.begin(), piece_.triangles.end());
  std::ranges::stable_sort(expected, {}, [&](const auto& triangle) { return column(triangle[0]); });
  for (std::size_t n = 0; n < expected.size(); ++n) {
    for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(order_.triangles()[n][c], order_.number(expected[n][c]));
  }
}

TEST_F(PieceOrders, AreTheSameForAnyThreads) {
  sort(1);
  const std::vector<std::array<std::uint32_t, 3>> alone(order_.triangles().begin(), order_.triangles().end());
  sort(4);
  EXPECT_TRUE(std::equal(alone.begin(), alone.end(), order_.triangles().begin(), order_.triangles().end()));
}

TEST_F(PieceOrders, OfNothing) {
  piece_.clear();
  order_.sort(piece_, zone_, {}, Executor(2));
  EXPECT_TRUE(order_.triangles().empty());
}

}  // namespace
}  // namespace isoweave::testing::simplify_piece_order_test
