// Forecasts and caps on the command line.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"
#include "sanitized.hpp"

namespace isoweave {
namespace {

using program::listing;
using program::Result;
using program::run;
using Json = nlohmann::json;

std::vector<std::string> mesh(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{
      "mesh", "generate:gyroid:96x96x120:uint8", "-o", "out.ply", "--iso", "127.5", "--report", "out.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Json report(const files::Folder& folder) { return Json::parse(files::read_bytes(folder / "out.json")); }

TEST(CliMemory, ADryRunSaysWhatItWouldTakeAndDoesNothing) {
  const files::Folder folder;
  const Result result = run(folder.path(), mesh({"--dry-run"}));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const char* word : {"triangles", "output", "memory", "--memory at least", "time"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << result.out;
  }
  EXPECT_EQ(listing(folder), std::vector<std::string>{"out.json"});
  const Json forecast = report(folder).at("forecast");
  for (const char* key :
       {"triangles_extracted", "triangles", "vertices", "output_bytes", "peak_bytes", "least_bytes"}) {
    EXPECT_GT(forecast.at(key).get<std::uint64_t>(), 0U) << key;
  }
}

TEST(CliMemory, EveryRunHasWhatWasPredictedBesideWhatItTook) {
  const files::Folder folder;
  const Result result = run(folder.path(), mesh({}));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("predicted: "), std::string::npos) << result.err;
  const Json json = report(folder);
  EXPECT_EQ(json.at("memory").at("predicted_bytes"), json.at("forecast").at("peak_bytes"));
}

TEST(CliMemory, ACapIsKept) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh({"--dry-run"})).code, 0);
  const auto cap = report(folder).at("forecast").at("least_bytes").get<std::uint64_t>() + 1'000'000;
  ASSERT_EQ(run(folder.path(), mesh({"--quiet"})).code, 0);
  const std::string digest = report(folder).at("digest");
  const Result capped = run(folder.path(), mesh({"--quiet", "--memory", std::to_string(cap)}));
  ASSERT_EQ(capped.code, 0) << capped.err;
  EXPECT_EQ(report(folder).at("digest"), digest);
  EXPECT_LE(report(folder).at("memory").at("peak_bytes").get<std::uint64_t>(), cap);
}

TEST(CliMemory, TooSmallACapIsRefusedBeforeTheRun) {
  const files::Folder folder;
  const Result result = run(folder.path(), mesh({"--memory", "20M"}));
  EXPECT_EQ(result.code, 5);
  EXPECT_TRUE(program::is_one_line(result.err)) << result.err;
  EXPECT_NE(result.err.find("expected --memory "), std::string::npos) << result.err;
  EXPECT_EQ(listing(folder), std::vector<std::string>{});
}

TEST(CliMemory, AmountsThatAreNoneAreRefused) {
  const files::Folder folder;
  for (const std::string amount : {"", "x", "-1", "0", "5X", "1e30G", "M", "5 M", "nan"}) {
    const Result result = run(folder.path(), mesh({"--memory=" + amount}));
    EXPECT_EQ(result.code, 2) << amount << result.err;
    EXPECT_EQ(listing(folder), std::vector<std::string>{});
  }
  for (const std::string amount : {"500M", "0.5G", "400Mi", "500000K", "500000000", "1GB"}) {
    EXPECT_EQ(run(folder.path(), mesh({"--dry-run", "--quiet", "--memory", amount})).code, 0) << amount;
  }
}

}  // namespace
}  // namespace isoweave
