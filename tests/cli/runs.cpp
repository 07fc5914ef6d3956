// What successful runs write and say.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_runs_test {
namespace {

using Json = nlohmann::json;
using program::listing;
using program::Result;
using program::run;

Json json_file(const std::string& path) { return Json::parse(files::read_bytes(path)); }

// Runs what must succeed, and gives what it printed.
Result succeed(const files::Folder& folder, const std::vector<std::string>& arguments) {
  const Result result = run(folder.path(), arguments);
  EXPECT_EQ(result.code, 0) << result.err;
  return result;
}

void expect_keys(const Json& json, const std::vector<std::string>& pointers) {
  for (const std::string& pointer : pointers) EXPECT_TRUE(json.contains(Json::json_pointer(pointer))) << pointer;
}

TEST(CliHelp, SaysVersionAndVerbs) {
  const files::Folder folder;
  EXPECT_EQ(succeed(folder, {"--version"}).out, "isoweave " ISOWEAVE_VERSION "\n");
  const Result help = succeed(folder, {"--help"});
  EXPECT_EQ(help.err, "");
  for (const std::string verb : {"mesh", "simplify", "info", "check", "compare", "render", "generate"}) {
    EXPECT_NE(help.out.find("\n  " + verb), std::string::npos) << verb;
    EXPECT_NE(succeed(folder, {verb, "--help"}).out.find("--help"), std::string::npos) << verb;
  }
}

TEST(CliReport, HasTheKeysThatChecksReadOn) {
  const files::Folder folder;
  succeed(folder, {"mesh", "generate:shells:32x24x40:int16:3", "-o", "out.ply", "--iso", "127.5", "--report",
                   "out.json", "--spacing", "0.5,1,2", "--slab", "4", "--threads", "2"});
  const Json report = json_file(folder / "out.json");
  expect_keys(report, {"/version",
                       "/backend",
                       "/threads",
                       "/slab",
                       "/schedule",
                       "/input/path",
                       "/input/format",
                       "/input/dims",
                       "/input/type",
                       "/input/spacing",
                       "/input/origin",
                       "/input/direction",
                       "/input/min",
                       "/input/max",
                       "/input/nan",
                       "/iso",
                       "/error",
                       "/closed",
                       "/quality",
                       "/cells_crossed",
                       "/triangles_extracted",
                       "/vertices_extracted",
                       "/collapses",
                       "/postponed",
                       "/rounds",
                       "/triangles",
                       "/vertices",
                       "/open_edges",
                       "/nonmanifold_edges",
                       "/nonmanifold_vertices",
                       "/components",
                       "/euler",
                       "/digest",
                       "/seconds/read",
                       "/seconds/extract",
                       "/seconds/simplify",
                       "/seconds/write",
                       "/seconds/total",
                       "/memory/peak_bytes",
                       "/memory/predicted_bytes",
                       "/sweep",
                       "/warnings"});
  EXPECT_EQ(report["version"], ISOWEAVE_VERSION);
  EXPECT_EQ(report["backend"], "cpu");
  EXPECT_EQ(report["threads"], 2);
  EXPECT_EQ(report["slab"], 4);
  EXPECT_EQ(report["input"]["path"], "generate:shells:32x24x40:int16:3");
  EXPECT_EQ(report["input"]["dims"], Json({32, 24, 40}));
  EXPECT_EQ(report["input"]["type"], "int16");
  EXPECT_EQ(report["input"]["spacing"], Json({0.5, 1.0, 2.0}));
  EXPECT_EQ(report["input"]["direction"].size(), 9U);
  EXPECT_EQ(report["iso"], 127.5);
  EXPECT_EQ(report["closed"], true);
  EXPECT_TRUE(report["memory"]["predicted_bytes"] > 0);
  EXPECT_EQ(report["digest"].get<std::string>().size(), 16U);
  ASSERT_GT(report["sweep"].size(), 5U);
  expect_keys(report["sweep"][0], {"/layer", "/live_triangles", "/undecided_triangles", "/final_triangles", "/bytes"});
  EXPECT_EQ(listing(folder), (std::vector<std::string>{"out.json", "out.ply"}));
}

TEST(CliReport, AgreesWithTheFileInEveryFormat) {
  const files::Folder folder;
  std::string digest;
  for (const std::string format : {"ply", "stl", "obj", "off", "glb", "vtp", "3mf"}) {
    const std::string name = "out." + format;
    succeed(folder, {"mesh", "generate:noise:32x32x32:float32", "-o", name, "--iso", "0.5", "--report", "r.json"});
    const Json report = json_file(folder / "r.json");
    const Json check = Json::parse(succeed(folder, {"check", name, "--json"}).out);
    expect_keys(check, {"/misoriented_edges", "/degenerate_triangles", "/unused_vertices", "/area", "/volume",
                        "/angles/smallest", "/angles/largest", "/angles/triangles_under_5",
                        "/angles/smallest_histogram/triangles"});
    EXPECT_FALSE(check.contains("self_intersections"));
    for (const std::string key : {"digest", "triangles", "vertices", "open_edges", "nonmanifold_edges",
                                  "nonmanifold_vertices", "components", "euler"}) {
      // A corner that two parts touch in is one vertex in a format without indices.
      if (format == "stl" && key != "digest" && key != "triangles") continue;
      EXPECT_EQ(check[key], report[key]) << name << " " << key;
    }
    EXPECT_GT(check["triangles"], 100);
    if (digest.empty()) digest = check["digest"];
    EXPECT_EQ(check["digest"], digest) << name;
  }
}

TEST(CliMesh, TheResultDoesNotDependOnHowItIsMade) {
  const files::Folder folder;
  const std::vector<std::string> common{"mesh", "generate:torus:40x40x40:uint8", "-o", "a.ply", "--iso", "127.5"};
  const auto digest = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = common;
    arguments.insert(arguments.end(), more.begin(), more.end());
    succeed(folder, arguments);
    return Json::parse(succeed(folder, {"check", "a.ply", "--json"}).out)["digest"];
  };
  const Json expected = digest({});
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--slab", "1", "--threads", "1"},
                                               {"--slab", "whole", "--schedule", "rounds"},
                                               {"--slab", "3", "--schedule", "local"},
                                               {"--slab", "7", "--schedule", "queue"},
                                               {"--slab", "999999999999", "--threads", "3", "--device", "cpu"}}) {
    EXPECT_EQ(digest(more), expected) << more[1] << " " << more[3];
  }
}

