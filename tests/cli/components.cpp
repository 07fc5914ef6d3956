// --min-component and --largest.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_components_test {
namespace {

using Json = nlohmann::json;
using program::listing;
using program::Result;
using program::run;
using Words = std::vector<std::string>;

Words mesh(const Words& more) {
  Words arguments{"mesh", "generate:noise:28x24x32:uint8", "--iso", "127.5", "-o", "out.ply", "--report", "out.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Json report_of(const files::Folder& folder, const Words& arguments, std::string* err = nullptr) {
  const Result result = run(folder.path(), arguments);
  EXPECT_EQ(result.code, 0) << result.err;
  if (err != nullptr) *err = result.err;
  return Json::parse(files::read_bytes(folder / "out.json"));
}

TEST(CliComponents, SmallOnesAreDroppedAndCounted) {
  const files::Folder folder;
  const Json all = report_of(folder, mesh({"--error", "0"}));
  EXPECT_EQ(all.at("components_dropped"), 0);
  EXPECT_EQ(all.at("triangles_dropped"), 0);
  std::string err;
  const Json some = report_of(folder, mesh({"--min-component", "50", "--slab", "3"}), &err);
  EXPECT_NE(err.find("dropped: " + some.at("components_dropped").dump() + " components with "), std::string::npos)
      << err;
  EXPECT_GT(some.at("components_dropped"), 1);
  EXPECT_EQ(some.at("triangles_extracted"), all.at("triangles_extracted"));
  EXPECT_EQ(some.at("components").get<int>() + some.at("components_dropped").get<int>(),
            all.at("components").get<int>());
  const Json check = Json::parse(run(folder.path(), {"check", "out.ply", "--json"}).out);
  EXPECT_EQ(check.at("components"), some.at("components"));
  EXPECT_EQ(check.at("digest"), some.at("digest"));
  EXPECT_NE(files::read_bytes(folder / "out.ply").find("components of 50 triangles or more\n"), std::string::npos);
  const Json one = report_of(folder, mesh({"--largest", "--error", "0"}));
  EXPECT_EQ(one.at("components"), 1);
  EXPECT_EQ(one.at("triangles").get<int>() + one.at("triangles_dropped").get<int>(), all.at("triangles").get<int>());
  const Json ratio = report_of(folder, mesh({"--largest", "--ratio", "0.25"}));
  EXPECT_EQ(ratio.at("target").at("triangles").get<std::int64_t>(),
            std::llround(0.25 * one.at("triangles").get<double>()));
  EXPECT_EQ(report_of(folder, mesh({"--min-component", "1"})).at("components_dropped"), 0);
}

TEST(CliComponents, OfAMeshAreThoseOfItsSurface) {
  const files::Folder folder;
  for (const Words& drop : {Words{"--largest"}, Words{"--min-component", "60"}}) {
    const auto with = [&](Words arguments) {
      arguments.insert(arguments.end(), drop.begin(), drop.end());
      return report_of(folder, arguments);
    };
    const Json direct = with(mesh({"--error", "0"}));
    report_of(folder, mesh({"--error", "0"}));
    const Json kept = with({"simplify", "out.ply", "-o", "kept.ply", "--error", "0", "--report", "out.json"});
    for (const char* key : {"digest", "components", "components_dropped", "triangles_dropped", "triangles_extracted"}) {
      EXPECT_EQ(kept.at(key), direct.at(key)) << key;
    }
    EXPECT_EQ(kept.at("input").at("triangles"), direct.at("triangles_extracted"));
    EXPECT_NE(files::read_bytes(folder / "kept.ply").find("component"), std::string::npos);
    const Json ratio = with({"simplify", "out.ply", "-o", "kept.ply", "--ratio", "0.5", "--report", "out.json"});
    EXPECT_EQ(ratio.at("target").at("triangles").get<std::int64_t>(),
              std::llround(0.5 * direct.at("triangles").get<double>()));
    EXPECT_LE(ratio.at("triangles"), ratio.at("target").at("triangles"));
  }
}

TEST(CliComponents, NothingLeftIsAWarning) {
  const files::Folder folder;
  std::string err;
  const Json report = report_of(folder, mesh({"--min-component", "1000000", "--allow-empty"}), &err);
  EXPECT_EQ(report.at("triangles"), 0);
  EXPECT_NE(err.find("warning: generated noise: nothing is left"), std::string::npos) << err;
  report_of(folder, mesh({}));
  const Json simplified = report_of(folder,
                                    {"simplify", "out.ply", "-o", "none.ply", "--error", "0.5", "--min-component",
                                     "1000000", "--report", "out.json", "--allow-empty"},
                                    &err);
  EXPECT_EQ(simplified.at("triangles"), 0);
  EXPECT_NE(err.find("warning: nothing is left"), std::string::npos) << err;
}

TEST(CliComponents, NothingLeftIsRefused) {
  const files::Folder folder;
  report_of(folder, mesh({}));
  const std::string before = files::read_bytes(folder / "out.ply");
  program::expect_failed(run(folder.path(), mesh({"--min-component", "1000000"})), 3, "nothing is left: each of ");
  program::expect_failed(
      run(folder.path(), {"simplify", "out.ply", "-o", "none.ply", "--error", "0.5", "--min-component", "1000000"}), 3,
      "out.ply: nothing is left: each of ");
  EXPECT_EQ(listing(folder), (Words{"out.json", "out.ply"}));
  EXPECT_TRUE(files::read_bytes(folder / "out.ply") == before);
}

TEST(CliComponents, AForecastIsOfAll) {
  const files::Folder folder;
  const Result result = run(folder.path(), mesh({"--largest", "--dry-run"}));
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("components that --largest or --min-component drops are counted in"), std::string::npos)
      << result.out;
}

TEST(CliComponents, WrongUseIsRefused) {
  const files::Folder folder;
  const auto refused = [&](const Words& more, const std::string& says) {
    program::expect_failed(run(folder.path(), mesh(more)), 2, says);
    EXPECT_EQ(listing(folder), Words{});
  };
  for (const std::string number : {"0", "-3", "2.5", "many", ""}) {
    refused({"--min-component=" + number}, "--min-component");
  }
  refused({"--device", "cuda", "--largest"}, "--device cuda: expected a run without --largest, which takes processors");
}

}  // namespace
}  // namespace isoweave::testing::cli_components_test
