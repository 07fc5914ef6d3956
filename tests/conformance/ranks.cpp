// Any number of ranks gives the mesh of the sweep, and an error of one ends all.
// Threads: *Ranks.AnyNumber*/noise:*Ranks.AnyNumber*/noiseLevels:RankErrors*
#include "isoweave/ranks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <random>

#include "block_scenes.hpp"
#include "files.hpp"
#include "isoweave/error.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/ranks/rank_plan.hpp"
#include "rank_runs.hpp"

namespace isoweave::testing::ranks_test {
namespace {

class Ranks : public ::testing::TestWithParam<BlockScene> {};

TEST_P(Ranks, AnyNumberGivesTheMeshOfTheSweep) {
  const BlockRun expected = run_sweep(GetParam());
  const files::Folder folder;
  std::mt19937_64 random(11);
  const std::vector<int> counts = kSanitized ? std::vector{3} : std::vector{1, 2, 3, 4, 8};
  for (const int count : counts) {
    RankOptions ranks;
    ranks.blocks.size = 8 + static_cast<std::int64_t>(random() % 8);
    for (std::int64_t& first : ranks.blocks.first) first = static_cast<std::int64_t>(random() % 40) - 20;
    RunControl control;
    control.threads = 1 + static_cast<int>(random() % 2);
    constexpr std::array kSchedules{Schedule::kLocal, Schedule::kQueue, Schedule::kRounds};
    control.schedule = kSchedules[random() % 3];
    SCOPED_TRACE(::testing::Message() << count << " ranks, blocks of " << ranks.blocks.size << " at "
                                      << ranks.blocks.first[0] << ", " << ranks.blocks.first[1] << ", "
                                      << ranks.blocks.first[2]);
    expect_same(run_ranks(GetParam(), count, ranks, control), expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Ranks, ::testing::ValuesIn(some_scenes()),
                         [](const auto& one) { return one.param.name; });

RankOptions blocks_of(std::int64_t size) {
  RankOptions ranks;
  ranks.blocks.size = size;
  return ranks;
}

TEST(RankFolders, PartsThatWaitInFilesAreTheSame) {
  const files::Folder folder;
  RankOptions ranks = blocks_of(12);
  ranks.blocks.folder = folder.path();
  expect_same(run_ranks(noise_scene(), 1, ranks, {}), run_sweep(noise_scene()));
  EXPECT_TRUE(folder.entries().empty());
}

// A volume of which some readings fail.
class FailingVolume final : public SliceSource {
 public:
  FailingVolume(std::unique_ptr<SliceSource> volume, std::atomic<int>& left)
      : volume_(std::move(volume)), left_(left) {}

  const VolumeInfo& info() const override { return volume_->info(); }
  bool skips() const override { return true; }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    if (--left_ == 0) throw BadInput("scan: a slice cannot be read");
    volume_->read(first, count, out);
  }

 private:
  std::unique_ptr<SliceSource> volume_;
  std::atomic<int>& left_;
};

template <class E>
std::string text_of(const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const E& found) {
    return found.what();
  } catch (const std::exception& found) {
    return std::string("another error: ") + found.what();
  }
  return "no error";
}

// Runs three ranks, of which one fails at its n-th reading. Returns how many have thrown that error: all or none.
std::size_t run_failing(int at, const RankOptions& ranks) {
  std::atomic<int> left = at;
  MemorySink sink;
  MeshSink* const sinks[] = {&sink};
  const auto errors = LocalRanks(3).run([&](RankLink& link) {
    const auto open = [&]() -> std::unique_ptr<SliceSource> {
      if (link.rank() != 1) return noise_scene().open();
      return std::make_unique<FailingVolume>(noise_scene().open(), left);
    };
    const bool first = link.rank() == 0;
    mesh_in_ranks(open, first ? std::span<MeshSink* const>(sinks) : std::span<MeshSink* const>(), noise_scene().options,
                  ranks, link);
  });
  std::size_t failed = 0;
  for (const std::exception_ptr& error : errors) {
    if (!error) continue;
    EXPECT_EQ(text_of<BadInput>(error), "scan: a slice cannot be read");
    ++failed;
  }
  EXPECT_EQ(sink.finished, failed == 0);
  return failed;
}

TEST(RankErrors, AnErrorOfOneRankIsThrownByAll) {
  int at = 1;
  for (std::size_t failed = 3; failed > 0; at *= 2) {
    failed = run_failing(at, blocks_of(16));
    EXPECT_TRUE(failed == 3 || failed == 0) << failed << " of 3 ranks at reading " << at;
  }
  EXPECT_GT(at, 8);
}

// Where several ranks fail, each by itself, all throw the error that rank 0 has named.
TEST(RankErrors, SeveralErrorsBecomeOne) {
  MemorySink sink;
  MeshSink* const sinks[] = {&sink};
  const auto errors = LocalRanks(4).run([&](RankLink& link) {
    const bool first = link.rank() == 0;
    const auto open = [&]() -> std::unique_ptr<SliceSource> {
      if (!first) throw BadInput("scan of rank " + std::to_string(link.rank()) + ": cannot be opened");
      return noise_scene().open();
    };
    mesh_in_ranks(open, first ? std::span<MeshSink* const>(sinks) : std::span<MeshSink* const>(), noise_scene().options,
                  blocks_of(16), link);
  });
  const std::string named = text_of<BadInput>(errors.front());
  EXPECT_NE(named.find("cannot be opened"), std::string::npos) << named;
  for (const std::exception_ptr& error : errors) EXPECT_EQ(text_of<BadInput>(error), named);
}

TEST(RankErrors, AFileThatChangesMeanwhileEndsAllRanks) {
  const files::Folder folder;
  const auto volume = noise_scene().open();
  const auto& dims = volume->info().dims;
  std::string samples(static_cast<std::size_t>(volume->info().slice_samples() * dims[2]) * 4, '\0');
  ASSERT_EQ(volume->info().type, SampleType::kFloat32);
  volume->read(0, dims[2], std::as_writable_bytes(std::span(samples)));
  const std::string path = folder / "a.raw";
  files::write_bytes(path, samples);
  OpenOptions raw;
  raw.raw = parse_raw_layout(std::to_string(dims[0]) + "x" + std::to_string(dims[1]) + "x" + std::to_string(dims[2]) +
                             ":float32");
  std::atomic<int> opened = 0;
  BlockScene scene = noise_scene();
  scene.open = [&]() -> std::unique_ptr<SliceSource> {
    if (++opened == 8) std::filesystem::last_write_time(path, std::filesystem::file_time_type::clock::now());
    return open_volume(path, raw);
  };
  std::string refused;
  try {
    run_ranks(scene, 2, blocks_of(16), {});
  } catch (const BadInput& error) {
    refused = error.what();
  }
  EXPECT_NE(refused.find("found it changed"), std::string::npos) << refused;
}

TEST(RankErrors, ASinkThatFailsEndsAllRanks) {
  class FullDisk final : public MeshSink {
    void append(const MeshPiece&) override { throw CannotWrite("mesh.ply: no space left"); }
    void finish() override {}
  };
  FullDisk sink;
  MeshSink* const sinks[] = {&sink};
  const auto errors = LocalRanks(4).run([&](RankLink& link) {
    const bool first = link.rank() == 0;
    mesh_in_ranks(noise_scene().open, first ? std::span<MeshSink* const>(sinks) : std::span<MeshSink* const>(),
                  noise_scene().options, blocks_of(16), link);
  });
  for (const std::exception_ptr& error : errors) EXPECT_EQ(text_of<CannotWrite>(error), "mesh.ply: no space left");
}

// A run that is cut off goes on with another number of ranks, and does not do again what it has done.
TEST(RankResults, ARunGoesOnWithOtherRanks) {
  const files::Folder folder;
  RankOptions ranks = blocks_of(16);
  ranks.results = folder.path();
  EXPECT_EQ(run_failing(40, ranks), 3U);
  const std::size_t kept = folder.entries().size();
  EXPECT_GT(kept, 2U);
  expect_same(run_ranks(noise_scene(), 2, ranks, {}), run_sweep(noise_scene()));
  const std::size_t all = folder.entries().size();
  EXPECT_GT(all, kept);
  // With all results there, no sample is read.
  std::atomic<int> left = 1;
  BlockScene unread = noise_scene();
  unread.open = [&left] { return std::make_unique<FailingVolume>(noise_scene().open(), left); };
  expect_same(run_ranks(unread, 5, ranks, {}), run_sweep(noise_scene()));
  EXPECT_EQ(left, 1);
  EXPECT_EQ(folder.entries().size(), all);
  // Results of another mesh are refused.
  BlockScene coarser = noise_scene();
  coarser.options.error = Length::voxels(0.5);
  std::string refused;
  try {
    run_ranks(coarser, 2, ranks, {});
  } catch (const BadInput& error) {
    refused = error.what();
  }
  EXPECT_NE(refused.find("belongs to another mesh"), std::string::npos) << refused;
  remove_results(folder.path());
  EXPECT_TRUE(folder.entries().empty());
}

// Each block of a stage is given to one rank, and what is expected of the ranks is alike.
TEST(RankPlan, SharesTheWork) {
  const BlockScene scene = noise_scene();
  BlockOptions blocks;
  blocks.size = 8;
  const Task task = resolve_blocks(RunKind::kBlocks, *scene.open(), scene.options, blocks, {}, {0, 0, 0});
  const BlockStages stages(task, blocks);
  const TaskList tasks = stages.tasks();
  std::vector<std::uint64_t> weights;
  std::uint64_t all = 0, largest = 0;
  for (std::uint64_t n = 0; n < tasks.stages.front(); ++n) {
    weights.push_back(block_weight(scene.open, stages.grids[0].cells(stages.block(0, n), stages.all), task));
    all += weights.back();
    largest = std::max(largest, weights.back());
  }
  const std::vector<std::uint32_t> owners = plan_ranks(stages, weights, 4);
  ASSERT_EQ(owners.size(), tasks.count());
  std::vector<std::uint64_t> sums(4, 0);
  for (std::size_t n = 0; n < owners.size(); ++n) {
    ASSERT_LT(owners[n], 4U);
    if (n < weights.size()) sums[owners[n]] += weights[n];
  }
  for (const std::uint64_t sum : sums) EXPECT_LE(sum, all / 4 + largest);
}

// Takers and givers are the same pairs of blocks, and blocks that have a lattice point in common are among them.
TEST(BlockStages, TakersAndGiversBelongTogether) {
  const BlockScene scene = noise_scene();
  for (const std::int64_t first : {0, -3, 5}) {
    BlockOptions blocks;
    blocks.size = 11;
    blocks.first = {first, -first, first};
    const BlockStages stages(resolve_blocks(RunKind::kBlocks, *scene.open(), scene.options, blocks, {}, {0, 0, 0}),
                             blocks);
    const TaskList tasks = stages.tasks();
    for (std::uint64_t task = 0; task < tasks.count(); ++task) {
      for (const std::uint64_t taker : stages.takers_of(task)) {
        const auto givers = stages.givers_of(taker);
        EXPECT_NE(std::find(givers.begin(), givers.end(), task), givers.end()) << task << " to " << taker;
      }
      for (const std::uint64_t giver : stages.givers_of(task)) {
        const auto takers = stages.takers_of(giver);
        EXPECT_NE(std::find(takers.begin(), takers.end(), task), takers.end()) << giver << " to " << task;
      }
      EXPECT_EQ(stages.takers_of(task).empty(), tasks.stage_of(task) + 1 == tasks.stages.size());
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::ranks_test
