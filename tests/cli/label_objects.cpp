// mesh --labels all --one-file -o NAME.precomputed: any number of labels in one folder.
// Threads: none, processes are run
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::cli_label_objects_test {
namespace {

using nlohmann::json;
using program::listing;
using program::Result;
using program::run;
using Words = std::vector<std::string>;

constexpr int kSide = 18;  // cubes along each axis: 5,832 labels
constexpr int kCube = 4;
constexpr const char* kMap = "map_72x72x72_uint32.raw";

// Cubes of 3 x 3 x 3 samples, which lie apart; every tenth of them has one sample.
void write_map(const files::Folder& folder) {
  constexpr int kWide = kSide * kCube;
  std::vector<std::uint32_t> samples(std::size_t{kWide} * kWide * kWide);
  for (int k = 0; k < kWide; ++k) {
    for (int j = 0; j < kWide; ++j) {
      for (int i = 0; i < kWide; ++i) {
        const int cube = i / kCube + kSide * (j / kCube + kSide * (k / kCube));
        const int width = cube % 10 == 0 ? 1 : 3;
        if (i % kCube >= width || j % kCube >= width || k % kCube >= width) continue;
        samples[static_cast<std::size_t>((k * kWide + j) * kWide + i)] = 70'000U + static_cast<std::uint32_t>(cube);
      }
    }
  }
  std::string bytes(samples.size() * sizeof(std::uint32_t), '\0');
  std::memcpy(bytes.data(), samples.data(), bytes.size());
  files::write_bytes(folder / kMap, bytes);
}

Words mesh(const Words& more) {
  Words words{"mesh", kMap, "--unit", "um", "--one-file", "--compress", "-o", "out.precomputed", "--report", "r.json"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

class CliLabelObjects : public ::testing::Test {
 protected:
  void SetUp() override {
    write_map(folder_);
    const Result result = run(folder_.path(), {"mesh", kMap, "--labels", "70001", "--compress", "-o", "a.precomputed"});
    if (result.code == 4) GTEST_SKIP() << result.err;
    ASSERT_EQ(result.code, 0) << result.err;
  }

  // The bytes of the folder that a run writes. The folder is removed.
  std::string made(const Words& more) {
    const Result result = run(folder_.path(), mesh(more));
    EXPECT_EQ(result.code, 0) << result.err;
    err_ = result.err;
    EXPECT_EQ(listing(folder_ / "out.precomputed"), (Words{"0.shard", "info", "properties"}));
    std::string bytes;
    for (const char* name : {"info", "0.shard", "properties/info"}) {
      bytes += files::read_bytes(folder_ / "out.precomputed/" + name);
    }
    properties_ = json::parse(files::read_bytes(folder_ / "out.precomputed/properties/info"))["inline"];
    report_ = json::parse(files::read_bytes(folder_ / "r.json"));
    std::filesystem::remove_all(folder_ / "out.precomputed");
    return bytes;
  }

  files::Folder folder_;
  std::string err_;
  json report_, properties_;
};

TEST_F(CliLabelObjects, AreAsManyAsThereAre) {
  const std::string bytes = made({"--labels", "all"});
  EXPECT_EQ(report_.at("label_count"), 5832);
  EXPECT_EQ(report_.at("labels").size(), 0U) << "too many to be listed";
  EXPECT_EQ(properties_.at("ids").size(), 5832U);
  EXPECT_EQ(properties_.at("properties")[1].at("values")[0], 1);
  EXPECT_EQ(properties_.at("properties")[1].at("values")[1], 27);
  EXPECT_NE(err_.find("out.precomputed: 5832 labels"), std::string::npos) << err_;
  for (const std::string& size : testing::kSanitized ? Words{"33"} : Words{"20", "33"}) {
    EXPECT_TRUE(made({"--labels", "all", "--blocks", size}) == bytes) << size;
  }
}

TEST_F(CliLabelObjects, AreTheSameInASweepAndInBlocks) {
  const std::string some = made({"--labels", "70001-71500", "--threads", "1"});
  EXPECT_EQ(report_.at("labels").size(), 1500U);
  const json in_sweep = report_.at("labels");
  EXPECT_TRUE(made({"--labels", "70001-71500", "--blocks", "24"}) == some);
  EXPECT_EQ(report_.at("labels"), in_sweep);
  const Result alone =
      run(folder_.path(), {"mesh", kMap, "--unit", "um", "--labels", "70003", "-o", "b.ply", "--report", "b.json"});
  ASSERT_EQ(alone.code, 0) << alone.err;
  const json expected = json::parse(files::read_bytes(folder_ / "b.json")).at("labels")[0];
  for (const char* key : {"label", "samples", "triangles", "digest"}) {
    EXPECT_EQ(in_sweep[2].at(key), expected.at(key)) << key;
  }
}

TEST_F(CliLabelObjects, SmallOnesCanBeLeftOut) {
  made({"--labels", "all", "--min-label", "2"});
  EXPECT_EQ(report_.at("label_count"), 5248);
  EXPECT_EQ(properties_.at("ids")[0], "70001");
  program::expect_failed(run(folder_.path(), mesh({"--labels", "all", "--min-label", "100"})), 3,
                         "expected a label of 100 samples or more (--min-label), found 5832 smaller ones");
  program::expect_failed(run(folder_.path(), mesh({"--labels", "70001", "--min-label", "2"})), 2, "--labels all");
  program::expect_failed(run(folder_.path(), mesh({"--labels", "all", "--segment", "7"})), 2, "--segment");
  EXPECT_EQ(listing(folder_), (Words{"a_label70001.precomputed", kMap, "r.json"}));
}

TEST_F(CliLabelObjects, TooManyForAFileEachAreToldTheWay) {
  const Result result = run(folder_.path(), {"mesh", kMap, "--labels", "all", "-o", "out.ply"});
  program::expect_failed(result, 3, "at most 4096 labels");
  EXPECT_NE(result.err.find("--one-file --compress -o NAME.precomputed"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace isoweave::testing::cli_label_objects_test
