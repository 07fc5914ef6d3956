// mesh --preview and simplify --preview: the mesh, what is said of it, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_previews_test {
namespace {

using nlohmann::json;
using program::listing;
using program::Result;
using program::run;
using Words = std::vector<std::string>;

constexpr const char* kVolume = "generate:noise:40x36x32:uint8";

Words joined(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

json parsed(const files::Folder& folder, const std::string& name) {
  return json::parse(files::read_bytes(folder / name));
}

void expect_refused(const files::Folder& folder, const Words& arguments, int code, const std::string& says) {
  SCOPED_TRACE(says);
  const Words before = listing(folder);
  program::expect_failed(run(folder.path(), arguments), code, says);
  EXPECT_EQ(listing(folder), before);
}

// The file has what the report says, as `check` finds it.
void expect_told(const files::Folder& folder, const std::string& name, const json& report) {
  const json check = json::parse(run(folder.path(), {"check", name, "--json"}).out);
  for (const char* key : {"digest", "triangles", "vertices", "open_edges", "nonmanifold_edges", "nonmanifold_vertices",
                          "components", "euler"}) {
    EXPECT_EQ(report.at(key), check.at(key)) << key;
  }
  const json& preview = report.at("preview");
  EXPECT_EQ(report.at("triangles_extracted"), report.at("triangles").get<std::uint64_t>() +
                                                  preview.at("triangles_collapsed").get<std::uint64_t>() +
                                                  preview.at("triangles_repeated").get<std::uint64_t>());
  EXPECT_EQ(report.at("collapses"), 0);
}

TEST(CliPreview, OfAVolumeTellsWhatItIs) {
  const files::Folder folder;
  const Result result =
      run(folder.path(), {"mesh", kVolume, "--iso", "127.5", "--preview=4", "-o", "a.ply", "--report", "a.json"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("preview, in cells of 4 mm"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("keeps neither parts and tunnels"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("not manifold ("), std::string::npos) << result.err;
  const json report = parsed(folder, "a.json");
  expect_told(folder, "a.ply", report);
  EXPECT_EQ(report.at("preview").at("cell"), 4);
  EXPECT_GT(report.at("preview").at("plane_rms"), 0);
  EXPECT_NE(files::read_bytes(folder / "a.ply").find("comment iso 127.5 inside above closed preview, cells 4\n"),
            std::string::npos);
}

TEST(CliPreview, WritesTheSameFileForAllSlabsAndThreads) {
  const files::Folder one;
  const files::Folder other;
  for (const char* name : {"a.ply", "a.stl", "a.glb"}) {
    const Words task{"mesh", kVolume, "--iso", "auto", "--preview", "--quiet", "-o", name};
    ASSERT_EQ(run(one.path(), joined(task, {"--slab", "1", "--threads", "1"})).code, 0);
    ASSERT_EQ(run(other.path(), joined(task, {"--slab", "whole", "--threads", "3"})).code, 0);
    EXPECT_TRUE(files::read_bytes(one / name) == files::read_bytes(other / name)) << name;
  }
}

TEST(CliPreview, OfAMeshIsThatOfTheSurface) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"mesh", kVolume, "--iso", "127.5", "--error", "0", "-o", "full.ply"}).code, 0);
  const Result result =
      run(folder.path(), {"simplify", "full.ply", "--preview=4mm", "-o", "a.ply", "--report", "a.json"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("preview, in cells of 4 mm"), std::string::npos) << result.err;
  const json report = parsed(folder, "a.json");
  expect_told(folder, "a.ply", report);
  EXPECT_FALSE(report.contains("quality"));
  // Cells begin at another place than those of the volume, so counts are like its, not the same.
  ASSERT_EQ(
      run(folder.path(), {"mesh", kVolume, "--iso", "127.5", "--preview=4", "-o", "b.ply", "--report", "b.json"}).code,
      0);
  const double ratio = report.at("triangles").get<double>() / parsed(folder, "b.json").at("triangles").get<double>();
  EXPECT_NEAR(ratio, 1, 0.2);
}

TEST(CliPreview, KeepsSpacingAndSpace) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"generate", "noise", "--size", "40x36x32", "--type", "uint8", "-o", "a.raw"}).code, 0);
  const Words task{"mesh",         "a.raw",    "--raw",       "40x36x32:uint8", "--iso", "127.5",  "--spacing",
                   "0.5,0.25,0.5", "--origin", "100,200,300", "--space",        "lps",   "--quiet"};
  ASSERT_EQ(run(folder.path(), joined(task, {"--preview", "-o", "a.ply"})).code, 0);
  ASSERT_EQ(run(folder.path(), joined(task, {"--error", "0", "-o", "b.ply"})).code, 0);
  const json distance = json::parse(run(folder.path(), {"compare", "a.ply", "b.ply", "--json"}).out);
  EXPECT_LT(distance.at("a_to_b").at("max"), 2 * 0.4 * std::sqrt(3.0)) << "the diagonal of a cell of two voxels";
}

