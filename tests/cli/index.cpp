// isoweave index, and what mesh and info make of it.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_index_test {
namespace {

using Json = nlohmann::json;
using program::expect_failed;
using program::Result;
using program::run;

constexpr const char* kVolume = "ball_400x400x60_uint8.raw";
constexpr const char* kIndex = "ball_400x400x60_uint8.raw.minmax";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

class IndexVerb : public ::testing::Test {
 protected:
  IndexVerb() {
    const Result made =
        run(folder_.path(), {"generate", "sphere", "-o", kVolume, "--size", "400x400x60", "--type", "uint8"});
    EXPECT_EQ(made.code, 0) << made.err;
  }

  void make_index() const {
    const Result made = run(folder_.path(), {"index", kVolume});
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(contains(made.err, kIndex)) << made.err;
  }

  static std::vector<std::string> mesh(const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"mesh", kVolume, "-o", "m.ply", "--iso", "127.5", "--report", "r.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  Json report(const std::vector<std::string>& more = {}) const {
    const Result result = run(folder_.path(), mesh(more));
    EXPECT_EQ(result.code, 0) << result.err;
    err_ = result.err;
    return Json::parse(files::read_bytes(folder_ / "r.json"));
  }

  files::Folder folder_;
  mutable std::string err_;  // of the last report
};

TEST_F(IndexVerb, ARunFindsTheIndexAndSaysSo) {
  const Json plain = report();
  EXPECT_FALSE(plain.contains("index"));
  make_index();
  const Json with = report();
  EXPECT_EQ(with["digest"], plain["digest"]);
  EXPECT_EQ(with["input"], plain["input"]);
  EXPECT_GT(with["index"]["bytes_left_out"], 0);
  EXPECT_EQ(with["index"]["path"], kIndex);
  EXPECT_TRUE(contains(err_, "by its index " + std::string(kIndex))) << err_;
  EXPECT_FALSE(report({"--index", "off"}).contains("index"));
  EXPECT_EQ(report({"--largest"})["digest"], plain["digest"]);
}

TEST_F(IndexVerb, AnIndexMayLieElsewhere) {
  const Result made = run(folder_.path(), {"index", kVolume, "-o", "i", "--quiet"});
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(made.err, "");
  EXPECT_FALSE(report().contains("index"));
  EXPECT_EQ(report({"--index", "i"})["index"]["path"], "i");
}

TEST_F(IndexVerb, ALockedFolderHasItInTheCache) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const files::Folder cache;
  ::setenv("XDG_CACHE_HOME", cache.path().c_str(), 1);
  std::filesystem::permissions(folder_.path(), std::filesystem::perms::owner_write,
                               std::filesystem::perm_options::remove);
  const Result made = run(folder_.path(), {"index", kVolume});
  std::filesystem::permissions(folder_.path(), std::filesystem::perms::owner_write, std::filesystem::perm_options::add);
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(contains(made.err, cache.path() + "/isoweave/ball_400x400x60_uint8.raw-")) << made.err;
  EXPECT_TRUE(contains(report()["index"]["path"], cache.path()));
  ::unsetenv("XDG_CACHE_HOME");
}

TEST_F(IndexVerb, AStaleIndexIsRefused) {
  make_index();
  const Json before = report();
  std::string samples = files::read_bytes(folder_ / kVolume);
  for (std::size_t n = 0; n < samples.size() / 4; ++n) samples[n] = '\xff';
  files::write_bytes(folder_ / kVolume, samples);
  expect_failed(run(folder_.path(), mesh({"--index", kIndex, "--quiet"})), 3, "expected the index of");
  const Json after = report();
  EXPECT_FALSE(after.contains("index"));
  EXPECT_TRUE(contains(err_, "warning: " + std::string(kIndex) + ": expected the index of")) << err_;
  EXPECT_NE(after["digest"], before["digest"]);
}

TEST_F(IndexVerb, PartsAndLabelsRefuseIt) {
  make_index();
  const std::vector<std::string> index{"--index", kIndex};
  expect_failed(run(folder_.path(), mesh({"--index", kIndex, "--roi", ":,:,:20"})), 2, "--index");
  expect_failed(run(folder_.path(), {"index", kVolume, "--step", "2"}), 2, "a whole volume");
  expect_failed(run(folder_.path(), {"mesh", kVolume, "-o", "m.ply", "--labels", "1", "--index", kIndex}), 2,
                "--index");
  expect_failed(run(folder_.path(), {"index", "generate:sphere:20x20x20"}), 3, "expected a volume in files");
  program::Setup redirected;
  redirected.in_path = folder_ / kVolume;
  expect_failed(run(folder_.path(), {"index", "-", "--raw", "400x400x60:uint8"}, redirected), 3,
                "expected a volume in files");
  EXPECT_FALSE(report({"--roi", ":,:,:20"}).contains("index"));
}

TEST_F(IndexVerb, InfoTellsTheSizesOfSurfaces) {
  const Result text = run(folder_.path(), {"info", kVolume, "--isos"});
  EXPECT_EQ(text.code, 0) << text.err;
  EXPECT_TRUE(contains(text.out, "iso ")) << text.out;
  const Result json = run(folder_.path(), {"info", kVolume, "--isos", "--json"});
  const Json isos = Json::parse(json.out)["isos"];
  const Json mesh = report({"--error", "0"});
  const auto at = static_cast<std::size_t>((128 - isos["first"].get<double>()) / isos["step"].get<double>());
  EXPECT_EQ(isos["vertices"].at(at), mesh["vertices_extracted"]);
}

}  // namespace
}  // namespace isoweave::testing::cli_index_test