TEST(CliMesh, TheFileDoesNotDependOnThreadsAndSchedule) {
  const files::Folder folder;
  const std::vector<std::string> common{
      "mesh", "generate:torus:60x60x40:uint8", "-o", "a.ply", "--iso", "127.5", "--slab", "5"};
  const auto file = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = common;
    arguments.insert(arguments.end(), more.begin(), more.end());
    succeed(folder, arguments);
    return files::read_bytes(folder / "a.ply");
  };
  const std::string expected = file({"--threads", "1", "--schedule", "queue"});
  EXPECT_TRUE(file({"--threads", "4", "--schedule", "local"}) == expected);
  EXPECT_TRUE(file({"--threads", "2", "--schedule", "rounds"}) == expected);
}

TEST(CliMesh, AFileAndItsFormulaAgree) {
  const files::Folder folder;
  succeed(folder, {"generate", "gyroid", "-o", "g.nrrd", "--size", "20x24x28", "--type", "uint8", "--quiet"});
  succeed(folder, {"mesh", "g.nrrd", "-o", "file.ply", "--iso", "127.5"});
  succeed(folder, {"mesh", "generate:gyroid:20x24x28:uint8", "-o", "formula.ply", "--iso", "127.5"});
  EXPECT_TRUE(files::read_bytes(folder / "file.ply") == files::read_bytes(folder / "formula.ply"));
}

TEST(CliMesh, AnIsoValueOutsideTheRangeGivesAnEmptyMeshAndAWarning) {
  const files::Folder folder;
  const Result result =
      succeed(folder, {"mesh", "generate:sphere:16x16x16", "-o", "out.ply", "--iso", "1e6", "--allow-empty"});
  EXPECT_NE(result.err.find("isoweave: warning: "), std::string::npos) << result.err;
  EXPECT_EQ(Json::parse(succeed(folder, {"check", "out.ply", "--json"}).out)["triangles"], 0);
}

TEST(CliMesh, NegativeNumbersAreValuesNotOptions) {
  const files::Folder folder;
  files::write_bytes(folder / "x_4x4x4_int8.raw", std::string(32, '\xf0') + std::string(32, '\x10'));
  succeed(folder,
          {"mesh", "x_4x4x4_int8.raw", "-o", "out.ply", "--iso", "-3", "--origin", "-1,-2,-3", "--report", "r.json"});
  const Json report = json_file(folder / "r.json");
  EXPECT_EQ(report["iso"], -3);
  EXPECT_EQ(report["input"]["origin"], Json({-1.0, -2.0, -3.0}));
  EXPECT_GT(report["triangles"], 0);
}

