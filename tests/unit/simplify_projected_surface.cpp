// Whether a surface lies over a part of a face everywhere, against distances that are measured point by point.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "measure/triangle_tree.hpp"
#include "sanitized.hpp"
#include "simplify/projected_surface.hpp"

namespace isoweave::testing::simplify_projected_surface_test {
namespace {

using Corners = ProjectedSurface::Corners;
using measure::operator+;
using measure::operator-;
using measure::operator*;
using measure::Vector;

constexpr double kMost = 0.25;
constexpr int kCells = 10;  // of a sheet, along each side

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Vector point(double size) { return {number(-size, size), number(-size, size), number(-size, size)}; }
  template <class List>
  void shuffle(List& list) {
    std::shuffle(list.begin(), list.end(), engine_);
  }

 private:
  std::mt19937 engine_;
};

// Two triangles a cell over [0, 10] x [0, 10]. A corner is up to `across` from its place and up to `up` above or below.
std::vector<Corners> sheet(Random& random, double across, double up) {
  std::vector<Vector> at;
  for (int n = 0; n < (kCells + 1) * (kCells + 1); ++n) {
    at.push_back(Vector{static_cast<double>(n % (kCells + 1)), static_cast<double>(n / (kCells + 1)), 0} +
                 Vector{random.number(-across, across), random.number(-across, across), random.number(-up, up)});
  }
  std::vector<Corners> triangles;
  for (std::size_t j = 0; j < kCells; ++j) {
    for (std::size_t i = 0; i < kCells; ++i) {
      const std::size_t n = j * (kCells + 1) + i;
      triangles.push_back({at[n], at[n + 1], at[n + kCells + 1]});
      triangles.push_back({at[n + 1], at[n + kCells + 2], at[n + kCells + 1]});
    }
  }
  return triangles;
}

Vec3 vec(const Vector& p) { return {p[0], p[1], p[2]}; }

struct Answer {
  bool covered;
  double farthest;  // where it is covered

