// Runs to a number of triangles stop where the reference queue would.
// Threads: Limits.*:CountsHeld.*:HeadStarts.End*:HeadStarts.ThatAre*
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "oracle.hpp"
#include "simplify/count_target.hpp"

namespace isoweave::testing::counts_test {
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

struct Way {
  Schedule schedule = Schedule::kLocal;
  int threads = 1;
  std::int64_t slab = kWholeVolume;
  std::uint64_t most_held = 0;  // 0: sweeps have to thin out
  HeadStart head_start{};
};

struct CountRun {
  SurfaceRun run;
  std::uint64_t held = 0;            // triangles, the most after a slab
  std::optional<HeadStart> instead;  // the head start that the run should have had
};

CountRun run_once(const SurfaceCase& surface, std::uint64_t triangles, const Way& way) {
  const Executor executor(way.threads);
  Simplifier simplifier({zone_options(surface), way.schedule}, executor, nullptr);
  CountTarget target(simplifier, executor, {triangles}, way.most_held, way.head_start);
  const std::int64_t layers = surface.volume.dims[2] + (surface.closed ? 1 : 0);
  std::int64_t done = 0;
  CountRun made;
  made.run = sweep(surface, way.slab, executor, simplifier, [&] {
    simplifier.decide();
    done += way.slab;
    if (done < layers) {
      target.thin_out();
    } else if (target.has_overshot()) {
      made.instead = target.next_head_start();
      simplifier.zone().retire_all();
    } else {
      target.finish();
    }
    made.held = std::max(made.held, simplifier.live_triangles());
  });
  return made;
}

CountRun run(const SurfaceCase& surface, std::uint64_t triangles, Way way) {
  CountRun made = run_once(surface, triangles, way);
  if (!made.instead) return made;
  while (made.instead && made.instead->counts > 0) {
    EXPECT_LE(made.instead->counts, 7U);
    way.head_start = *made.instead;
    made = run_once(surface, triangles, way);
  }
  way.head_start = *made.instead;
  CountRun again = run_once(surface, triangles, way);
  EXPECT_FALSE(again.instead) << "a safe head start";
  again.instead = way.head_start;
  return again;
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
          const SurfaceRun found = run(surface, triangles, {schedule, threads, slab}).run;
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
      const SurfaceRun found = run(surface, triangles, {Schedule::kLocal, 3, slab}).run;
      EXPECT_EQ(digest_text(found.report.digest), digest_text(expected.report.digest)) << triangles << " of " << all;
      EXPECT_EQ(found.report.triangles, expected.report.triangles);
    }
  }
}

// The cost of the last collapse of the reference: a run with it as its limit leaves the number, or somewhat less.
CostBits cost_that_leaves(const SurfaceCase& surface, std::uint64_t triangles) {
  const Executor executor(1);
  Simplifier simplifier({zone_options(surface), Schedule::kQueue}, executor, nullptr);
  std::uint64_t dearest = 0;
  sweep(surface, kWholeVolume, executor, simplifier, [&] {
    dearest = decide_in_order(simplifier.zone(), simplifier.triangles() - triangles).dearest;
    simplifier.zone().retire_all();
  });
  return static_cast<CostBits>(dearest);
}

// Compares runs with a head start, whatever it is, with the reference. Returns how many of them overshot.
int overshot_runs(const SurfaceCase& surface, std::uint64_t triangles, std::uint64_t most_held) {
  const SurfaceRun expected = oracle(surface, triangles);
  const auto right = double{cost_value(cost_that_leaves(surface, triangles))};
  int overshot = 0;
  for (const double factor : {1e-3, 0.3, 0.9, 1.0, 1.2, 4.0, 1e6}) {
    for (const Way& way : {Way{Schedule::kLocal, 1, 1}, Way{Schedule::kLocal, 4, 6}, Way{Schedule::kLocal, 2},
                           Way{Schedule::kQueue, 1, 6}, Way{Schedule::kRounds, 3, 6}}) {
      if (kSanitized && way.slab == 1) continue;
      Way with = way;
      with.most_held = most_held;
      with.head_start.cost = to_cost(factor * right);
      const CountRun found = run(surface, triangles, with);
      EXPECT_EQ(digest_text(found.run.report.digest), digest_text(expected.report.digest))
          << surface.volume.kind << ' ' << triangles << ", factor " << factor << ", slab " << way.slab << ", schedule "
          << static_cast<int>(way.schedule);
      EXPECT_EQ(found.run.report.triangles, expected.report.triangles);
      overshot += found.instead ? 1 : 0;
    }
  }
  return overshot;
}

