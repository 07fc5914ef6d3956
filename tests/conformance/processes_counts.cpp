// Ranks and tasks give the mesh of a sweep to a number of triangles.
// Threads: *RanksToNumber.*/noise:*TasksToNumber.*/noise:RanksThatCount.*
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <vector>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/tasks.hpp"
#include "pipeline/task.hpp"
#include "rank_runs.hpp"

namespace isoweave::testing::processes_counts_test {
namespace {

// Errors from none to one that removes more than is asked for: then all is done again.
constexpr std::array kHeadStarts{0.0, 0.02, 0.3, 3.0};
constexpr std::array kSchedules{Schedule::kLocal, Schedule::kQueue, Schedule::kRounds};

// Other numbers for every scene, and always the same ones.
std::mt19937_64 random_for(const BlockScene& scene) {
  std::seed_seq name(scene.name.begin(), scene.name.end());
  return std::mt19937_64(name);
}

RunControl any_control(std::mt19937_64& random) {
  RunControl control;
  control.threads = 1 + static_cast<int>(random() % 2);
  control.schedule = kSchedules[random() % 3];
  return control;
}

// Calls check(scene, head start, expected) for scenes that are to leave some shares of their triangles, each with one
// of the head starts.
template <class Check>
void for_shares(const BlockScene& scene, std::mt19937_64& random, const Check& check) {
  const auto all = static_cast<double>(all_triangles(scene));
  std::size_t n = random();
  for (const double share : kSanitized ? std::vector{0.02, 0.7} : std::vector{0.02, 0.2, 0.7, 1.5}) {
    const double head_start = kHeadStarts[n++ % kHeadStarts.size()];
    const BlockScene some = to_number(scene, 1 + static_cast<std::uint64_t>(share * all));
    const bool by_share = share <= 1 && random() % 2 == 0;
    const BlockRun expected = run_sweep(some);
    check(by_share ? to_share(some, static_cast<double>(some.options.triangles) / all) : some, head_start, expected);
  }
}

class RanksToNumber : public ::testing::TestWithParam<BlockScene> {};

TEST_P(RanksToNumber, AnyNumberLimitAndShareGivesTheMeshOfTheSweep) {
  const files::Folder folder;
  std::mt19937_64 random = random_for(GetParam());
  for_shares(GetParam(), random, [&](const BlockScene& scene, double head_start, const BlockRun& expected) {
    const int count = std::array{1, 2, 3, 5}[random() % 4];
    RankOptions ranks;
    ranks.blocks.size = std::array{8, 13, 21, 64}[random() % 4];
    if (count == 1) ranks.blocks.folder = folder.path();
    RunControl control = any_control(random);
    control.head_start = head_start;
    SCOPED_TRACE(::testing::Message() << count << " ranks, blocks of " << ranks.blocks.size << ", head start "
                                      << head_start << ", to " << scene.options.triangles);
    expect_same_by_number(run_ranks(scene, count, ranks, control), expected);
    EXPECT_TRUE(folder.entries().empty());
  });
}

INSTANTIATE_TEST_SUITE_P(Scenes, RanksToNumber, ::testing::ValuesIn(number_scenes()),
                         [](const auto& one) { return one.param.name; });

// Does all tasks and collects them, again with a lower head start where it was too high. Returns how often they were.
int do_until_collected(TaskMesh mesh, const BlockScene& scene, const BlockRun& expected, std::mt19937_64& random) {
  for (int runs = 1;; ++runs) {
    const std::uint64_t count = list_tasks(mesh).count();
    for (std::uint64_t task = 0; task < count; ++task) do_task(mesh, task, any_control(random));
    try {
      expect_same_by_number(
          run_into_memory(scene, [&](std::span<MeshSink* const> sinks) { return collect_tasks(mesh, sinks); }),
          expected);
      return runs;
    } catch (const HeadStartTooHigh& found) {
      EXPECT_LT(found.lower(), mesh.head_start);
      mesh.head_start = found.lower();
      remove_results(mesh.folder);
    }
  }
}

class TasksToNumber : public ::testing::TestWithParam<BlockScene> {};

TEST_P(TasksToNumber, AnyLimitAndShareGivesTheMeshOfTheSweep) {
  std::mt19937_64 random = random_for(GetParam());
  for_shares(GetParam(), random, [&](const BlockScene& scene, double head_start, const BlockRun& expected) {
    const files::Folder folder;
    TaskMesh mesh{folder.path(), scene.open, scene.options, {}, head_start};
    mesh.blocks.size = kSanitized ? 24 : std::array{16, 21, 64}[random() % 3];
    SCOPED_TRACE(::testing::Message() << "blocks of " << mesh.blocks.size << ", head start " << head_start << ", to "
                                      << scene.options.triangles);
    const int runs = do_until_collected(mesh, scene, expected, random);
    EXPECT_LE(runs, head_start > 0 ? 2 : 1);
  });
}

INSTANTIATE_TEST_SUITE_P(Scenes, TasksToNumber, ::testing::ValuesIn(number_scenes()),
                         [](const auto& one) { return one.param.name; });

TEST(TasksThatCount, FilesOfAnotherHeadStartAreRefusedByName) {
  const files::Folder folder;
  const BlockScene scene = to_number(noise_scene(), 2'000);
  TaskMesh mesh{folder.path(), scene.open, scene.options, {}, 0.02};
  mesh.blocks.size = 24;
  const std::uint64_t count = list_tasks(mesh).count();
  for (std::uint64_t task = 0; task < count; ++task) do_task(mesh, task);
  mesh.head_start = 0.01;
  std::string refused;
  try {
    run_into_memory(scene, [&](std::span<MeshSink* const> sinks) { return collect_tasks(mesh, sinks); });
  } catch (const BadInput& error) {
    refused = error.what();
  }
  EXPECT_NE(refused.find("0.rest: "), std::string::npos) << refused;
  EXPECT_NE(refused.find("the head start of the plan"), std::string::npos) << refused;
}

TEST(TasksThatCount, ALowerHeadStartCostsNoMoreThanTheCost) {
  const VolumeInfo volume = noise_scene().open()->info();
  std::mt19937_64 random(3);
  for (int n = 0; n < 1000; ++n) {
    const double error =
        std::ldexp(1 + static_cast<double>(random() % 1000) / 1000, static_cast<int>(random() % 60) - 40);
    const CostBits cost = head_start_cost(error, volume) - static_cast<CostBits>(random() % 3);
    const double lower = head_start_within(cost, volume);
    EXPECT_LE(head_start_cost(lower, volume), cost);
    if (lower > 0) {
      EXPECT_GE(head_start_cost(lower, volume) + 2, cost);
    }
  }
  EXPECT_EQ(head_start_within(kUnknownCost, volume), 0);
}

// A volume whose samples may not be read.
class Unread final : public SliceSource {
 public:
  Unread() : info_(noise_scene().open()->info()) {}

  const VolumeInfo& info() const override { return info_; }
  bool skips() const override { return true; }
  void read(std::int64_t, std::int64_t, std::span<std::byte>) override { throw std::logic_error("a sample was read"); }

 private:
  VolumeInfo info_;
};

// Results that are kept are those of the last head start: a run that goes on takes it from them.
TEST(RanksThatCount, GoOnWithTheHeadStartOfWhatIsKept) {
  const files::Folder folder;
  const BlockScene scene = to_number(noise_scene(), all_triangles(noise_scene()) / 2);
  RankOptions ranks;
  ranks.blocks.size = 16;
  ranks.results = folder.path();
  RunControl control;
  control.head_start = 3;
  const BlockRun expected = run_sweep(scene);
  const BlockRun found = run_ranks(scene, 3, ranks, control);
  expect_same_by_number(found, expected);
  ASSERT_FALSE(folder.entries().empty());
  std::uint64_t done = 0;
  for (const RankWork& rank : found.report.ranks) done += rank.tasks;
  EXPECT_EQ(done, 2 * list_tasks({folder.path(), scene.open, scene.options, ranks.blocks}).count());
  BlockScene unread = scene;
  unread.open = [] { return std::make_unique<Unread>(); };
  expect_same_by_number(run_ranks(unread, 2, ranks, control), expected);
}

TEST(RanksThatCount, AForecastOfTheFirstRankSavesPasses) {
  const BlockScene scene = to_number(noise_scene(), 2'000);
  RankOptions ranks;
  ranks.blocks.size = 16;
  expect_same_by_number(run_ranks(scene, 2, ranks, {}), run_sweep(scene));
}

}  // namespace
}  // namespace isoweave::testing::processes_counts_test
