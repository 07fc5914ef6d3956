// Whether triangles stay within a distance of the extracted surface, against distances computed point by point.
#include <gtest/gtest.h>

#include <random>

#include "measure/triangle_tree.hpp"
#include "sanitized.hpp"
#include "simplify/extracted_surface.hpp"

namespace isoweave::testing::simplify_extracted_surface_test {
namespace {

using Corners = ExtractedSurface::Corners;
using measure::operator+;
using measure::operator*;
using measure::Vector;

constexpr double kAll = std::numeric_limits<double>::infinity();

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector point(double low, double high) { return {number(low, high), number(low, high), number(low, high)}; }

 private:
  std::mt19937 engine_;
};

void append(ExtractedSurface& surface, std::span<const Corners> triangles, double complete_below) {
  Array<Vec3> positions;
  positions.resize(3 * triangles.size());
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (const Corners& triangle : triangles) {
    const auto first = static_cast<std::uint32_t>(3 * corners.size());
    for (std::uint32_t c = 0; c < 3; ++c) positions[first + c] = {triangle[c][0], triangle[c][1], triangle[c][2]};
    corners.push_back({first, first + 1, first + 2});
  }
  surface.append(std::move(positions), corners, complete_below);
}

// A rough sheet over [0, 6] x [0, 6], with some degenerate triangles and a large one.
std::vector<Corners> sheet(unsigned seed) {
  Random random(seed);
  std::vector<std::vector<double>> height(13, std::vector<double>(13));
  for (auto& row : height) {
    for (double& z : row) z = random.number(2.5, 3.5);
  }
  const auto at = [&](std::size_t i, std::size_t j) {
    return Vector{0.5 * static_cast<double>(i), 0.5 * static_cast<double>(j), height[i][j]};
  };
  std::vector<Corners> triangles;
  for (std::size_t i = 0; i < 12; ++i) {
    for (std::size_t j = 0; j < 12; ++j) {
      triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  triangles.push_back({Vector{1, 1, 5}, Vector{2, 2, 5}, Vector{3, 3, 5}});
  triangles.push_back({Vector{4, 4, 5}, Vector{4, 4, 5}, Vector{4, 4, 5}});
  triangles.push_back({Vector{-20, -20, 1}, Vector{40, -20, 1}, Vector{-20, 40, 1}});
  return triangles;
}

// Lengths of a box that none of the triangles exceeds.
Vec3 largest_of(const std::vector<Corners>& triangles) {
  Vector largest{};
  for (const Corners& t : triangles) {
    for (std::size_t n = 0; n < 3; ++n) {
      const auto [low, high] = std::minmax({t[0][n], t[1][n], t[2][n]});
      largest[n] = std::max(largest[n], high - low);
    }
  }
  return {largest[0], largest[1], largest[2]};
}

double distance_to(const std::vector<Corners>& surface, const Vector& p) {
  double least = kAll;
  for (const Corners& triangle : surface) least = std::min(least, measure::squared_distance(p, triangle));
  return std::sqrt(least);
}

// The largest distance over points of a triangle.
double farthest(const std::vector<Corners>& surface, const Corners& t) {
  constexpr int kSteps = 24;
  double most = 0;
  for (int u = 0; u <= kSteps; ++u) {
    for (int v = 0; v + u <= kSteps; ++v) {
      const double a = static_cast<double>(u) / kSteps;
      const double b = static_cast<double>(v) / kSteps;
      most = std::max(most, distance_to(surface, a * t[0] + b * t[1] + (1 - a - b) * t[2]));
    }
  }
  return most;
}

Vec3 vec(const Vector& p) { return {p[0], p[1], p[2]}; }

Reach reach(const ExtractedSurface& surface, const Corners& t, double most) {
  return surface.reach(vec(t[0]), vec(t[1]), vec(t[2]), most);
}

// The answer for a triangle, and how far it is at most where it is within the distance, in one piece and in many: it
// must not depend on the pieces, nor on their order.
class AnyPieces {
 public:
  AnyPieces(const std::vector<Corners>& triangles, double most, const Vec3& cell)
      : most_(most), whole_(most, cell, largest_of(triangles)), pieces_(most, cell, largest_of(triangles)) {
    append(whole_, triangles, kAll);
    for (std::size_t n = triangles.size(); n > 0; --n) append(pieces_, std::span(&triangles[n - 1], 1), kAll);
  }

  Reach reach(const Corners& t, double& farthest) const {
    ExtractedSurface::Looked one, many;
    const Reach found = whole_.reach(vec(t[0]), vec(t[1]), vec(t[2]), most_, &one);
    EXPECT_EQ(pieces_.reach(vec(t[0]), vec(t[1]), vec(t[2]), most_, &many), found);
    if (found == Reach::kWithin) {
      EXPECT_EQ(one.farthest, many.farthest);
    }
    farthest = one.farthest;
    return found;
  }

 private:
  double most_;
  ExtractedSurface whole_, pieces_;
};

Corners random_triangle(Random& random) {
  const Vector first = random.point(1, 5);
  const double size = random.number(0.05, 2.5);
  return {first, first + random.point(-size, size), first + random.point(-size, size)};
}

TEST(ExtractedSurface, SaysWhatDistancesSay) {
  for (const double most : {0.1, 0.4, 1.0}) {
    if (testing::kSanitized && most != 0.4) continue;
    const std::vector<Corners> triangles = sheet(1);
    const AnyPieces surface(triangles, most, {0.5, 0.5, 0.7});
    Random random(2);
    int within = 0;
    int bounded = 0;
    int beyond = 0;
    for (int trial = 0; trial < 400; ++trial) {
      const Corners triangle = random_triangle(random);
      const double distance = farthest(triangles, triangle);
      double known = 0;
      const Reach found = surface.reach(triangle, known);
      ASSERT_NE(found, Reach::kUnknown);
      if (found == Reach::kWithin) {
        ++within;
        bounded += static_cast<int>(known < most);
        EXPECT_LE(known, most);
        EXPECT_LE(distance, known * (1 + 1e-9)) << "trial " << trial << ", within " << most;
      } else {
        ++beyond;
        // The points tried are less than a 24th of a side apart.
        EXPECT_GT(distance, most * 15 / 16 - 0.15) << "trial " << trial << ", within " << most;
      }
    }
    EXPECT_GT(bounded, 0);
    EXPECT_GT(within, bounded);
    EXPECT_GT(beyond, 0);
  }
}

// Flat surfaces at a distance that is known.
TEST(ExtractedSurface, IsExactToASixteenth) {
  std::vector<Corners> plane;
  for (int i = -5; i < 15; ++i) {
    for (int j = -5; j < 15; ++j) {
      const double x = i;
      const double y = j;
      plane.push_back({Vector{x, y, 0}, Vector{x + 1, y, 0}, Vector{x, y + 1, 0}});
      plane.push_back({Vector{x + 1, y, 0}, Vector{x + 1, y + 1, 0}, Vector{x, y + 1, 0}});
    }
  }
  ExtractedSurface surface(1, {1, 1, 1}, {1, 1, 0});
  append(surface, plane, kAll);
  const auto at = [&](double z) {
    return reach(surface, {Vector{0.2, 0.3, z}, Vector{7.1, 0.4, z}, Vector{3, 8, z}}, 1);
  };
  EXPECT_EQ(at(0), Reach::kWithin);
  EXPECT_EQ(at(0.93), Reach::kWithin);
  EXPECT_EQ(at(-0.93), Reach::kWithin);
  EXPECT_EQ(at(1.0001), Reach::kBeyond);
  EXPECT_EQ(at(-1.0001), Reach::kBeyond);
}

// Wide faces over a gentle sheet: the surface is seen along their normals, in one piece and in many.
TEST(ExtractedSurface, SaysOfWideFacesWhatDistancesSay) {
  std::vector<Corners> triangles = sheet(11);
  triangles.resize(triangles.size() - 3);
  for (Corners& t : triangles) {
    for (Vector& p : t) p[2] = 0.1 * p[2];
  }
  constexpr double kMost = 0.06;
  const AnyPieces surface(triangles, kMost, {0.5, 0.5, 0.1});
  Random random(12);
  int within = 0;
  int beyond = 0;
  for (int trial = 0; trial < (testing::kSanitized ? 40 : 400); ++trial) {
    const auto corner = [&] {
      return Vector{random.number(0.2, 5.8), random.number(0.2, 5.8), random.number(0.28, 0.32)};
    };
    const Corners face{corner(), corner(), corner()};
    double known = 0;
    const Reach found = surface.reach(face, known);
    const double distance = farthest(triangles, face);
    if (found == Reach::kWithin) {
      ++within;
      EXPECT_LE(distance, known * (1 + 1e-9)) << trial;
    } else {
      ++beyond;
      EXPECT_GT(distance, kMost * 15 / 16 - 0.02) << trial;
    }
  }
  EXPECT_GT(within, 0);
  EXPECT_GT(beyond, 0);
}

// A face over 40,000 triangles of a flat: cut into the parts over each of them it would be refused.
TEST(ExtractedSurface, FindsThatTheWidestFacesAreNear) {
  std::vector<Corners> flat;
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) {
      const double x = i;
      const double y = j;
      flat.push_back({Vector{x, y, 0}, Vector{x + 1, y, 0}, Vector{x, y + 1, 0}});
      flat.push_back({Vector{x + 1, y, 0}, Vector{x + 1, y + 1, 0}, Vector{x, y + 1, 0}});
    }
  }
  constexpr double kMost = 0.2;
  ExtractedSurface surface(kMost, {1.3, 1.3, 1}, {1, 1, 0});
  append(surface, flat, kAll);
  ExtractedSurface::Looked looked;
  const auto at = [&](double z) {
    return surface.reach({1.2, 1.3, z}, {198.1, 3.4, z}, {90.1, 197.2, z}, kMost, &looked);
  };
  for (const double z : {0.0, 0.9 * kMost}) {
    EXPECT_EQ(at(z), Reach::kWithin);
    EXPECT_EQ(looked.comparisons, 0) << "the surface is seen above all of the face";
    EXPECT_DOUBLE_EQ(looked.farthest, std::max(z, kMost / 2)) << "what is nearer is not told apart";
  }
  EXPECT_EQ(at(-1.01 * kMost), Reach::kBeyond);
}

// Triangles far from a face, in cells that the face touches: how often the face is cut does not depend on the pieces
// that they come in.
TEST(ExtractedSurface, CutsAFaceAsOftenWhateverElseAPieceHolds) {
  std::vector<Corners> flat;
  std::vector<Corners> far;
  for (int n = 0; n < 64; ++n) {
    const double x = n % 8;
    const double y = n / 8;
    for (int layer = 0; layer <= 60; ++layer) {  // too many for any part that is worth seeing
      const double z = layer > 0 ? 5 + 0.1 * layer : 0;
      std::vector<Corners>& list = layer > 0 ? far : flat;
      list.push_back({Vector{x, y, z}, Vector{x + 1, y, z}, Vector{x, y + 1, z}});
      list.push_back({Vector{x + 1, y, z}, Vector{x + 1, y + 1, z}, Vector{x, y + 1, z}});
    }
  }
  const auto looks_of = [&](std::span<const std::vector<Corners>> pieces) {
    ExtractedSurface surface(0.2, {2, 2, 20}, {1, 1, 0});
    for (const std::vector<Corners>& piece : pieces) append(surface, piece, kAll);
    ExtractedSurface::Looked looked;
    EXPECT_EQ(surface.reach({0.5, 0.5, 0.1}, {7.5, 0.6, 0.1}, {0.6, 7.5, 0.1}, 0.2, &looked), Reach::kWithin);
    return looked.comparisons;
  };
  const std::vector<std::vector<Corners>> two{flat, far};
  std::vector<std::vector<Corners>> one{flat};
  one[0].insert(one[0].end(), far.begin(), far.end());
  EXPECT_EQ(looks_of(two), 0);
  EXPECT_EQ(looks_of(one), 0);
}

// What is known of a part of the surface holds for all of it.
TEST(ExtractedSurface, NeverTakesAnAnswerBack) {
  std::vector<Corners> triangles = sheet(3);
  for (Corners& t : triangles) {
    for (Vector& p : t) std::swap(p[1], p[2]);  // upright
  }
  std::sort(triangles.begin(), triangles.end(), [](const Corners& a, const Corners& b) {
    return a[0][2] + a[1][2] + a[2][2] < b[0][2] + b[1][2] + b[2][2];
  });
  for (const double most : {0.2, 0.8}) {
    ExtractedSurface whole(most, {0.5, 0.5, 0.5}, largest_of(triangles));
    append(whole, triangles, kAll);
    ExtractedSurface pieces(most, {0.5, 0.5, 0.5}, largest_of(triangles));
    int unknown = 0;
    for (std::size_t begin = 0; begin < triangles.size(); begin += 40) {
      const std::size_t end = std::min(begin + 40, triangles.size());
      double next = kAll;
      for (std::size_t n = end; n < triangles.size(); ++n) {
        for (const Vector& p : triangles[n]) next = std::min(next, p[2]);
      }
      append(pieces, std::span(triangles).subspan(begin, end - begin), next);
      Random random(4);
      for (int trial = 0; trial < 300; ++trial) {
        const Corners triangle = random_triangle(random);
        const Reach found = reach(pieces, triangle, most);
        if (found == Reach::kUnknown) {
          ++unknown;
        } else {
          EXPECT_EQ(found, reach(whole, triangle, most)) << trial;
        }
      }
    }
    EXPECT_GT(unknown, 0);
  }
}

// Triangles of very different sizes, needles above all, are found in the grid that fits each of them.
TEST(ExtractedSurface, SaysWhatDistancesSayAmongNeedles) {
  Random random(8);
  std::vector<Corners> needles = sheet(5);
  for (int n = 0; n < 300; ++n) {
    const Vector from = random.point(0, 6);
    const double length = std::exp(random.number(-2, 7));
    const Vector along = random.point(-length, length);
    needles.push_back({from, from + along, from + along + random.point(-0.01, 0.01)});
  }
  constexpr double kMost = 0.3;
  ExtractedSurface surface(kMost, {0.2, 0.4, 0.3}, largest_of(needles));
  append(surface, needles, kAll);
  int within = 0;
  for (int trial = 0; trial < (testing::kSanitized ? 40 : 400); ++trial) {
    const Corners triangle = random_triangle(random);
    const double distance = farthest(needles, triangle);
    if (reach(surface, triangle, kMost) == Reach::kWithin) {
      ++within;
      EXPECT_LE(distance, kMost * (1 + 1e-9)) << "trial " << trial;
    } else {
      EXPECT_GT(distance, kMost * 15 / 16 - 0.15) << "trial " << trial;
    }
  }
  EXPECT_GT(within, testing::kSanitized ? 0 : 10);
  const Corners& longest = *std::ranges::max_element(needles, {}, [](const Corners& t) {
    const Vector side = t[1] + -1.0 * t[0];
    return measure::dot(side, side);
  });
  EXPECT_EQ(reach(surface, longest, kMost), Reach::kWithin) << "a triangle is near itself";
}

// Sheets above each other in one cell, which come in one piece and in many: with few that are near the nearest counts,
// with many none does, in whatever order they are met.
TEST(ExtractedSurface, TheNearestOfFewCounts) {
  for (const int sheets : {1, 2, 4, 5, 12}) {
    std::vector<Corners> triangles;
    for (int n = 1; n <= sheets; ++n) {
      const double z = 0.01 * n;
      triangles.push_back({Vector{0.1, 0.1, z}, Vector{0.9, 0.1, z}, Vector{0.1, 0.9, z}});
    }
    const AnyPieces surface(triangles, 0.2, {1, 1, 1});
    double known = 0;
    EXPECT_EQ(surface.reach({Vector{0.2, 0.2, 0}, Vector{0.5, 0.2, 0}, Vector{0.2, 0.5, 0}}, known), Reach::kWithin);
    EXPECT_DOUBLE_EQ(known, sheets <= 4 ? 0.01 : 0.2) << sheets;
  }
}

// A strip of 4,000 needles side by side, 100 long and 0.02 wide, that lies oblique to all axes; `turn`: of the strip in
// its plane, `lift`: above it.
std::vector<Corners> strip(double turn, double lift) {
  constexpr int kNeedles = 4000;
  const Vector across{2.0 / 3, -2.0 / 3, 1.0 / 3};
  const Vector along{1.0 / 3, 2.0 / 3, 2.0 / 3};
  const Vector up{2.0 / 3, 1.0 / 3, -2.0 / 3};
  const auto at = [&](double u, double v) {
    const double x = std::cos(turn) * (u - 50) - std::sin(turn) * v;
    const double y = std::sin(turn) * (u - 50) + std::cos(turn) * v;
    return x * along + y * across + lift * up;
  };
  std::vector<Corners> needles;
  for (int n = 0; n < kNeedles; n += 2) {
    const double v = 0.01 * (n - kNeedles / 2);
    needles.push_back({at(0, v), at(100, v), at(0, v + 0.02)});
    needles.push_back({at(100, v), at(100, v + 0.02), at(0, v + 0.02)});
  }
  return needles;
}

// Triangles that a face between a needle and the next but one is compared with, on average.
double looks_per_face(const std::vector<Corners>& needles, double most) {
  ExtractedSurface surface(most, {2, 2, 2}, largest_of(needles));
  append(surface, needles, kAll);
  std::uint64_t looks = 0;
  int faces = 0;
  for (std::size_t n = 0; n + 2 < needles.size(); n += 16, ++faces) {
    const Corners& from = needles[n];
    ExtractedSurface::Looked looked;
    EXPECT_EQ(surface.reach(vec(from[0]), vec(from[1]), vec(needles[n + 2][2]), most, &looked), Reach::kWithin);
    looks += looked.comparisons;
  }
  return static_cast<double>(looks) / faces;
}

// The boxes around needles that are oblique overlap nearly all others; few of them come near each other, though.
TEST(ExtractedSurface, ComparesFacesWithFewOfManyNeedles) {
  std::vector<Corners> crossing;
  for (int n = 0; n < 6; ++n) {
    const std::vector<Corners> next = strip(0.5 * n, 3.0 * n);
    crossing.insert(crossing.end(), next.begin(), next.end());
  }
  for (const double most : {0.2, 2.0}) {
    EXPECT_LT(looks_per_face(strip(0, 0), most), 20) << most;
    EXPECT_LT(looks_per_face(crossing, most), 20) << most;
  }
}

// Each triangle as a piece of its own, in any order.
TEST(ExtractedSurface, PiecesMayOverlap) {
  const std::vector<Corners> triangles = sheet(9);
  ExtractedSurface whole(0.4, {0.5, 0.5, 0.5}, largest_of(triangles));
  append(whole, triangles, kAll);
  ExtractedSurface pieces(0.4, {0.5, 0.5, 0.5}, largest_of(triangles));
  for (std::size_t n = triangles.size(); n > 0; --n) append(pieces, std::span(triangles).subspan(n - 1, 1), kAll);
  Random random(10);
  for (int trial = 0; trial < 300; ++trial) {
    const Corners triangle = random_triangle(random);
    EXPECT_EQ(reach(pieces, triangle, 0.4), reach(whole, triangle, 0.4)) << trial;
  }
}

TEST(ExtractedSurface, ForgetsOnlyWhatNobodyAsksAbout) {
  constexpr double kMost = 0.3;
  ExtractedSurface all(kMost, {0.5, 0.5, 0.5}, {0.5, 0.5, 1});
  ExtractedSurface recent(kMost, {0.5, 0.5, 0.5}, {0.5, 0.5, 1});
  for (int k = 0; k < 20; ++k) {
    std::vector<Corners> layer = sheet(static_cast<unsigned>(k));
    layer.resize(layer.size() - 3);
    for (Corners& t : layer) {
      for (Vector& p : t) p[2] += k - 2.5;
    }
    append(all, layer, k + 1);
    append(recent, layer, k + 1);
  }
  const std::uint64_t before = recent.bytes();
  recent.forget_below(10);
  EXPECT_LT(recent.bytes(), before * 3 / 4);
  Random random(6);
  for (int trial = 0; trial < 300; ++trial) {
    Corners triangle = random_triangle(random);
    double low = kAll;
    for (const Vector& p : triangle) low = std::min(low, p[2]);
    for (Vector& p : triangle) p[2] += 10 - low;
    EXPECT_EQ(reach(recent, triangle, kMost), reach(all, triangle, kMost));
  }
}

}  // namespace
}  // namespace isoweave::testing::simplify_extracted_surface_test
