// The maths of one element: quadrics, keys, ids, queue.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "simplify/edge_rules.hpp"
#include "simplify/radix_heap.hpp"
#include "volume/axes.hpp"

namespace isoweave::testing::simplify_rules_test {
namespace {

// weight * (distance to the plane through `point`)^2
Quadric plane(Vec3 normal, Vec3 point, double weight) {
  return moved(plane_quadric(normal, weight / dot(normal, normal)), -point);
}

TEST(Quadric, IsTheWeightedSquaredDistanceToThePlane) {
  const Quadric q = plane({0, 0, 5}, {7, 8, 2}, 3);
  EXPECT_DOUBLE_EQ(evaluate(q, {100, -50, 6}), 3 * 16);
  EXPECT_DOUBLE_EQ(evaluate(q, {1, 1, 2}), 0);
}

TEST(Quadric, MovedOriginMeasuresTheSame) {
  const Quadric q = plane({1, 2, 3}, {0.5, 0.25, 4}, 2) + plane({-1, 0.5, 1}, {2, 1, 0}, 0.7);
  const Vec3 d{3, -2, 0.5};
  const Vec3 x{0.1, 0.7, -4};
  EXPECT_NEAR(evaluate(moved(q, d), x - d), evaluate(q, x), 1e-9);
}

TEST(Quadric, MinimiserFindsTheCornerOfThreePlanes) {
  const Quadric q = plane({1, 0, 0}, {1, 0, 0}, 1) + plane({0, 1, 0}, {0, 2, 0}, 1) + plane({0, 0, 1}, {0, 0, 3}, 1);
  const Vec3 x = minimiser(q, factorise(q), {});
  EXPECT_NEAR(x.x, 1, 1e-3);
  EXPECT_NEAR(x.y, 2, 1e-3);
  EXPECT_NEAR(x.z, 3, 1e-3);
}

// Where the quadric is flat, the minimiser is where the pull draws it: the midpoint of the edge.
TEST(Quadric, FlatDirectionsFollowThePull) {
  const Quadric q = plane({0, 0, 1}, {0, 0, 2}, 1);
  const Vec3 x = minimiser(q, factorise(q), {3, -1, 5});
  EXPECT_NEAR(x.x, 3, 1e-9);
  EXPECT_NEAR(x.y, -1, 1e-9);
  EXPECT_NEAR(x.z, 2, 1e-3);
  EXPECT_EQ(solve(factorise(Quadric{}), Vec3{}).x, 0);
}

TEST(Cost, OrdersAsFloatsAndHasAFloor) {
  EXPECT_LT(to_cost(1e-30), to_cost(1e-3));
  EXPECT_EQ(to_cost(-1), cost_bits(kCostFloor));
  EXPECT_EQ(to_cost(0), cost_bits(kCostFloor));
  EXPECT_EQ(to_cost(1e300), kRetiredCost);
  EXPECT_GT(to_cost(std::nan("")), kRetiredCost);
  EXPECT_GT(postponed_cost(to_cost(0)), to_cost(0));
  EXPECT_EQ(cost_value(postponed_cost(to_cost(1))), 16);
  EXPECT_EQ(cost_value(postponed_cost(to_cost(0))), kPostponeFloor);
}

// All pairs of lattice edges that one cell can join, in a small lattice where every digit is at its tightest.
TEST(SideTest, RefusesTurnedAndEmptyFacesOnly) {
  const Vec3 b{1, 0, 0}, c{0, 1, 0};
  const auto normal = [&](Vec3 a, Vec3 d) { return cross(b - a, d - a); };
  const Vec3 before = normal({0, 0, 0}, c);
  EXPECT_TRUE(keeps_side(before, normal({-0.5, -0.5, 0.1}, c)));
  EXPECT_FALSE(keeps_side(before, normal({1, 1, 0}, c)));                               // turned over
  EXPECT_FALSE(keeps_side(before, normal({0.5, 0.5, 0}, c)));                           // no area left
  EXPECT_FALSE(keeps_side(before, normal({0.5, 0.5, 5}, c)));                           // upright
  EXPECT_TRUE(keeps_side(normal({2, 0, 0}, {3, 0, 0}), normal({1, 1, 0}, {3, 0, 0})));  // had no area: imposes nothing
}

TEST(RadixHeap, GivesGroupsInOrder) {
  std::mt19937 random(3);
  RadixHeap heap;
  std::multiset<std::uint32_t> expected;
  const auto push = [&](std::uint32_t cost) {
    heap.push(cost, cost + 1);
    expected.insert(cost);
  };
  for (int n = 0; n < 2000; ++n) push(static_cast<std::uint32_t>(random() % 5000));
  std::vector<RadixHeap::Entry> group;
  std::uint32_t last = 0;
  while (heap.pop_group(group)) {
    ASSERT_FALSE(group.empty());
    const std::uint32_t cost = group.front().cost;
    ASSERT_GE(cost, last);
    ASSERT_EQ(cost, *expected.begin());
    ASSERT_EQ(group.size(), expected.count(cost));
    for (const auto entry : group) ASSERT_EQ(entry.cost, cost);
    expected.erase(cost);
    last = cost;
    if (random() % 3 == 0 && cost < 100000)
      push(cost + 1 + static_cast<std::uint32_t>(random() % (1u << random() % 20)));
  }
  EXPECT_TRUE(expected.empty());
}

TEST(CubeRoot, IsTheCubeRoot) {
  for (const double x : {1.0, 8.0, 27.0, 1e-30, 1.3738, 3e20, 0.5}) EXPECT_NEAR(cube_root(x) / std::cbrt(x), 1, 1e-15);
}

}  // namespace
}  // namespace isoweave::testing::simplify_rules_test