TEST(HeadStarts, ChangeNoMeshHoweverWrongTheyAre) {
  for (const char* kind : kSanitized ? std::vector{"noise", "box"} : std::vector{"noise", "box", "smooth"}) {
    SurfaceCase surface = make_case(kind, true);
    surface.error = kNoLimit;
    const std::uint64_t all = oracle(surface, ~std::uint64_t{0}).report.triangles;
    for (const std::uint64_t triangles : {all / 2, all / 10}) {
      EXPECT_GE(overshot_runs(surface, triangles, ~std::uint64_t{0}), kSanitized ? 8 : 10) << kind;
      EXPECT_GE(overshot_runs(surface, triangles, 0), kSanitized ? 8 : 10) << kind;
    }
  }
}

TEST(HeadStarts, CountTheFourTrianglesOfASpeck) {
  SurfaceCase surface = make_case("specks", true);
  surface.error = kNoLimit;
  surface.drop_specks = true;
  const std::uint64_t all = oracle(surface, ~std::uint64_t{0}).report.triangles;
  for (const std::uint64_t triangles : {all / 2, all / 5}) EXPECT_GE(overshot_runs(surface, triangles, 0), 8);
}

// An error below the one that leaves the number ends the run, and the head start with it.
TEST(HeadStarts, EndAtTheError) {
  SurfaceCase surface = make_case("noise", true);
  surface.error = 0.3;
  const std::uint64_t left = oracle(surface, 1).report.triangles;
  for (const std::uint64_t triangles : {left / 2, left - 1, left, left + 1}) {
    const SurfaceRun expected = oracle(surface, triangles);
    for (const std::int64_t slab : {std::int64_t{6}, kWholeVolume}) {
      const CountRun found = run(surface, triangles, {Schedule::kLocal, 2, slab, 0, {kRetiredCost - 1}});
      EXPECT_EQ(digest_text(found.run.report.digest), digest_text(expected.report.digest)) << triangles;
    }
  }
}

// Counting may begin too low, and has to be done again, or go too far.
TEST(HeadStarts, AreCountedFromWhereverItBegins) {
  for (const char* kind : {"noise", "box", "specks"}) {
    SurfaceCase surface = make_case(kind, true);
    surface.drop_specks = surface.volume.kind == "specks";
    for (const double error : {kNoLimit, 0.3}) {
      surface.error = error;
      const std::uint64_t all = oracle(surface, ~std::uint64_t{0}).report.triangles;
      for (const std::uint64_t triangles : {all + 1, all / 2, all / 10, std::uint64_t{1}}) {
        const SurfaceRun expected = oracle(surface, triangles);
        for (const float first : {1e-4F, 0.01F, 10.0F}) {
          const Way way{Schedule::kLocal, 2, 3, 0, HeadStart::counting(cost_bits(first))};
          const CountRun found = run(surface, triangles, way);
          EXPECT_EQ(digest_text(found.run.report.digest), digest_text(expected.report.digest))
              << kind << ' ' << triangles << " of " << all << ", error " << error << ", from " << first;
          ASSERT_TRUE(found.instead);
          EXPECT_NE(found.instead->met, kUnknownCost);
        }
      }
    }
  }
}

// A run to a number that was counted holds no more triangles when the number is larger.
TEST(HeadStarts, ThatAreCountedHoldLittle) {
  SurfaceCase surface = make_case("noise", false);
  surface.volume.dims = {16, 15, 120};
  surface.error = kNoLimit;
  const std::uint64_t all = oracle(surface, ~std::uint64_t{0}).report.triangles;
  const Way guessed{Schedule::kLocal, 1, 4, ~std::uint64_t{0}, {cost_bits(1e-4F)}};
  const Way counted{Schedule::kLocal, 1, 4, ~std::uint64_t{0}, HeadStart::counting(cost_bits(0.1F))};
  EXPECT_GT(run(surface, all / 2, guessed).held, all / 2);
  EXPECT_LT(run(surface, all / 2, counted).held, all / 5);
}

// Where no more triangles are extracted than are asked for, nothing is decided.
TEST(HeadStarts, OvershootWhereNothingIsToBeDecided) {
  SurfaceCase surface = make_case("noise", true);
  surface.error = kNoLimit;
  const std::uint64_t all = oracle(surface, ~std::uint64_t{0}).report.triangles;
  const CountRun found = run(surface, all + 1, {Schedule::kLocal, 2, 6, 0, {cost_bits(0.1F)}});
  ASSERT_TRUE(found.instead);
  EXPECT_EQ(found.instead->cost, kUnknownCost);
  EXPECT_EQ(found.run.report.triangles, all);
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
  const CountRun thin = run(surface, 1500, {Schedule::kLocal, 2, 8, 6000});
  const CountRun whole = run(surface, 1500, {Schedule::kLocal, 2, kWholeVolume, 6000});
  EXPECT_EQ(digest_text(thin.run.report.digest), digest_text(whole.run.report.digest));
  EXPECT_LE(thin.run.report.triangles, 1500U);
  EXPECT_GE(thin.run.report.triangles, 1499U);
  EXPECT_GT(thin.run.report.triangles_extracted, 40'000U);
  EXPECT_LT(thin.held, 30'000U);
}

}  // namespace
}  // namespace isoweave::testing::counts_test
