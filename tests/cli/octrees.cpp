// Levels of detail for neuroglancer in one shard, whatever way the mesh is made.
// Threads: none, processes are killed from a thread of the test's own
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::cli_octrees_test {
namespace {

using program::listing;
using program::Result;
using program::run;
using Words = std::vector<std::string>;

const Words kVolume{testing::kSanitized ? "generate:gyroid:48x44x40:uint8" : "generate:gyroid:80x72x64:uint8", "--iso",
                    "127.5", "--lods", "0,0.3vox,1vox"};
const Words kOctree{"-o", "out.precomputed", "--one-file", "--compress", "--segment", "9"};

Words joined(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words mesh(const Words& more) { return joined(joined(joined({"mesh"}, kVolume), kOctree), more); }

class CliOctrees : public ::testing::Test {
 protected:
  void SetUp() override {
    const Result result = run(folder_.path(), mesh({"--quiet"}));
    if (result.code == 4) GTEST_SKIP() << result.err;
    ASSERT_EQ(result.code, 0) << result.err;
    expected_ = bytes_in(folder_);
    ASSERT_GT(expected_.size(), 10'000U);
  }

  // All that is in the folder of the mesh.
  static std::string bytes_in(const files::Folder& folder) {
    EXPECT_EQ(listing(folder / "out.precomputed"), (Words{"0.shard", "info"}));
    return files::read_bytes(folder / "out.precomputed/info") + files::read_bytes(folder / "out.precomputed/0.shard");
  }

  std::uint64_t bytes_expected() const { return expected_.size(); }

  void expect_same(const files::Folder& folder, const std::string& way) const {
    EXPECT_TRUE(bytes_in(folder) == expected_) << way;
  }

 private:
  files::Folder folder_;
  std::string expected_;
};

TEST_F(CliOctrees, AreTheSameInSlabsAndInBlocks) {
  for (const Words& way : {Words{"--slab", "5", "--threads", "1"}, Words{"--blocks", "24"},
                           Words{"--blocks", "37", "--memory", "400M"}, Words{"--checkpoint", "run"}}) {
    const files::Folder folder;
    const Result result = run(folder.path(), mesh(joined(way, {"--quiet"})));
    ASSERT_EQ(result.code, 0) << result.err;
    expect_same(folder, way[0] + " " + way[1]);
    EXPECT_EQ(listing(folder), (Words{"out.precomputed"}));
  }
}

TEST_F(CliOctrees, AreTheSameOutOfTasks) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), joined(joined({"plan"}, kVolume), {"--blocks", "32", "-o", "tasks"})).code, 0);
  ASSERT_EQ(run(folder.path(), {"work", "tasks", "--quiet"}).code, 0);
  const Result collected = run(folder.path(), joined(joined({"collect", "tasks"}, kOctree), {"--quiet"}));
  ASSERT_EQ(collected.code, 0) << collected.err;
  expect_same(folder, "tasks");
}

// Whenever a run is killed, its folder is not there, or has everything. One that it leaves beside it has no `info`
// unless it is complete.
TEST_F(CliOctrees, AreCompleteOrAbsentWhenARunIsKilled) {
  std::mt19937 random(5);
  const auto begin = std::chrono::steady_clock::now();
  {
    const files::Folder folder;
    ASSERT_EQ(run(folder.path(), mesh({"--quiet", "--blocks", "32"})).code, 0);
  }
  const auto whole = std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() - begin);
  for (int n = 0; n < (testing::kSanitized ? 3 : 12); ++n) {
    const files::Folder folder;
    {
      const program::Running killed(folder.path(), mesh({"--quiet", "--blocks", "32"}));
      std::this_thread::sleep_for(whole * (random() % 100) / 100);
    }
    for (const std::string& name : listing(folder)) {
      if (name == "out.precomputed") {
        expect_same(folder, "killed");
      } else if (std::filesystem::exists(folder / (name + "/info"))) {
        EXPECT_EQ(listing(folder / name), (Words{"0.shard", "info"}));
      }
    }
  }
}

// The disk is full while levels wait, early and late.
TEST_F(CliOctrees, AFullDiskLeavesNothing) {
  const std::uint64_t shard = bytes_expected();
  for (const std::uint64_t limit : {std::uint64_t{20'000}, shard / 2, shard * 2}) {
    const files::Folder folder;
    program::Setup setup;
    setup.file_limit = limit;
    const Result result = run(folder.path(), mesh({"--quiet", "--blocks", "32"}), setup);
    program::expect_failed(result, 4, "out.precomputed");
    EXPECT_TRUE(listing(folder).empty());
  }
}

// 3.3 million triangles, which would take 280 MB if they were packed at once.
TEST_F(CliOctrees, TakeMemoryThatDoesNotGrowWithTheMesh) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer takes memory of its own";
  const files::Folder folder;
  const auto peak = [&](const Words& more) {
    const Words volume{"mesh", "generate:white:64x64x250:uint8", "--iso", "127.5", "--error", "0", "--normals", "none"};
    const Result result =
        run(folder.path(), joined(joined(volume, {"--slab", "4", "--threads", "1", "--quiet"}), more));
    EXPECT_EQ(result.code, 0) << result.err;
    return result.peak_bytes;
  };
  EXPECT_LT(peak({"-o", "a.precomputed", "--compress"}), peak({"-o", "a.ply"}) + 56'000'000);
}

}  // namespace
}  // namespace isoweave::testing::cli_octrees_test
