// Blocks of any size, beginning anywhere, give the mesh of the sweep, and its counts.
// Threads: *Blocks.AnySize*/noise:*Blocks.AnySize*/whiteOpen:*Blocks.AnySize*/noiseLevels
#include "isoweave/blocks.hpp"

#include <gtest/gtest.h>

#include <random>

#include "block_scenes.hpp"
#include "files.hpp"
#include "isoweave/error.hpp"

namespace isoweave::testing::blocks_test {
namespace {

class Blocks : public ::testing::TestWithParam<BlockScene> {};

TEST_P(Blocks, AnySizeAndPlaceGivesTheMeshOfTheSweep) {
  const BlockRun expected = run_sweep(GetParam());
  const files::Folder folder;
  std::mt19937_64 random(7);
  const std::vector<std::int64_t> sizes =
      kSanitized ? std::vector<std::int64_t>{8, 17} : std::vector<std::int64_t>{8, 13, 21, 64};
  for (const std::int64_t size : sizes) {
    BlockOptions blocks;
    blocks.size = size;
    for (std::int64_t& first : blocks.first) {
      first = static_cast<std::int64_t>(random() % 200) - 100;
    }
    RunControl control;
    control.threads = 1 + static_cast<int>(random() % 3);
    constexpr std::array kSchedules{Schedule::kLocal, Schedule::kQueue, Schedule::kRounds};
    control.schedule = kSchedules[random() % 3];
    control.slab = random() % 2 == 0 ? 0 : 3;
    if (size >= 20) blocks.folder = folder.path();
    SCOPED_TRACE(::testing::Message() << "blocks of " << size << " at " << blocks.first[0] << ", " << blocks.first[1]
                                      << ", " << blocks.first[2] << ", threads " << control.threads << ", schedule "
                                      << static_cast<int>(control.schedule) << ", slab " << control.slab);
    const BlockRun found = run_into_memory(GetParam(), [&](std::span<MeshSink* const> sinks) {
      return mesh_in_blocks(GetParam().open, sinks, GetParam().options, blocks, control);
    });
    expect_same(found, expected);
    EXPECT_TRUE(folder.entries().empty());
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Blocks, ::testing::ValuesIn(block_scenes()),
                         [](const auto& one) { return one.param.name; });

TEST(BlocksOf, ManyFinalTriangles) {
  if (kSanitized) GTEST_SKIP() << "a large surface, by code that small ones go through as well";
  BlockOptions blocks;
  blocks.size = 300;
  const BlockScene scene = large_scene();
  const BlockRun found = run_into_memory(scene, [&](std::span<MeshSink* const> sinks) {
    return mesh_in_blocks(scene.open, sinks, scene.options, blocks, {.slab = 300});
  });
  EXPECT_GT(found.report.triangles, 1U << 18);
  expect_same(found, run_sweep(scene));
}

}  // namespace
}  // namespace isoweave::testing::blocks_test