  bool operator==(const Answer&) const = default;
};

// Looks along the normal of a face at all of the triangles.
void look_at(ProjectedSurface& surface, const Corners& face, const std::vector<Corners>& triangles) {
  ASSERT_TRUE(surface.look_at(face));
  for (const Corners& t : triangles) ASSERT_TRUE(surface.add(vec(t[0]), vec(t[1]), vec(t[2])));
}

// Surveys a part of a face.
Answer survey(const std::vector<Corners>& triangles, const Corners& face, const Corners& part, double most) {
  ProjectedSurface surface;
  look_at(surface, face, triangles);
  double farthest = 0;
  const bool covered = surface.survey(part, most, farthest);
  return {covered, covered ? farthest : 0};
}

bool covers(const std::vector<Corners>& triangles, const Corners& face, const Corners& part, double most) {
  return survey(triangles, face, part, most).covered;
}

// How far a triangle is from a point along a direction, where a line through the point meets it.
std::optional<double> height(const Corners& t, const Vector& p, const Vector& up) {
  const Vector ab = t[1] - t[0];
  const Vector ac = t[2] - t[0];
  const Vector from = p - t[0];
  const double turn = measure::dot(measure::cross(ab, ac), up);
  if (std::abs(turn) < 1e-12) return std::nullopt;
  const double b = measure::dot(measure::cross(from, ac), up) / turn;
  const double c = measure::dot(measure::cross(ab, from), up) / turn;
  if (std::min({b, c, 1 - b - c}) < -1e-9) return std::nullopt;
  return measure::dot(t[0] + b * ab + c * ac - p, up);
}

// Calls visit(p) for points of a part.
template <class Visit>
void each_point(const Corners& part, const Visit& visit) {
  constexpr int kSteps = 20;
  for (int u = 0; u <= kSteps; ++u) {
    for (int v = 0; v + u <= kSteps; ++v) {
      const double a = static_cast<double>(u) / kSteps;
      const double b = static_cast<double>(v) / kSteps;
      visit(a * part[0] + b * part[1] + (1 - a - b) * part[2]);
    }
  }
}

// The greatest height, over points of a part, of the nearest triangle there.
double highest(const std::vector<Corners>& triangles, const Corners& part) {
  const Vector normal = measure::cross(part[1] - part[0], part[2] - part[0]);
  const Vector up = (1 / std::sqrt(measure::dot(normal, normal))) * normal;
  double most = 0;
  each_point(part, [&](const Vector& p) {
    double nearest = 1e300;
    for (const Corners& t : triangles) {
      const auto at = height(t, p, up);
      if (at) nearest = std::min(nearest, std::abs(*at));
    }
    most = std::max(most, nearest);
  });
  return most;
}

// The greatest distance of points of a part from the nearest triangle.
double farthest(const std::vector<Corners>& triangles, const Corners& part) {
  double most = 0;
  each_point(part, [&](const Vector& p) {
    double nearest = 1e300;
    for (const Corners& t : triangles) nearest = std::min(nearest, measure::squared_distance(p, t));
    most = std::max(most, std::sqrt(nearest));
  });
  return most;
}

Corners random_face(Random& random) {
  const Vector middle{random.number(2, 8), random.number(2, 8), random.number(-0.1, 0.1)};
  Corners face;
  do {
    for (Vector& corner : face) {
      corner = middle + Vector{random.number(-3, 3), random.number(-3, 3), random.number(-0.3, 0.3)};
    }
  } while (measure::area_of(face) < 0.2);
  return face;
}

// Half of a face, as it is cut there, or the face.
Corners random_part(Random& random, const Corners& face) {
  if (random.number(0, 1) < 0.5) return face;
  return {face[0], 0.5 * (face[0] + face[1]), face[2]};
}

// Sheets that are flat, rough, and so much so that they fold over.
TEST(ProjectedSurface, CoversNothingThatIsFartherSomewhere) {
  Random random(3);
  for (const auto& [across, up] : {std::pair{0.2, 0.1}, std::pair{0.3, 0.3}, std::pair{1.2, 0.3}}) {
    int covered = 0;
    int uncovered = 0;
    for (int trial = 0; trial < (testing::kSanitized ? 20 : 300); ++trial) {
      const std::vector<Corners> triangles = sheet(random, across, up);
      const Corners face = random_face(random);
      const Corners part = random_part(random, face);
      const Answer answer = survey(triangles, face, part, kMost);
      if (answer.covered) {
        ++covered;
        EXPECT_LE(farthest(triangles, part), answer.farthest * (1 + 1e-9)) << trial << ", " << across;
        EXPECT_LE(answer.farthest, kMost);
      } else {
        ++uncovered;
      }
    }
    EXPECT_GT(covered, 0) << across;
    EXPECT_GT(uncovered, 0) << across;
  }
}

// Halves of a part that was surveyed, and halves of these: each is covered only where all its points are near the
// surface. Some are of parts that are not covered as a whole.
TEST(ProjectedSurface, CoversPartsOfWhatItHasSurveyed) {
  Random random(11);
  int covered = 0;
  for (int trial = 0; trial < (testing::kSanitized ? 4 : 60); ++trial) {
    const std::vector<Corners> triangles = sheet(random, 0.3, 0.25);
    const Corners face = random_face(random);
    ProjectedSurface surface;
    look_at(surface, face, triangles);
    double known = 0;
    const bool whole = surface.survey(face, kMost, known);
    std::vector<Corners> parts{face};
    for (std::size_t n = 0; n < 31; ++n) {
      const auto [a, b, c] = parts[n];
      const Vector middle = 0.5 * (a + b);
      parts.push_back({c, a, middle});
      parts.push_back({b, c, middle});
      const bool is_covered = surface.covers(parts[n]);
      EXPECT_TRUE(is_covered || !whole) << trial;
      if (!is_covered) continue;
      covered += static_cast<int>(!whole);
      EXPECT_LE(farthest(triangles, parts[n]), known * (1 + 1e-9)) << trial << ", part " << n;
    }
  }
  EXPECT_GT(covered, testing::kSanitized ? 3 : 50);
}

// A point that is named lies in the part, and not near the triangle over it.
TEST(ProjectedSurface, NamesAPointThatIsNotNear) {
  Random random(13);
  std::vector<Corners> triangles = sheet(random, 0, 0);
  const Corners face{Vector{2.2, 2.1, 0}, Vector{7.9, 2.4, 0}, Vector{3.3, 7.7, 0}};
  for (Corners& t : triangles) {
    for (Vector& p : t) p[2] = p == Vector{4, 4, 0} ? 0.8 : 0;  // a peak
  }
  ProjectedSurface surface;
  look_at(surface, face, triangles);
  double known = 0;
  EXPECT_FALSE(surface.survey(face, kMost, known));
  ASSERT_TRUE(surface.far_point());
  EXPECT_NEAR((*surface.far_point())[0], 4, 1);
  EXPECT_NEAR((*surface.far_point())[1], 4, 1);
  EXPECT_NEAR((*surface.far_point())[2], 0, 1e-12);
}

// A sheet without folds that is near enough covers all that it lies over: also where triangles stand on their heads.
TEST(ProjectedSurface, CoversAllThatItLiesOver) {
  Random random(5);
  int covered = 0;
  for (int trial = 0; trial < (testing::kSanitized ? 20 : 300); ++trial) {
    std::vector<Corners> triangles = sheet(random, 0.2, 0.12);
    if (trial % 2 == 1) {
      for (Corners& t : triangles) std::swap(t[0], t[1]);
    }
    const Corners face = random_face(random);
    const double most = highest(triangles, face);
    if (most > 1) continue;  // the face goes beyond the sheet
    ++covered;
    // The height is measured at some points.
    EXPECT_TRUE(covers(triangles, face, random_part(random, face), most + 0.3)) << trial;
  }
  EXPECT_GT(covered, testing::kSanitized ? 3 : 50);
}

TEST(ProjectedSurface, SeesAHoleWhereItIs) {
  Random random(7);
  std::vector<Corners> triangles = sheet(random, 0, 0.1);
  const Corners face{Vector{2.2, 2.1, 0}, Vector{7.9, 2.4, 0}, Vector{3.3, 7.7, 0}};
  const Corners hole = triangles[2 * (5 * kCells + 3)];  // over (3, 5)
  ASSERT_TRUE(covers(triangles, face, face, kMost));
  std::erase(triangles, hole);
  EXPECT_FALSE(covers(triangles, face, face, kMost));
  const Corners beside{face[0], Vector{5, 2.25, 0}, Vector{2.5, 3.5, 0}};
  EXPECT_TRUE(covers(triangles, face, beside, kMost));
  const Corners inside{Vector{3.2, 5.2, 0}, Vector{3.4, 5.2, 0}, Vector{3.2, 5.4, 0}};
  EXPECT_FALSE(covers(triangles, face, inside, kMost)) << "nothing is over it";
}

// Triangles far above or below change nothing, nor does the order in which triangles come.
TEST(ProjectedSurface, MoreTrianglesInAnyOrderGiveTheSameAnswer) {
  Random random(9);
  int covered = 0;
  for (int trial = 0; trial < (testing::kSanitized ? 10 : 100); ++trial) {
    const std::vector<Corners> triangles = sheet(random, 0.3, 0.15);
    const Corners face = random_face(random);
    const Answer answer = survey(triangles, face, face, kMost);
    covered += static_cast<int>(answer.covered);
    std::vector<Corners> more = triangles;
    for (int n = 0; n < 40; ++n) {
      const Vector place = Vector{5, 5, trial % 2 == 0 ? 9.0 : -9.0} + random.point(4);
      more.push_back({place, place + random.point(2), place + random.point(2)});
    }
    random.shuffle(more);
    EXPECT_EQ(survey(more, face, face, kMost), answer) << trial;
  }
  EXPECT_GT(covered, 0);
}

TEST(ProjectedSurface, HasRoomForSoMany) {
  ProjectedSurface surface;
  ASSERT_TRUE(surface.look_at({Vector{0, 0, 0}, Vector{1, 0, 0}, Vector{0, 1, 0}}));
  for (std::size_t n = 0; n < SeenTriangles::kRoom; ++n) EXPECT_TRUE(surface.add({}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(surface.add({}, {1, 0, 0}, {0, 1, 0}));
  surface.clear();
  EXPECT_TRUE(surface.add({}, {1, 0, 0}, {0, 1, 0}));
}

TEST(ProjectedSurface, ANeedleHasNoNormal) {
  ProjectedSurface surface;
  EXPECT_FALSE(surface.look_at({Vector{0, 0, 0}, Vector{1, 0, 0}, Vector{2, 0, 0}}));
  EXPECT_FALSE(surface.look_at({Vector{1, 1, 1}, Vector{1, 1, 1}, Vector{1, 1, 1}}));
}

}  // namespace
}  // namespace isoweave::testing::simplify_projected_surface_test