TEST(CliMesh, NanIsOutsideAndCounted) {
  const files::Folder folder;
  std::vector<float> samples(512, std::nanf(""));
  const auto write = [&] {
    std::string bytes(samples.size() * sizeof(float), '\0');
    std::memcpy(bytes.data(), samples.data(), bytes.size());
    files::write_bytes(folder / "n_8x8x8_float32.raw", bytes);
  };
  write();
  const std::vector<std::string> arguments{"mesh",   "n_8x8x8_float32.raw", "-o", "out.ply", "--iso", "1", "--report",
                                           "r.json", "--allow-empty"};
  EXPECT_NE(succeed(folder, arguments).err.find("warning: "), std::string::npos);
  Json report = json_file(folder / "r.json");
  EXPECT_EQ(report["triangles"], 0);
  EXPECT_EQ(report["input"]["nan"], 512);
  EXPECT_TRUE(report["input"]["min"].is_null());
  const Json info = Json::parse(succeed(folder, {"info", "n_8x8x8_float32.raw", "--json"}).out);
  EXPECT_TRUE(info["input"]["max"].is_null());
  EXPECT_TRUE(info["suggested_iso"]["otsu"].is_null());
  EXPECT_NE(succeed(folder, {"info", "n_8x8x8_float32.raw"}).out.find("no finite value"), std::string::npos);

  samples[3 * 64 + 3 * 8 + 3] = 2;
  write();
  succeed(folder, arguments);
  report = json_file(folder / "r.json");
  EXPECT_EQ(report["input"]["nan"], 511);
  EXPECT_EQ(report["open_edges"], 0);
  EXPECT_GT(report["triangles"], 0);
}

TEST(CliMesh, AutomaticIsoSplitsTwoValues) {
  const files::Folder folder;
  files::write_bytes(folder / "x_4x4x4_uint8.raw", std::string(32, '\x0a') + std::string(32, '\x64'));
  const Result result =
      succeed(folder, {"mesh", "x_4x4x4_uint8.raw", "-o", "out.ply", "--iso", "auto", "--report", "r.json"});
  const double iso = json_file(folder / "r.json")["iso"];
  EXPECT_NEAR(iso, 55, 1);
  EXPECT_NE(result.err.find("isoweave: --iso 5"), std::string::npos) << result.err;
}

TEST(CliMesh, QuietIsQuiet) {
  const files::Folder folder;
  for (const std::string iso : {"1e9", "0", "auto"}) {
    const Result result = succeed(folder, {"mesh", "generate:sphere:16x16x16", "-o", "out.ply", "--iso", iso, "--quiet",
                                           "--progress", "always", "--allow-empty"});
    EXPECT_EQ(result.out + result.err, "") << iso;
  }
  EXPECT_EQ(succeed(folder, {"simplify", "out.ply", "-o", "s.ply", "--error", "1", "--quiet"}).err, "");
  EXPECT_EQ(succeed(folder, {"generate", "box", "-o", "b.mha", "--size", "8", "--quiet"}).err, "");
}

TEST(CliMesh, ProgressGoesToStandardErrorWhenAskedFor) {
  const files::Folder folder;
  const std::vector<std::string> arguments{"mesh", "generate:sphere:16x16x16", "-o", "out.ply", "--iso", "0"};
  EXPECT_EQ(succeed(folder, arguments).err.find("layer "), std::string::npos);
  std::vector<std::string> always = arguments;
  always.insert(always.end(), {"--progress", "always"});
  const Result result = succeed(folder, always);
  EXPECT_NE(result.err.find("isoweave: 100 %, finishing the output, layer "), std::string::npos) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(result.err.find('\x1b'), std::string::npos);
}

TEST(CliMesh, OpenSurfacesEndAtTheBorder) {
  const files::Folder folder;
  succeed(folder, {"mesh", "generate:gyroid:16x16x16", "-o", "out.ply", "--iso", "0", "--open", "--report", "r.json"});
  const Json report = json_file(folder / "r.json");
  EXPECT_EQ(report["closed"], false);
  EXPECT_GT(report["open_edges"], 0);
  // Findings are not failures.
  const Json check = Json::parse(succeed(folder, {"check", "out.ply", "--json"}).out);
  EXPECT_EQ(check["open_edges"], report["open_edges"]);
}

