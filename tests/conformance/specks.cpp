// Components that have shrunk to a tetrahedron vanish at a cost of their own, the same ones in every schedule.
// Threads: none, schedules.cpp has the same loops
#include <gtest/gtest.h>

#include "oracle.hpp"

namespace isoweave::testing::specks_test {
namespace {

SurfaceCase make_case(const std::string& kind, bool closed) {
  SurfaceCase surface;
  surface.volume.kind = kind;
  surface.volume.dims = {18, 15, 20};
  surface.volume.spacing = {0.7, 0.7, 1.3};
  surface.volume.seed = 11;
  surface.closed = closed;
  surface.drop_specks = true;
  return surface;
}

class Specks : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  SurfaceCase surface(double error) const {
    SurfaceCase surface = make_case(std::get<0>(GetParam()), std::get<1>(GetParam()));
    surface.error = error;
    return surface;
  }
};

TEST_P(Specks, AreTheSameInEveryScheduleAndSlab) {
  for (const double error : {0.5, 1.5}) {
    SurfaceCase surface = this->surface(error);
    const SurfaceRun expected = reference_run(surface);
    if (error > 1) {
      EXPECT_GT(expected.report.specks, 0u);
    }
    for (const std::int64_t slab : {std::int64_t{1}, std::int64_t{5}, kWholeVolume}) {
      const auto same = [&](Schedule schedule, int threads) {
        const SurfaceRun run = sweep(surface, schedule, threads, slab);
        EXPECT_EQ(digest_text(run.report.digest), digest_text(expected.report.digest))
            << "slab " << slab << ", threads " << threads << ", schedule " << static_cast<int>(schedule);
        EXPECT_EQ(run.report.specks, expected.report.specks);
      };
      same(Schedule::kQueue, 1);
      same(Schedule::kLocal, 1);
      same(Schedule::kLocal, 4);
      same(Schedule::kRounds, 3);
    }
  }
}

TEST_P(Specks, TakeTheirComponentAndNothingElse) {
  SurfaceCase surface = this->surface(1.5);
  const SurfaceRun without = sweep(surface, Schedule::kLocal, 2, 5);
  surface.drop_specks = false;
  const SurfaceRun with = sweep(surface, Schedule::kLocal, 2, 5);
  const MeshCheck check = check_mesh(without.mesh);
  EXPECT_EQ(check.nonmanifold_edges, 0u);
  EXPECT_EQ(check.nonmanifold_vertices, 0u);
  EXPECT_EQ(check.unused_vertices, 0u);
  EXPECT_EQ(check.components, without.report.components);
  EXPECT_EQ(check.euler, without.report.euler);
  EXPECT_EQ(with.report.components - without.report.specks, without.report.components);
  EXPECT_EQ(with.report.euler - 2 * static_cast<std::int64_t>(without.report.specks), without.report.euler);
  EXPECT_EQ(with.report.triangles - 4 * without.report.specks, without.report.triangles);
}

// A run that goes on with a larger error ends where a direct one does.
TEST_P(Specks, VanishAtACostThatNoErrorChanges) {
  SurfaceCase surface = this->surface(1.5);
  const SurfaceRun direct = sweep(surface, Schedule::kLocal, 2, kWholeVolume);
  const Executor executor(2);
  Simplifier simplifier({surface.zone(), Schedule::kLocal}, executor, nullptr);
  const double voxel = surface.voxel();
  const SurfaceRun steps = sweep(surface, kWholeVolume, executor, simplifier, [&] {
    for (const double error : {0.2, 0.7, 1.5}) {
      simplifier.zone().limit = retire_cost(error * voxel, voxel * voxel);
      simplifier.decide();
    }
  });
  EXPECT_EQ(digest_text(steps.report.digest), digest_text(direct.report.digest));
}

INSTANTIATE_TEST_SUITE_P(Volumes, Specks,
                         ::testing::Combine(::testing::Values("specks", "noise", "white"), ::testing::Bool()),
                         [](const auto& test) {
                           return std::get<0>(test.param) + (std::get<1>(test.param) ? "Closed" : "Open");
                         });

TEST(Speck, GoesWhenHalfItsLongestEdgeIsWithinTheError) {
  TriangleMesh needle;
  needle.vertices = {{0, 0, 0}, {10, 0, 0}, {10, 0.1F, 0}, {10, 0, 0.1F}};
  needle.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const double error : {4.9, 5.1}) {
    MemorySink sink;
    SimplifyOptions options;
    options.error = Length::units(error);
    options.drop_specks = true;
    const MeshReport report = simplify_mesh(needle, sink, options);
    EXPECT_EQ(report.triangles, error < 5 ? 4u : 0u);
    EXPECT_EQ(report.specks, error < 5 ? 0u : 1u);
    options.drop_specks = false;
    EXPECT_EQ(simplify_mesh(needle, sink, options).triangles, 4u);
  }
}

}  // namespace
}  // namespace isoweave::testing::specks_test
