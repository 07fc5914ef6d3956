// Every instruction set gives the bits of plain doubles.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <vector>

#include "measure/triangle_tree.hpp"
#include "simplify/kernels.hpp"

namespace isoweave::testing::simplify_kernels_test {
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
TEST_P(EachSet, BoundsASideByWhatItCrosses) {
  for (int trial = 0; trial < 300; ++trial) {
    const Vec3 to = vector();
    const double bound = std::abs(real());
    SeenSides sides;
    double most = 0;
    for (int n = 0; n < 1 + trial % 27; ++n) {
      const Vec3 from = n == 3 ? Vec3{} : vector();
      const Vec3 end = n == 5 ? to : vector();
      const double from_bound = std::abs(real());
      const double end_bound = std::abs(real());
      sides.add(from, end, from_bound, end_bound);
      const Vec3 along = end - from;
      const double turn = to.x * along.y - to.y * along.x;
      const double s = (from.x * along.y - from.y * along.x) / turn;
      const double t = (from.x * to.y - from.y * to.x) / turn;
      if (!(s > -1e-9 && s < 1 + 1e-9 && t > -1e-9 && t < 1 + 1e-9)) continue;
      const double other = from_bound + t * (end_bound - from_bound);
      const double rest = std::abs(s * to.z - (from.z + t * along.z)) + other - s * bound - kBoundRounding;
      most = std::max(most, rest / (1 - s > kLeastWeight ? 1 - s : kLeastWeight));
    }
    sides.pad();
    EXPECT_EQ(std::bit_cast<std::uint64_t>(kernels().bound_of_crossings(to, bound, sides)),
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

// Bits for a triangle over a part, by doubles one after the other.
std::uint8_t bits_over(const SeenTriangles& triangles, std::size_t t, const SeenPart& part) {
  const auto x = [&](std::size_t n) { return triangles.x[n][t]; };
  const auto y = [&](std::size_t n) { return triangles.y[n][t]; };
  // Where a line from one point to another leaves a third: above 0 to the left.
  const auto left_of = [](double ax, double ay, double bx, double by, double px, double py) {
    return (ay - by) * px + (bx - ax) * py - ((ay - by) * ax + (bx - ax) * ay);
  };
  const auto reach = [&](double ax, double ay, double bx, double by) {
    return part.slack * (std::abs(bx - ax) + std::abs(by - ay));
  };
  const auto is_beside = [&](std::size_t corner, std::size_t side) {
    return part.left_of(side, x(corner), y(corner)) <
           -part.slack * (std::abs(part.left_x[side]) + std::abs(part.left_y[side]));
  };
  unsigned bits = 0;
  std::array<bool, 3> left{};
  for (std::size_t n = 0; n < 3; ++n) {
    std::size_t a = n;
    std::size_t b = (n + 1) % 3;
    const bool turned = x(a) > x(b) || (x(a) == x(b) && y(a) > y(b));
    if (turned) std::swap(a, b);
    left[n] = (left_of(x(a), y(a), x(b), y(b), part.centre_x, part.centre_y) >= 0) != turned;
    int to_left = 0;
    int to_right = 0;
    bool parted = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = left_of(x(a), y(a), x(b), y(b), part.x[k], part.y[k]);
      if (at > reach(x(a), y(a), x(b), y(b))) ++to_left;
      if (at < -reach(x(a), y(a), x(b), y(b))) ++to_right;
      parted = parted || (is_beside(a, k) && is_beside(b, k));
    }
    if (!parted && to_left < 3 && to_right < 3) bits |= 1U << n;
  }
  if (left[0] == left[1] && left[1] == left[2]) bits |= 8;
  int above = 0;
  int below = 0;
  for (std::size_t n = 0; n < 3; ++n) {
    if (triangles.height[n][t] > part.most) ++above;
    if (triangles.height[n][t] < -part.most) ++below;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_beside(0, k) && is_beside(1, k) && is_beside(2, k)) return 0;
  }
  if (bits == 0 || above == 3 || below == 3) return 0;
  return static_cast<std::uint8_t>(bits);
}

TEST_P(EachSet, TellsHowTrianglesLieOverAPart) {
  std::array<int, 16> seen{};
  for (std::size_t trial = 0; trial < 200; ++trial) {
    const auto place = [&] { return trial % 3 == 0 ? std::round(real()) : real(); };  // rounded: much touches
    SeenTriangles triangles;
    triangles.count = 1 + trial % 41;
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t t = 0; t < triangles.count; ++t) {
        triangles.x[n][t] = place();
        triangles.y[n][t] = place();
        triangles.height[n][t] = real();
      }
    }
    triangles.pad();
    SeenPart part{};
    part.most = 1.2;
    part.slack = 1e-9;
    for (std::size_t n = 0; n < 3; ++n) {
      part.x[n] = place();
      part.y[n] = place();
    }
    part.set_sides();
    std::array<std::uint8_t, SeenTriangles::kRoom> bits{};
    kernels().lie_over(triangles, part, bits.data());
    for (std::size_t t = 0; t < triangles.count; ++t) {
      EXPECT_EQ(bits[t], bits_over(triangles, t, part)) << trial << ", triangle " << t;
      ++seen[bits[t]];
    }
  }
  EXPECT_GT(std::ranges::count_if(seen, [](int count) { return count > 0; }), 9) << "of the cases are met";
}

// How often the triangles go around a point, by angles.
int rounds_about(const SeenTriangles& triangles, double x, double y) {
  int rounds = 0;
  for (std::size_t t = 0; t < triangles.count; ++t) {
    double angle = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const double ax = triangles.x[n][t] - x;
      const double ay = triangles.y[n][t] - y;
      const double bx = triangles.x[(n + 1) % 3][t] - x;
      const double by = triangles.y[(n + 1) % 3][t] - y;
      angle += std::atan2(ax * by - ay * bx, ax * bx + ay * by);
    }
    rounds += static_cast<int>(std::lround(angle / (2 * 3.14159265358979)));
  }
  return rounds;
}

TEST_P(EachSet, CountsTrianglesOverAPoint) {
  std::array<int, 9> met{};
  for (std::size_t trial = 0; trial < 500; ++trial) {
    SeenTriangles triangles;
    triangles.count = trial % 41;
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t t = 0; t < triangles.count; ++t) {
        triangles.x[n][t] = real();
        triangles.y[n][t] = real();
      }
    }
    triangles.pad();
    const double x = real();
    const double y = real();
    const int expected = rounds_about(triangles, x, y);
    EXPECT_EQ(kernels().count_over(triangles, x, y), expected) << trial;
    ++met[static_cast<std::size_t>(std::clamp(expected + 4, 0, 8))];
  }
  EXPECT_GT(std::ranges::count_if(met, [](int count) { return count > 0; }), 6) << "of the counts are met";
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
}  // namespace isoweave::testing::simplify_kernels_test