TEST(CliInfo, DescribesAVolumeInBothForms) {
  const files::Folder folder;
  succeed(folder, {"generate", "box", "-o", "b.nrrd", "--size", "8x10x12", "--type", "uint16", "--spacing", "1,2,3"});
  const Json info = Json::parse(succeed(folder, {"info", "b.nrrd", "--json"}).out);
  expect_keys(info, {"/input/path", "/input/format", "/input/dims", "/input/type", "/input/spacing", "/input/origin",
                     "/input/direction", "/input/min", "/input/max", "/input/nan", "/input/notes", "/histogram/counts",
                     "/suggested_iso/otsu"});
  EXPECT_EQ(info["input"]["format"], "nrrd");
  EXPECT_EQ(info["input"]["dims"], Json({8, 10, 12}));
  EXPECT_EQ(info["input"]["type"], "uint16");
  EXPECT_EQ(info["input"]["spacing"], Json({1.0, 2.0, 3.0}));
  EXPECT_EQ(info["histogram"]["counts"].size(), 16U);
  std::uint64_t samples = 0;
  for (const Json& count : info["histogram"]["counts"]) samples += count.get<std::uint64_t>();
  EXPECT_EQ(samples, 960U);
  const std::string text = succeed(folder, {"info", "b.nrrd"}).out;
  EXPECT_NE(text.find("8 x 10 x 12 uint16"), std::string::npos) << text;
}

TEST(CliSimplify, MakesAMeshSmallerWithinTheDistanceAsked) {
  const files::Folder folder;
  succeed(folder, {"mesh", "generate:sphere:32x32x32", "-o", "full.ply", "--iso", "0", "--error", "0"});
  succeed(folder, {"simplify", "full.ply", "-o", "small.obj", "--error", "0.1", "--report", "r.json"});
  const Json report = json_file(folder / "r.json");
  expect_keys(report, {"/input/path", "/error", "/triangles", "/triangles_extracted", "/digest", "/locked_vertices"});
  EXPECT_LT(report["triangles"].get<int>() * 3, report["triangles_extracted"].get<int>());
  EXPECT_EQ(Json::parse(succeed(folder, {"check", "small.obj", "--json"}).out)["digest"], report["digest"]);

  const Json distance = Json::parse(
      succeed(folder, {"compare", "full.ply", "small.obj", "--samples", "2000", "--voxel", "500um", "--json"}).out);
  for (const std::string way : {"/a_to_b", "/b_to_a", "/both", "/voxels/both"}) {
    expect_keys(distance, {way + "/mean", way + "/rms", way + "/max"});
  }
  EXPECT_LT(distance["both"]["mean"], 0.2);
  EXPECT_DOUBLE_EQ(distance["voxels"]["both"]["max"].get<double>(), distance["both"]["max"].get<double>() * 2);
  EXPECT_EQ(
      Json::parse(succeed(folder, {"compare", "full.ply", "full.ply", "--samples", "500", "--json"}).out)["both"]["max"]
              .get<double>() < 1e-5,
      true);
  EXPECT_NE(succeed(folder, {"compare", "full.ply", "small.obj", "--samples", "500"}).out.find("RMS"),
            std::string::npos);
}

TEST(CliCompare, WritesDistancesAsNumbersOfVertices) {
  const files::Folder folder;
  succeed(folder, {"mesh", "generate:sphere:20x20x20", "-o", "full.ply", "--iso", "0", "--error", "0"});
  succeed(folder, {"simplify", "full.ply", "-o", "small.ply", "--error", "0.1"});
  const Result result = succeed(
      folder, {"compare", "small.ply", "full.ply", "--samples", "500", "--histogram", "5", "--distances", "d.ply"});
  EXPECT_NE(result.out.find("B to A (bars"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\nmax: of 500 random points on each mesh\n"), std::string::npos) << result.out;
  const std::string header = files::read_bytes(folder / "d.ply").substr(0, 400);
  EXPECT_NE(header.find("property float quality\nelement face"), std::string::npos) << header;
  const auto digest = [&](const std::string& mesh) {
    return Json::parse(succeed(folder, {"check", mesh, "--json"}).out)["digest"];
  };
  EXPECT_EQ(digest("d.ply"), digest("small.ply"));
}

TEST(CliMesh, StopsAtANumberOfTriangles) {
  const files::Folder folder;
  const std::vector<std::string> mesh{
      "mesh", "generate:noise:24x24x40:uint8", "--iso", "127.5", "-o", "out.ply", "--report", "out.json"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), mesh.begin(), mesh.end());
    succeed(folder, more);
    return json_file(folder / "out.json");
  };
  const Json full = with({"--error", "0"});
  const Json number = with({"--triangles", "5001", "--slab", "3"});
  EXPECT_TRUE(number.at("triangles") == 5001 || number.at("triangles") == 5000);
  EXPECT_GT(number.at("error").get<double>(), 0);
  EXPECT_EQ(number.at("target").at("triangles"), 5001);
  const double ratio = 5001.2 / full.at("triangles").get<double>();
  EXPECT_EQ(with({"--ratio", std::to_string(ratio)}).at("digest"), number.at("digest"));
  // Whichever stops first.
  EXPECT_EQ(with({"--triangles", "5001", "--error", "50vox"}).at("digest"), number.at("digest"));
  EXPECT_EQ(with({"--triangles", "5", "--error", "0.05vox"}).at("digest"), with({"--error", "0.05vox"}).at("digest"));
  const Result least = succeed(folder, {"simplify", "out.ply", "-o", "least.ply", "--triangles", "1"});
  EXPECT_NE(least.err.find("no other collapse within an error of"), std::string::npos) << least.err;
  EXPECT_NE(least.err.find("to leave fewer: --largest"), std::string::npos) << least.err;
}

