// Every instruction set gives the bits of plain doubles.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "measure/triangle_tree.hpp"
#include "simplify/kernels.hpp"

namespace isoweave {
namespace {

class EachSet : public ::testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    if (GetParam() >= all_kernels().size()) GTEST_SKIP() << "this processor has no more instruction sets";
  }

  const Kernels& kernels() const { return *all_kernels()[GetParam()]; }

  double real() { return std::uniform_real_distribution<double>(-2, 2)(random_); }
  Vec3 vector() { return {real(), real(), real()}; }

  Vertex vertex() {
    Vertex v;
    v.position = vector();
    v.quadric = moved(plane_quadric(vector(), std::abs(real())) + plane_quadric(vector(), 0.5), vector());
    return v;
  }

  // The star of vertex 0 among the others, padded as the kernels want it.
  std::vector<Index> ring(std::size_t count, bool open) {
    std::vector<Index> neighbours(count + Star::kPadding);
    for (std::size_t n = 0; n < count; ++n) neighbours[n] = static_cast<Index>(n + 1);
    for (std::size_t n = count; n < neighbours.size(); ++n) neighbours[n] = open ? static_cast<Index>(count) : 1;
    return neighbours;
  }

  std::mt19937 random_{7};
};

INSTANTIATE_TEST_SUITE_P(InstructionSets, EachSet, ::testing::Values(0, 1, 2),
                         [](const auto& set) { return std::to_string(set.param); });

TEST(Kernels, TheBestSetIsTheOneInUse) { EXPECT_EQ(&kernels(), all_kernels().back()); }

TEST_P(EachSet, EdgeCostsAreThoseOfOneEdge) {
  for (std::size_t count = 0; count <= 19; ++count) {
    std::vector<Vertex> ends;
    for (std::size_t n = 0; n < 2 * count; ++n) ends.push_back(vertex());
    std::vector<EdgeEnds> edges;
    for (std::size_t n = 0; n < count; ++n) edges.push_back({&ends[2 * n], &ends[2 * n + 1]});
    std::vector<CostBits> costs(count + 1, 17);
    kernels().edge_costs(edges, costs.data());
    for (std::size_t n = 0; n < count; ++n) {
      const Vec3 edge = edges[n].second->position - edges[n].first->position;
      EXPECT_EQ(costs[n], to_cost(collapse_cost(edges[n].first->quadric, edges[n].second->quadric, edge)));
    }
    EXPECT_EQ(costs[count], 17u) << "written past the end";
  }
}

TEST_P(EachSet, FacesAreSummedInTheOrderOfTheirSlots) {
  for (const bool open : {false, true}) {
    for (std::size_t count = 2; count <= 29; ++count) {
      std::vector<Vertex> vertices;
      for (std::size_t n = 0; n <= count; ++n) vertices.push_back(vertex());
      if (count > 4) vertices[3].position = vertices[2].position;  // a face without area
      Fan fan;
      kernels().measure(vertices.data(), vertices[0].position, ring(count, open).data(), count, fan);
      const FaceSums sums = kernels().sum_faces(fan, count, 0.3);
      Quadric planes;
      Vec3 normals;
      for (std::size_t n = 0; n < (open ? count - 1 : count); ++n) {
        const Vec3 normal = cross(vertices[1 + n].position - vertices[0].position,
                                  vertices[1 + (n + 1) % count].position - vertices[0].position);
        const double size = std::sqrt(dot(normal, normal));
        if (size > 0) planes = planes + plane_quadric(normal, 0.3 / size);
        normals = normals + normal;
      }
      const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
      EXPECT_EQ(bits(sums.planes.xx), bits(planes.xx)) << count;
      EXPECT_EQ(bits(sums.planes.xy), bits(planes.xy));
      EXPECT_EQ(bits(sums.planes.xz), bits(planes.xz));
      EXPECT_EQ(bits(sums.planes.yy), bits(planes.yy));
      EXPECT_EQ(bits(sums.planes.yz), bits(planes.yz));
      EXPECT_EQ(bits(sums.planes.zz), bits(planes.zz));
      EXPECT_EQ(bits(sums.normal.x), bits(normals.x));
      EXPECT_EQ(bits(sums.normal.y), bits(normals.y));
      EXPECT_EQ(bits(sums.normal.z), bits(normals.z));
    }
  }
}

