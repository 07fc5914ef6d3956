// Runs to a number of triangles stop where the reference queue would.
// Threads: Limits.*:CountsHeld.*
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "oracle.hpp"
#include "simplify/count_target.hpp"

namespace isoweave::testing {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

ZoneOptions zone_options(const SurfaceCase& surface) {
  const double a0 = surface.voxel() * surface.voxel();
  ZoneOptions zone{VertexNumbering::of_cube_edges(surface.volume.dims), a0,
                   retire_cost(surface.error * surface.voxel(), a0, 1)};
  zone.drop_specks = surface.drop_specks;
  zone.quality = surface.quality;
  return zone;
}

SurfaceCase make_case(const std::string& kind, bool closed) {
  SurfaceCase surface;
  surface.volume.kind = kind;
  surface.volume.dims = {16, 15, 22};
  surface.volume.spacing = {0.8, 1.1, 1.5};
  surface.volume.seed = 5;
  surface.closed = closed;
  return surface;
}

SurfaceRun oracle(const SurfaceCase& surface, std::uint64_t triangles) {
  const Executor executor(1);
  Simplifier simplifier({zone_options(surface), Schedule::kQueue}, executor, nullptr);
  return sweep(surface, kWholeVolume, executor, simplifier, [&] {
    const std::uint64_t have = simplifier.triangles();
    decide_in_order(simplifier.zone(), have > triangles ? have - triangles : 0);
    simplifier.zone().retire_all();
  });
}

// most_held: so that sweeps have to thin out.
SurfaceRun run(const SurfaceCase& surface, std::uint64_t triangles, Schedule schedule, int threads, std::int64_t slab,
               std::uint64_t most_held, std::uint64_t* held = nullptr) {
  const Executor executor(threads);
  Simplifier simplifier({zone_options(surface), schedule}, executor, nullptr);
  CountTarget target(simplifier, executor, triangles, most_held);
  const std::int64_t layers = surface.volume.dims[2] + (surface.closed ? 1 : 0);
  std::int64_t done = 0;
  return sweep(surface, slab, executor, simplifier, [&] {
    simplifier.decide();
    done += slab;
    done < layers ? target.thin_out() : target.finish();
    if (held != nullptr) *held = std::max(*held, simplifier.live_triangles());
  });
}

class Counts : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  SurfaceCase surface() const { return make_case(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(Counts, RunsStopWhereTheReferenceQueueWould) {
  for (const double error : {kNoLimit, 0.3}) {
    SurfaceCase surface = this->surface();
    surface.error = error;
    const std::uint64_t all = oracle(surface, ~std::uint64_t{0}).report.triangles;
    ASSERT_GT(all, 200U);
    const std::vector<std::uint64_t> counts =
        kSanitized ? std::vector{all / 5 + 1, std::uint64_t{1}}
                   : std::vector{all / 2, all / 5 + 1, all / 20, std::uint64_t{1}, all + 1};
    for (const std::uint64_t triangles : counts) {
      const SurfaceRun expected = oracle(surface, triangles);
      if (triangles == all / 2 && std::isinf(error)) {
        ASSERT_GE(expected.report.triangles + 2, triangles);
      }
      for (const std::int64_t slab : {std::int64_t{1}, std::int64_t{6}, kWholeVolume}) {
        if (kSanitized && slab == 6) continue;
        const auto same = [&](Schedule schedule, int threads) {
          const SurfaceRun found = run(surface, triangles, schedule, threads, slab, 0);
          EXPECT_EQ(digest_text(found.report.digest), digest_text(expected.report.digest))
              << triangles << " of " << all << ", error " << error << ", slab " << slab << ", threads " << threads
              << ", schedule " << static_cast<int>(schedule);
          EXPECT_EQ(found.report.triangles, expected.report.triangles);
        };
        same(Schedule::kQueue, 1);
        same(Schedule::kLocal, 1);
        if (kSanitized) continue;
        same(Schedule::kLocal, 4);
        same(Schedule::kRounds, 3);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Counts,
                         ::testing::Combine(::testing::Values("gyroid", "noise", "box", "specks", "smooth"),
                                            ::testing::Bool()),
                         [](const auto& instance) {
                           return std::get<0>(instance.param) + (std::get<1>(instance.param) ? "Closed" : "Open");
                         });

// One decision takes four triangles away then.
TEST(CountsOfSpecks, StopWhereTheReferenceQueueWould) {
  SurfaceCase surface = make_case("specks", true);
  surface.error = kNoLimit;
  surface.drop_specks = true;
  const std::uint64_t all = oracle(surface, ~std::uint64_t{0}).report.triangles;
  for (const std::uint64_t triangles : {all / 2, all / 5, all / 20, std::uint64_t{3}, std::uint64_t{1}}) {
    const SurfaceRun expected = oracle(surface, triangles);
    for (const std::int64_t slab : {std::int64_t{6}, kWholeVolume}) {
      const SurfaceRun found = run(surface, triangles, Schedule::kLocal, 3, slab, 0);
      EXPECT_EQ(digest_text(found.report.digest), digest_text(expected.report.digest)) << triangles << " of " << all;
      EXPECT_EQ(found.report.triangles, expected.report.triangles);
    }
  }
}

// The least cost of an edge that is to be decided; kRetiredCost if there is none.
CostBits least_cost(const Zone& zone) {
  CostBits least = kRetiredCost;
  for (const auto turn : zone.turn_keys) least = std::min(least, cost_of(turn));
  return least;
}

TEST(Limits, RaisedFromCostToCostGiveTheMeshOfTheReferenceQueue) {
  for (const char* kind : {"noise", "box"}) {
    SurfaceCase surface = make_case(kind, true);
    surface.volume.dims = {8, 7, 9};
    surface.error = 1.5;
    const std::string expected = digest_text(oracle(surface, 1).report.digest);
    const auto raised = [&](Schedule schedule, int threads) {
      const Executor executor(threads);
      Simplifier simplifier({zone_options(surface), schedule}, executor, nullptr);
      Zone& zone = simplifier.zone();
      const SurfaceRun found = sweep(surface, kWholeVolume, executor, simplifier, [&] {
        zone.limit = kUnknownCost;
        for (simplifier.decide(); zone.limit < zone.options.retire; simplifier.decide()) {
          const CostBits least = std::min(least_cost(zone), zone.options.retire);
          if (least <= zone.limit) throw std::logic_error("an edge within the limit has not been decided");
          zone.limit = least;
        }
      });
      EXPECT_GT(simplifier.rounds(), 20U);
      return digest_text(found.report.digest);
    };
    EXPECT_EQ(raised(Schedule::kLocal, 1), expected) << kind;
    EXPECT_EQ(raised(Schedule::kLocal, 3), expected) << kind;
    EXPECT_EQ(raised(Schedule::kRounds, 2), expected) << kind;
  }
}

TEST(CountsHeld, NoMoreThanIsNeeded) {
  SurfaceCase surface = make_case("smooth", true);
  surface.volume.dims = {40, 40, 160};
  surface.error = kNoLimit;
  std::uint64_t held = 0;
  const SurfaceRun thin = run(surface, 1500, Schedule::kLocal, 2, 8, 6000, &held);
  const SurfaceRun whole = run(surface, 1500, Schedule::kLocal, 2, kWholeVolume, 6000);
  EXPECT_EQ(digest_text(thin.report.digest), digest_text(whole.report.digest));
  EXPECT_LE(thin.report.triangles, 1500U);
  EXPECT_GE(thin.report.triangles, 1499U);
  EXPECT_GT(thin.report.triangles_extracted, 40'000U);
  EXPECT_LT(held, 30'000U);
}

}  // namespace
}  // namespace isoweave::testing