TEST(CliPreview, RefusesWhatItDoesNotHave) {
  const files::Folder folder;
  const Words task{"mesh", kVolume, "--iso", "127.5", "-o", "a.ply", "--preview"};
  const std::vector<std::pair<Words, std::string>> mesh{
      {{"--error", "1vox"}, "--error excludes --preview"},
      {{"--quality", "fine"}, "--quality excludes --preview"},
      {{"--normals", "gradient"}, "--normals excludes --preview"},
      {{"--dry-run"}, "--dry-run excludes --preview"},
      {{"--html", "a.html"}, "--html excludes --preview"},
      {{"--blocks", "32"}, "--blocks excludes --preview"},
      {{"--triangles", "100"}, "--preview: expected a run without --triangles, which takes the simplifier"},
      {{"--ratio", "10%"}, "--preview: expected a run without --ratio"},
      {{"--lods", "1vox,2vox"}, "--preview: expected a run without --lods"},
      {{"--max-distance", "1vox"}, "--preview: expected a run without --max-distance"},
      {{"--largest"}, "--preview: expected a run without --largest"},
      {{"--memory", "2G"}, "--preview: expected a run without --memory"},
      {{"--checkpoint", "states"}, "--preview: expected a run without --checkpoint"},
      {{"--color-by", "b.nrrd"}, "--preview: expected a run without --color-by"}};
  for (const auto& [words, says] : mesh) expect_refused(folder, joined(task, words), 2, says);
  expect_refused(folder, {"mesh", kVolume, "--iso", "100,150", "-o", "a.ply", "--preview"}, 2,
                 "--iso with several values: expected a run without --preview");
  for (const char* cell : {"--preview=0", "--preview=-1", "--preview=much"}) {
    expect_refused(folder, {"mesh", kVolume, "--iso", "127.5", "-o", "a.ply", cell}, 2, "--preview: expected a length");
  }
  expect_refused(folder, {"mesh", kVolume, "--iso", "127.5", "-o", "a.ply", "--preview=1e-9"}, 2,
                 "preview: expected a cell of at least");
  expect_refused(folder, {"mesh", kVolume, "--iso", "127.5", "-o", "a.ply", "--preview", "2vox"}, 2,
                 "write --preview=2vox");
}

TEST(CliPreview, OfAMeshRefusesWhatItDoesNotHave) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"mesh", kVolume, "--iso", "127.5", "--preview", "-o", "full.ply"}).code, 0);
  const Words task{"simplify", "full.ply", "-o", "a.ply", "--preview"};
  expect_refused(folder, joined(task, {"--error", "1"}), 2, "--error excludes --preview");
  expect_refused(folder, joined(task, {"--triangles", "10"}), 2, "--preview: expected a run without --triangles");
  expect_refused(folder, joined(task, {"--largest"}), 2, "--preview: expected a run without --largest");
}

TEST(CliPreview, ReplacesNothingWhereNothingIsLeft) {
  const files::Folder folder;
  files::write_bytes(folder / "a.ply", "good");
  expect_refused(folder, {"mesh", kVolume, "--iso", "127.5", "-o", "a.ply", "--preview=1000"}, 3,
                 "no triangle of the surface has corners in three cells");
  expect_refused(folder, {"mesh", kVolume, "--iso", "300", "-o", "a.ply", "--preview"}, 3, "the surface is empty");
  EXPECT_EQ(files::read_bytes(folder / "a.ply"), "good");
}

}  // namespace
}  // namespace isoweave::testing::cli_previews_test
