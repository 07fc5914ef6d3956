// Forecasts and caps on the command line.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "program.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::cli_memory_test {
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
  const Result result = run(folder.path(), mesh({"--closed"}));
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(std::ranges::count(result.err, '\n'), 2) << "what was predicted is in the report: " << result.err;
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

// Megabytes that a refusal names.
std::uint64_t named_cap(const Result& result) {
  EXPECT_EQ(result.code, 5) << result.err;
  std::smatch match;
  if (!std::regex_search(result.err, match, std::regex("expected --memory ([0-9]+)M or more, found"))) {
    ADD_FAILURE() << result.err;
    return 0;
  }
  return std::stoull(match[1]);
}

std::vector<std::string> joined(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void expect_named_cap(const std::string& volume, const std::string& file, const std::vector<std::string>& more) {
  SCOPED_TRACE(volume + " " + file + (more.empty() ? "" : " " + more[0]));
  const files::Folder folder;
  const auto arguments = joined({"mesh", volume, "-o", file, "--quiet", "--iso", "127.5", "--allow-empty"}, more);
  const std::uint64_t cap = named_cap(run(folder.path(), joined(arguments, {"--memory", "1M"})));
  const Result result = run(folder.path(), joined(arguments, {"--memory", std::to_string(cap) + "M"}));
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_LE(result.peak_bytes, cap * 1'000'000) << result.err;
}

TEST(CliMemory, TheCapThatIsNamedDoesAndIsKept) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  using Words = std::vector<std::string>;
  const std::vector<std::pair<std::string, Words>> cases{
      {"generate:gyroid:96x96x120:uint8", {}},
      {"generate:gyroid:96x96x120:uint8", {"--error", "1vox", "--max-distance", "0.5vox"}},
      {"generate:gyroid:96x96x120:uint8", {"--ratio", "0.15"}},
      {"generate:gyroid:128x128x64:int16", {"--normals", "quadric"}},
      {"generate:noise:128x128x128:uint8", {"--error", "0"}},
      {"generate:smooth:160x160x200:uint8", {"--lods", "0.1vox,0.5vox"}},
      {"generate:sphere:900x900x60:uint8", {"--error", "0.5vox"}},
      {"generate:sphere:400x400x60:uint8", {"--inside", "below"}},
      {"generate:white:64x64x64:uint8", {}},
      {"generate:white:80x64x64:int16", {"--triangles", "5000", "--quality", "fine"}}};
  for (const auto& [volume, more] : cases) expect_named_cap(volume, "out.ply", more);
}

// One sweep would hold all triangles until there are so few. The mesh is the same, with states or without.
TEST(CliMemory, ANumberOfTrianglesDoesWithLittle) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const files::Folder folder;
  const std::vector<std::string> mesh{
      "mesh", "generate:smooth:180x180x320:uint8", "-o", "out.ply", "--iso", "127.5", "--report", "out.json"};
  const Result share = run(folder.path(), joined(mesh, {"--ratio", "50%"}));
  ASSERT_EQ(share.code, 0) << share.err;
  const std::string digest = report(folder).at("digest");
  const auto number = report(folder).at("target").at("triangles").get<std::uint64_t>();
  const std::vector<std::string> arguments = joined(mesh, {"--triangles", std::to_string(number)});
  const Result at_once = run(folder.path(), arguments);
  ASSERT_EQ(at_once.code, 0) << at_once.err;
  EXPECT_EQ(report(folder).at("digest"), digest);
  EXPECT_LT(share.peak_bytes, 11 * at_once.peak_bytes / 10) << "a share holds hardly more than the number that it is";
  const std::uint64_t cap = named_cap(run(folder.path(), joined(arguments, {"--memory", "1M", "--blocks", "off"})));
  EXPECT_LT(3'000'000 * cap, 2 * at_once.peak_bytes);
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{{}, {"--checkpoint", "states"}}) {
    const Result counted = run(folder.path(), joined(joined(arguments, {"--memory", std::to_string(cap) + "M"}), more));
    ASSERT_EQ(counted.code, 0) << counted.err;
    EXPECT_NE(counted.err.find("too little for one sweep"), std::string::npos) << counted.err;
    EXPECT_EQ(report(folder).at("digest"), digest);
    EXPECT_LE(counted.peak_bytes, 1'000'000 * cap);
  }
}

// Volumes and options by chance, with a fixed seed.
TEST(CliMemory, TheCapThatIsNamedDoesForAnyVolumeAndOptions) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  using Words = std::vector<std::string>;
  std::mt19937 random(12);
  const auto any = [&](const auto& list) { return list[random() % std::size(list)]; };
  const Words shapes{"gyroid", "noise", "smooth", "sphere", "white", "specks"};
  const Words types{"uint8", "int16", "float32", "int64", "float64"};
  const Words files{"out.ply", "out.stl", "out.glb", "out.obj"};
  const std::vector<Words> options{{"--error", "0"},
                                   {"--error", "1vox"},
                                   {"--error", "1vox", "--quality", "fine"},
                                   {"--error", "1vox", "--max-distance", "0.5vox"},
                                   {"--triangles", "5000"},
                                   {"--ratio", "0.3"},
                                   {"--lods", "0.1vox,0.5vox"},
                                   {"--normals", "quadric"},
                                   {"--step", "2"},
                                   {"--step", "3", "--ratio", "0.1"},
                                   {"--largest"},
                                   {"--html", "page.html"}};
  const std::vector<int> sides{2, 7, 40, 64, 100, 160};
  for (int trial = 0; trial < 36; ++trial) {
    std::string volume = "generate:" + any(shapes) + ":";
    for (const char* next : {"x", "x", ":"}) volume += std::to_string(any(sides)) + next;
    const std::string file = any(files);
    expect_named_cap(volume + any(types), file, any(options));
  }
}