TEST_P(EachSet, OneTurnedFaceIsSeenWhereverItIs) {
  for (std::size_t count = 3; count <= 28; ++count) {
    std::vector<Vertex> vertices(count + 1);
    for (std::size_t n = 0; n < count; ++n) {
      const double angle = 2 * 3.14159265358979 * static_cast<double>(n) / static_cast<double>(count);
      vertices[n + 1].position = {std::cos(angle), std::sin(angle), 0};
    }
    Fan fan;
    kernels().measure(vertices.data(), vertices[0].position, ring(count, false).data(), count, fan);
    EXPECT_TRUE(kernels().keeps_sides(fan, count, {0.01, 0.02, 0}));
    for (std::size_t n = 0; n < count; ++n) {
      // Past the middle of the outer edge only the face at that edge turns over.
      const Vec3 beyond = 0.51 * (vertices[n + 1].position + vertices[1 + (n + 1) % count].position);
      EXPECT_FALSE(kernels().keeps_sides(fan, count, beyond)) << n << " of " << count;
      Fan without = fan;
      without.drop(n);
      EXPECT_TRUE(kernels().keeps_sides(without, count, beyond)) << n << " of " << count;
    }
  }
}

// Against doubles one after the other: the bits are those of the rules.
TEST_P(EachSet, FindsTheHighestCrossing) {
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 to = vector();
    SeenSides sides;
    double most = 0;
    for (int n = 0; n < 1 + trial % 27; ++n) {
      const Vec3 from = n == 3 ? Vec3{} : vector();
      const Vec3 end = n == 5 ? to : vector();
      const double bound = std::abs(real());
      sides.add(from, end, bound);
      const Vec3 along = end - from;
      const double turn = to.x * along.y - to.y * along.x;
      const double s = (from.x * along.y - from.y * along.x) / turn;
      const double t = (from.x * to.y - from.y * to.x) / turn;
      if (!(s > -1e-9 && s < 1 + 1e-9 && t > -1e-9 && t < 1 + 1e-9)) continue;
      most = std::max(most, std::abs(s * to.z - (from.z + t * along.z)) + bound);
    }
    sides.pad();
    EXPECT_EQ(std::bit_cast<std::uint64_t>(kernels().height_of_crossings(to, sides)),
              std::bit_cast<std::uint64_t>(most));
  }
}

TEST_P(EachSet, FindsThePointsNearATriangle) {
  int near = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Vec3 corners[3] = {vector(), vector(), vector()};
    if (trial % 50 == 0) corners[2] = 0.5 * (corners[0] + corners[1]);
    if (trial % 50 == 1) corners[2] = corners[1] = corners[0];
    FourPoints points;
    unsigned expected = 0;
    for (std::size_t n = 0; n < 4; ++n) {
      const Vec3 p = vector();
      points.x[n] = p.x;
      points.y[n] = p.y;
      points.z[n] = p.z;
      const auto vector_at = [](const Vec3& v) { return measure::Vector{v.x, v.y, v.z}; };
      const double squared = measure::squared_distance(
          vector_at(p), {vector_at(corners[0]), vector_at(corners[1]), vector_at(corners[2])});
      if (squared <= 0.49) expected |= 1U << n;
    }
    EXPECT_EQ(kernels().points_within(0.49, points, {&corners[0], &corners[1], &corners[2]}), expected) << trial;
    near += static_cast<int>(std::popcount(expected));
  }
  EXPECT_GT(near, 500);
}

TEST_P(EachSet, CountsCommonNumbers) {
  std::vector<Index> b;
  for (Index n = 0; n < 29; ++n) b.push_back(100 + n);
  b.resize(48, kNone);
  EXPECT_EQ(kernels().count_common(std::vector<Index>{1, 2, 3}, b.data(), 29), 0);
  EXPECT_EQ(kernels().count_common(std::vector<Index>{100, 2, 128, 115, 116}, b.data(), 29), 4);
  EXPECT_EQ(kernels().count_common(std::vector<Index>{}, b.data(), 29), 0);
}

}  // namespace
}  // namespace isoweave