TEST(CliMesh, ARunToANumberOfTrianglesCanBeResumed) {
  const files::Folder folder;
  const std::vector<std::string> mesh{
      "mesh",    "generate:noise:24x24x60:uint8", "--iso", "127.5", "-o", "out.ply", "--triangles", "3000", "--report",
      "out.json"};
  succeed(folder, mesh);
  const Json expected = json_file(folder / "out.json");
  std::vector<std::string> cut = mesh;
  cut.insert(cut.end(), {"--checkpoint", "run", "--every", "2layers", "--slab", "2"});
  program::Setup setup;
  setup.signal = SIGINT;
  setup.ready = [&](pid_t) { return std::filesystem::exists(folder / "run/state-1"); };
  const Result result = run(folder.path(), cut, std::move(setup));
  if (result.code == 130) succeed(folder, {"mesh", "--resume", "run", "--report", "out.json"});
  EXPECT_EQ(json_file(folder / "out.json").at("digest"), expected.at("digest"));
}

// Two triangles that cross, and one with an angle of 2 degrees that touches nothing.
constexpr const char* kCrossing =
    "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 1 1 -1\nv 1 1 1\nv 2 1 1\nv 9 9 0\nv 9 0 0\nv 9.3 0 0\n"
    "f 1 2 3\nf 4 5 6\nf 7 8 9\n";

TEST(CliCheck, SaysAnglesAndSelfIntersections) {
  const files::Folder folder;
  files::write_bytes(folder / "a.obj", kCrossing);
  const std::string plain = succeed(folder, {"check", "a.obj"}).out;
  EXPECT_NE(plain.find("largest angle"), std::string::npos) << plain;
  EXPECT_NE(plain.find("in 33.3 %"), std::string::npos) << plain;
  EXPECT_EQ(plain.find("self-intersections"), std::string::npos) << plain;
  const std::string text = succeed(folder, {"check", "a.obj", "--self-intersections", "--threads", "2"}).out;
  EXPECT_EQ(text.find(plain), 0U) << text;
  EXPECT_NE(text.find("triangles in them                      2\n"), std::string::npos) << text;
  EXPECT_NE(text.find("pairs of triangles, numbered from 0:\n  0 1\n"), std::string::npos) << text;
}

TEST(CliCheck, JsonHasThemToo) {
  const files::Folder folder;
  files::write_bytes(folder / "a.obj", kCrossing);
  const Json check = Json::parse(succeed(folder, {"check", "a.obj", "--self-intersections", "--json"}).out);
  EXPECT_EQ(check["angles"]["triangles_under_5"], 1);
  EXPECT_NEAR(check["angles"]["smallest"].get<double>(), std::atan(0.3 / 9) * 180 / std::acos(-1), 1e-4);
  EXPECT_EQ(check["angles"]["largest"], 90);
  EXPECT_EQ(check["angles"]["smallest_histogram"]["triangles"].size(), 10U);
  EXPECT_EQ(check["self_intersections"]["pairs"], 1);
  EXPECT_EQ(check["self_intersections"]["apart"], 1);
  EXPECT_EQ(check["self_intersections"]["first"], Json::parse("[[0, 1]]"));
  files::write_bytes(folder / "empty.obj", "v 0 0 0\n");
  const Json empty = Json::parse(succeed(folder, {"check", "empty.obj", "--self-intersections", "--json"}).out);
  EXPECT_TRUE(empty["angles"]["smallest"].is_null());
  EXPECT_EQ(empty["self_intersections"]["pairs"], 0);
}

}  // namespace
}  // namespace isoweave::testing::cli_runs_test
