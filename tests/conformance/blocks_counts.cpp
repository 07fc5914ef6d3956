// Blocks give the mesh of a sweep to a number of triangles.
// Threads: *BlocksToNumber.*/noise
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "block_scenes.hpp"
#include "files.hpp"
#include "isoweave/blocks.hpp"

namespace isoweave::testing::blocks_counts_test {
namespace {

BlockRun run_blocks(const BlockScene& scene, const BlockOptions& blocks, const RunControl& control) {
  return run_into_memory(scene, [&](std::span<MeshSink* const> sinks) {
    return mesh_in_blocks(scene.open, sinks, scene.options, blocks, control);
  });
}

class BlocksToNumber : public ::testing::TestWithParam<BlockScene> {};

TEST_P(BlocksToNumber, AnySizeLimitAndShareGivesTheMeshOfTheSweep) {
  const std::uint64_t all = all_triangles(GetParam());
  const files::Folder folder;
  std::mt19937_64 random(11);
  for (const double share : kSanitized ? std::vector{0.02, 0.7} : std::vector{0.02, 0.2, 0.7, 1.5}) {
    const BlockScene scene = to_number(GetParam(), 1 + static_cast<std::uint64_t>(share * static_cast<double>(all)));
    const BlockRun expected = run_sweep(scene);
    // Errors from none to one that removes more than is asked for: then the run begins anew.
    for (const double head_start : {0.0, 0.02, 0.3, 3.0}) {
      BlockOptions blocks;
      blocks.size = std::array{8, 13, 21, 64}[random() % 4];
      for (std::int64_t& first : blocks.first) first = static_cast<std::int64_t>(random() % 200) - 100;
      if (random() % 2 == 0) blocks.folder = folder.path();
      RunControl control;
      control.threads = 1 + static_cast<int>(random() % 3);
      control.schedule = std::array{Schedule::kLocal, Schedule::kQueue, Schedule::kRounds}[random() % 3];
      control.head_start = head_start;
      SCOPED_TRACE(::testing::Message() << "blocks of " << blocks.size << ", threads " << control.threads
                                        << ", schedule " << static_cast<int>(control.schedule) << ", head start "
                                        << head_start << ", " << scene.options.triangles << " of " << all);
      const bool by_share = share <= 1 && random() % 2 == 0;
      const double part = static_cast<double>(scene.options.triangles) / static_cast<double>(all);
      expect_same_by_number(run_blocks(by_share ? to_share(scene, part) : scene, blocks, control), expected);
      EXPECT_TRUE(folder.entries().empty());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BlocksToNumber, ::testing::ValuesIn(number_scenes()),
                         [](const auto& one) { return one.param.name; });

// More is kept after the first pass than is taken together, so that passes over parts follow.
TEST(BlocksToFewTriangles, PassesOverPartsGiveTheMeshOfTheSweep) {
  BlockScene noise = noise_scene();
  noise.open = [] {
    GenerateOptions volume;
    volume.kind = "noise";
    volume.dims = kSanitized ? std::array<std::int64_t, 3>{48, 44, 60} : std::array<std::int64_t, 3>{72, 60, 80};
    return generate_volume(volume);
  };
  for (const double error : {kNoLimit, 0.1}) {
    const BlockScene scene = to_number(noise, 300, error);
    const BlockRun expected = run_sweep(scene);
    ASSERT_GT(expected.report.triangles_extracted, 60'000U);
    for (const std::int64_t size : kSanitized ? std::vector<std::int64_t>{24} : std::vector<std::int64_t>{24, 40}) {
      BlockOptions blocks;
      blocks.size = size;
      RunControl control;
      control.threads = 2;
      control.head_start = 0;
      std::uint64_t worked_on = 0;
      const BlockRun found = run_blocks(scene, blocks, control);
      for (const BlockStage& stage : found.report.blocks) worked_on += stage.triangles;
      EXPECT_GT(worked_on, found.report.triangles_extracted + found.report.triangles_extracted / 2);
      expect_same_by_number(found, expected);
    }
  }
}

// Without a head start that is known, a forecast finds one.
TEST(BlocksToFewTriangles, AForecastOfTheRunSavesPasses) {
  const BlockScene scene = to_number(noise_scene(), 2'000);
  expect_same_by_number(run_blocks(scene, {16}, {}), run_sweep(scene));
}

}  // namespace
}  // namespace isoweave::testing::blocks_counts_test