// The test takes 400 MB itself, and starts the program.
TEST(CliMemory, ThePeakOfTheReportIsNotThatOfTheProcessThatStartedIt) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const files::Folder folder;
  const std::vector<char> large(400'000'000, 1);
  ASSERT_EQ(large[large.size() / 2], 1);
  ASSERT_EQ(run(folder.path(),
                {"mesh", "generate:sphere:24x24x24", "-o", "out.ply", "--iso", "0", "--report", "out.json", "--quiet"})
                .code,
            0);
  const auto report = nlohmann::json::parse(files::read_bytes(folder / "out.json"));
  EXPECT_LT(report.at("memory").at("peak_bytes"), 200'000'000);
}

// Slices of 256 MB, of which none is held. Blocks do for them.
TEST(CliMemory, SlicesThatAreLargerThanTheCapAreRefusedAndNotHeld) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const files::Folder folder;
  const std::string volume = "generate:sphere:16000x16000x4:uint8";
  const Result refused = run(folder.path(), {"mesh", volume, "-o", "out.ply", "--iso", "127.5", "--error", "0",
                                             "--memory", "150M", "--blocks", "off"});
  EXPECT_GT(named_cap(refused), 900U);
  EXPECT_LE(refused.peak_bytes, 150'000'000U);
  const Result info = run(folder.path(), {"info", volume});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_LE(info.peak_bytes, 100'000'000U);
}

// What a reader must decode at once counts before it is decoded: a PNG-like band of chunks as deep as the volume.
TEST(CliMemory, WhatTheReaderHoldsIsRefusedBeforeItIsRead) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const files::Folder folder;
  const std::string zarr =
      R"({"zarr_format":2,"shape":[512,1000,1000],"chunks":[512,1000,1000],"dtype":"|u1","order":"C",)"
      R"("fill_value":0,"compressor":null,"filters":null})";
  std::filesystem::create_directory(folder / "a.zarr");
  files::write_bytes(folder / "a.zarr/.zarray", zarr);
  files::write_bytes(folder / "a.zarr/0.0.0", std::string(1000, '\0'));
  const Result refused = run(folder.path(), {"mesh", "a.zarr", "-o", "out.ply", "--iso", "1", "--memory", "200M"});
  EXPECT_GT(named_cap(refused), 512U);
  EXPECT_LE(refused.peak_bytes, 100'000'000U);
}

// 10^12 samples, none of them stored.
/// An array of 10000^3 bytes of 7, of which no chunk was written.
void write_array_without_chunks(const files::Folder& folder) {
  const std::string zarr = R"({"zarr_format":2,"shape":[10000,10000,10000],"chunks":[1,100,100],"dtype":"|u1",)"
                           R"("order":"C","fill_value":7,"compressor":null,"filters":null})";
  std::filesystem::create_directory(folder / "a.zarr");
  files::write_bytes(folder / "a.zarr/.zarray", zarr);
}

TEST(CliMemory, AnArrayWithoutChunksIsAnsweredAtOnce) {
  const files::Folder folder;
  write_array_without_chunks(folder);
  const Result info = run(folder.path(), {"info", "a.zarr", "--json"});
  ASSERT_EQ(info.code, 0) << info.err;
  EXPECT_EQ(Json::parse(info.out).at("input").at("max"), 7);
  const Result forecast = run(folder.path(), {"mesh", "a.zarr", "-o", "out.ply", "--iso", "9", "--dry-run"});
  EXPECT_EQ(forecast.code, 0) << forecast.err;
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{}, {"--largest"}, {"--checkpoint", "states"}, {"--triangles", "9"}}) {
    std::vector<std::string> arguments = {"mesh", "a.zarr", "-o", "out.ply", "--iso", "9", "--allow-empty"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result meshed = run(folder.path(), arguments);
    ASSERT_EQ(meshed.code, 0) << meshed.err;
    EXPECT_NE(meshed.err.find("the surface is empty: the samples go from 7 to 7, iso is 9"), std::string::npos)
        << meshed.err;
  }
}

TEST(CliMemory, AnArrayWithoutChunksIsAnsweredUnderACap) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const files::Folder folder;
  write_array_without_chunks(folder);
  std::vector<std::string> capped{"mesh", "a.zarr", "-o", "out.ply", "--iso", "9", "--quiet", "--memory", "100M"};
  program::expect_failed(run(folder.path(), capped), 3, "the samples go from 7 to 7, iso is 9");
  capped.insert(capped.end(), {"--blocks", "off"});
  EXPECT_GT(named_cap(run(folder.path(), capped)), 200U);
}

// The zone keeps the room of its thickest slab. Slabs that follow are thinner, which says nothing about a triangle.
TEST(CliMemory, ThinnerSlabsDoNotMakeARunOutOfACapThatIsEnough) {
  if (testing::kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
  const files::Folder folder;
  const std::vector<std::string> noise{
      "mesh", "generate:noise:96x96x200:uint8", "-o", "out.ply", "--iso", "127.5", "--open", "--report", "out.json"};
  ASSERT_EQ(run(folder.path(), noise).code, 0);
  const Json free_run = report(folder);
  for (const char* cap : {"52M", "53M"}) {
    std::vector<std::string> capped = noise;
    capped.insert(capped.end(), {"--memory", cap, "--threads", "1"});
    const Result result = run(folder.path(), capped);
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(report(folder).at("digest"), free_run.at("digest"));
    EXPECT_LT(report(folder).at("memory").at("peak_bytes"), 52'000'000) << cap;
  }
}

}  // namespace
}  // namespace isoweave::testing::cli_memory_test
