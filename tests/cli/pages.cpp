// Pages for the browser, without one: what is in them, and what is refused. viewer/test looks at them in a browser.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "page_files.hpp"
#include "program.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::cli_pages_test {
namespace {

using Json = nlohmann::json;
using pages::json_in;
using pages::occurrences;
using program::listing;
using program::Result;
using program::run;

constexpr const char* kVolume = "generate:gyroid:40x40x40:uint8";

using Words = std::vector<std::string>;

Words mesh(const Words& more, const std::string& volume = kVolume) {
  Words arguments{"mesh", volume, "--iso", "127.5", "-o", "out.ply", "--quiet"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

void expect_failure(const files::Folder& folder, const Words& arguments, int code, const std::string& says) {
  const Words before = listing(folder);
  program::expect_failed(run(folder.path(), arguments), code, says);
  EXPECT_EQ(listing(folder), before);
}

#ifndef ISOWEAVE_HAS_VIEWER

TEST(CliPage, BuildsWithoutTheViewerSaySo) {
  const files::Folder folder;
  expect_failure(folder, mesh({"--html", "out.html"}), 2, "--html: expected a build with the viewer");
  expect_failure(folder, {"view", "out.ply"}, 2, "view: expected a build with the viewer");
  expect_failure(folder, {"info", kVolume, "--isos", "--html", "out.html"}, 2,
                 "--html: expected a build with the viewer");
  expect_failure(folder, {"simplify", "a.ply", "-o", "b.ply", "--error", "1", "--html", "b.html"}, 2,
                 "--html: expected");
}

#else

void expect_done(const files::Folder& folder, const Words& arguments) {
  const Result result = run(folder.path(), arguments);
  ASSERT_EQ(result.code, 0) << result.err;
}

Json report_of(const files::Folder& folder, const std::string& name) {
  return Json::parse(files::read_bytes(folder / name));
}

using Place = std::array<std::uint16_t, 3>;
using Places = std::array<Place, 3>;

// The same triangle, whichever corner it begins with.
Places turned(Places corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

std::vector<Places> triangles_of(const pages::Surface& surface) {
  std::vector<Places> triangles;
  for (const auto& t : surface.triangles) {
    Places corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto& v = surface.vertices[t[c]];
      corners[c] = {v[0], v[1], v[2]};
    }
    triangles.push_back(turned(corners));
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Those of an OFF file, on the grid of a page's surface.
std::vector<Places> triangles_of_off(const std::string& text, const pages::Surface& grid) {
  std::istringstream in(text);
  std::string line;
  while (std::getline(in, line) && (line == "OFF" || line.starts_with("#"))) continue;
  std::size_t vertices = 0;
  std::size_t triangles = 0;
  std::istringstream(line) >> vertices >> triangles;
  std::vector<Place> places(vertices);
  for (Place& place : places) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      float value = 0;
      in >> value;
      place[axis] = static_cast<std::uint16_t>(std::round((double{value} - grid.origin[axis]) / grid.step));
    }
  }
  std::vector<Places> found(triangles);
  for (Places& corners : found) {
    std::array<std::size_t, 4> numbers{};
    for (std::size_t& number : numbers) in >> number;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = places.at(numbers[c + 1]);
    corners = turned(corners);
  }
  std::sort(found.begin(), found.end());
  return found;
}

TEST(CliPage, IsOneFileWithTheReportInIt) {
  const files::Folder folder;
  expect_done(folder, mesh({"--html", "out.html", "--report", "out.json"}));
  EXPECT_EQ(listing(folder), (Words{"out.html", "out.json", "out.ply"}));
  const std::string page = files::read_bytes(folder / "out.html");
  const Json report = report_of(folder, "out.json");
  EXPECT_EQ(json_in(page, "report"), report);
  EXPECT_EQ(page.find("%%"), page.rfind("%%")) << "a mark is left";
  EXPECT_EQ(report["page"]["check"]["digest"], report["digest"]);
  EXPECT_EQ(report["page"]["check"]["triangles"], report["triangles"]);
  EXPECT_EQ(report["page"]["notes"], Json::array());
  const std::size_t surfaces = report["page"]["surfaces"].size();
  EXPECT_EQ(occurrences(page, "<script"), surfaces + 2);
  EXPECT_EQ(occurrences(page, "</script>"), surfaces + 2);
  for (std::size_t i = 0; i < surfaces; ++i) {
    EXPECT_EQ(json_in(page, "surface-" + std::to_string(i))["triangles"], report["page"]["surfaces"][i]["triangles"]);
  }
  // Nothing is fetched: the browser is told to refuse it, and there is nothing to fetch.
  EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
  for (const std::string word : {" src=", "@import", "url(", "<link rel=\"stylesheet"}) {
    EXPECT_EQ(page.substr(0, page.find("<body")).find(word), std::string::npos) << word;
  }
}

TEST(CliPage, HoldsTheMeshAndTheSurfaceBefore) {
  const files::Folder folder;
  expect_done(folder, {"mesh", kVolume, "--iso", "127.5", "-o", "out.off", "--html", "out.html", "--quiet"});
  expect_done(folder, {"mesh", kVolume, "--iso", "127.5", "-o", "full.off", "--error", "0", "--quiet"});
  const std::string page = files::read_bytes(folder / "out.html");
  const Json names = json_in(page, "report")["page"]["surfaces"];
  ASSERT_EQ(names[0]["name"], "full");
  ASSERT_EQ(names[1]["name"], "mesh");
  for (const auto& [id, name] : {std::pair{"surface-0", "full.off"}, {"surface-1", "out.off"}}) {
    const pages::Surface surface = pages::unpacked(json_in(page, id));
    EXPECT_GT(surface.triangles.size(), 1000U);
    EXPECT_TRUE(triangles_of(surface) == triangles_of_off(files::read_bytes(folder / name), surface)) << name;
  }
}

TEST(CliPage, HoldsTheLevelsOfTheRun) {
  const files::Folder folder;
  expect_done(folder, mesh({"--lods", "0.05vox,0.2vox,0.6vox", "--html", "out.html", "--report", "out.json"}));
  expect_done(folder, {"view", "out.json", "-o", "view.html", "--quiet"});
  const Json report = report_of(folder, "out.json");
  for (const std::string name : {"out.html", "view.html"}) {
    Json surfaces = json_in(files::read_bytes(folder / name), "report")["page"]["surfaces"];
    if (name == "out.html") {
      EXPECT_EQ(surfaces[0]["name"], "full");
      surfaces.erase(0);
    }
    ASSERT_EQ(surfaces.size(), 3U) << name;
    for (std::size_t level = 0; level < 3; ++level) {
      EXPECT_EQ(surfaces[level]["name"], level < 2 ? "finer" : "mesh");
      EXPECT_EQ(surfaces[level]["level"], level);
      EXPECT_EQ(surfaces[level]["triangles"], level < 2 ? report["levels"][level]["triangles"] : report["triangles"]);
    }
  }
  expect_done(folder, mesh({"--lods", "0.05vox,0.6vox", "--html", "few.html", "--page-triangles", "4000"}));
  const Json page = json_in(files::read_bytes(folder / "few.html"), "report")["page"];
  EXPECT_NE(page["notes"].dump().find("Levels of detail with more triangles"), std::string::npos) << page["notes"];
}

TEST(CliPage, DistancesAreThoseOfCompare) {
  const files::Folder folder;
  expect_done(folder, mesh({"--html", "out.html", "--report", "out.json"}));
  expect_done(folder, {"mesh", kVolume, "--iso", "127.5", "-o", "full.ply", "--error", "0", "--quiet"});
  const Json distance = report_of(folder, "out.json")["page"]["distance"];
  const std::string samples = distance["samples"].dump();
  const Result compared = run(folder.path(), {"compare", "out.ply", "full.ply", "--samples", samples, "--json"});
  const Json expected = Json::parse(compared.out);
  for (const std::string way : {"a_to_b", "b_to_a", "both"}) EXPECT_EQ(distance["sampled"][way], expected[way]) << way;

  // What the colours are made from adds up to the same figures.
  const Json packed = json_in(files::read_bytes(folder / "out.html"), "surface-1");
  EXPECT_EQ(packed["distance"], distance["max"]);
  const pages::Surface surface = pages::unpacked(packed);
  const double unit = packed["distance"].get<double>() / 65535;
  double sum = 0;
  for (const auto& vertex : surface.vertices) sum += unit * vertex[3];
  EXPECT_EQ(distance["vertices"], surface.vertices.size());
  EXPECT_NEAR(sum / static_cast<double>(surface.vertices.size()), distance["mean"].get<double>(), unit);
  EXPECT_GT(distance["mean"].get<double>(), 10 * unit);
  std::uint64_t counted = 0;
  for (const Json& bin : distance["bins"]) counted += bin["vertices"].get<std::uint64_t>();
  EXPECT_EQ(counted, surface.vertices.size());
}

TEST(CliPage, NamesCannotEndTheScriptTheyAreIn) {
  const files::Folder folder;
  const std::string name = "a</script><script>alert(1)</script><!--.nrrd";
  std::filesystem::create_directories(std::filesystem::path(folder / name).parent_path());
  expect_done(folder, {"generate", "gyroid", "--size", "24", "--type", "uint8", "-o", name, "--quiet"});
  expect_done(folder, mesh({"--html", "out.html"}, name));
  const std::string page = files::read_bytes(folder / "out.html");
  const Json report = json_in(page, "report");
  EXPECT_EQ(report["input"]["path"], name);
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_EQ(occurrences(page, "<script"), report["page"]["surfaces"].size() + 2);
}

TEST(CliPage, LargeMeshesGetAStandInAndANote) {
  const files::Folder folder;
  expect_done(folder, mesh({"--html", "out.html", "--report", "out.json", "--page-triangles", "1500"}));
  const Json report = report_of(folder, "out.json");
  EXPECT_EQ(report["page"]["surfaces"][1]["name"], "stand-in");
  EXPECT_LE(report["page"]["surfaces"][1]["triangles"], 1500);
  EXPECT_GT(report["triangles"], 1500);
  EXPECT_EQ(report["page"]["check"]["triangles"], report["triangles"]);
  EXPECT_NE(report["page"]["notes"].dump().find("stand-in"), std::string::npos) << report["page"]["notes"];
}

// The numbers that a PLY file has for its vertices, x y z quality in binary, of `vertices` vertices.
std::vector<double> qualities_of(const std::string& ply, std::size_t vertices) {
  const std::string end = "end_header\n";
  const char* data = ply.data() + ply.find(end) + end.size();
  std::vector<double> qualities(vertices);
  for (std::size_t v = 0; v < vertices; ++v) {
    float quality = 0;
    std::memcpy(&quality, data + 16 * v + 12, sizeof(quality));
    qualities[v] = quality;
  }
  return qualities;
}

// Distances are those to the complete surface, which the page's run has in pieces only, of vertices that are far from
// it as well.
TEST(CliPage, ASurfaceTooLargeForAPageIsComparedWithAsItIs) {
  const files::Folder folder;
  const std::string volume = "generate:smooth:148x148x148:uint8";
  expect_done(
      folder,
      mesh({"--html", "out.html", "--report", "out.json", "--error", "20vox", "--page-triangles", "2000"}, volume));
  const Json report = report_of(folder, "out.json");
  ASSERT_GT(report["triangles_extracted"], 1'000'000);
  const Json& page = report["page"];
  EXPECT_EQ(page["surfaces"][0]["name"], "full");
  EXPECT_EQ(page["surfaces"][0]["triangles"], 1'000'000);
  EXPECT_EQ(page["surfaces"][1]["name"], "stand-in");
  EXPECT_NE(page["notes"].dump().find("to the surface itself"), std::string::npos) << page["notes"];

  expect_done(folder, {"mesh", volume, "--iso", "127.5", "--error", "0", "-o", "full.ply", "--quiet"});
  expect_done(folder, {"compare", "out.ply", "full.ply", "--distances", "distances.ply"});
  const std::vector<double> distances = qualities_of(files::read_bytes(folder / "distances.ply"), report["vertices"]);
  double sum = 0;
  for (const double distance : distances) sum += distance;
  const double most = *std::ranges::max_element(distances);
  EXPECT_GT(most, 0.02 * std::sqrt(3.0) * 148) << "no vertex is far from the surface";
  EXPECT_DOUBLE_EQ(page["distance"]["max"], most);
  EXPECT_DOUBLE_EQ(page["distance"]["mean"], sum / static_cast<double>(distances.size()));
  EXPECT_FALSE(page["distance"].contains("sampled"));

  // The verb `view` holds the surface: it says the same of it, and samples it as well.
  expect_done(folder,
              {"view", "out.json", "--before", "full.ply", "--page-triangles", "2000", "-o", "view.html", "--quiet"});
  const Json held = json_in(files::read_bytes(folder / "view.html"), "report")["page"];
  EXPECT_EQ(held["distance"]["bins"], page["distance"]["bins"]);
  EXPECT_LE(held["surfaces"][0]["triangles"], 1'000'000);
  EXPECT_GT(held["distance"]["sampled"]["both"]["mean"], 0);
  EXPECT_EQ(held["notes"], page["notes"]);
}

TEST(CliPage, NoiseIsShownAsCoarselyAsItCanBe) {
  const files::Folder folder;
  expect_done(folder, mesh({"--html", "out.html", "--report", "out.json", "--page-triangles", "2000"},
                           "generate:white:24x24x24:uint8"));
  const Json surfaces = report_of(folder, "out.json")["page"]["surfaces"];
  ASSERT_EQ(surfaces.size(), 2U) << surfaces;
  EXPECT_EQ(surfaces[1]["name"], "stand-in");
  EXPECT_GT(surfaces[1]["triangles"], 2000);
  // 2 % of the diagonal of the volume is the error of a collapse there; distances are up to twice that.
  const Json packed = json_in(files::read_bytes(folder / "out.html"), "surface-1");
  EXPECT_LT(packed["distance"].get<double>(), 2 * 0.02 * 24 * std::sqrt(3.0));
}

TEST(CliPage, WhatWasNotSimplifiedAndWhatIsEmptyIsSaid) {
  const files::Folder folder;
  expect_done(folder, mesh({"--error", "0", "--html", "out.html", "--report", "out.json"}));
  EXPECT_NE(report_of(folder, "out.json")["page"]["notes"].dump().find("Nothing was simplified"), std::string::npos);
  expect_done(folder,
              {"mesh", kVolume, "--iso", "300", "-o", "none.ply", "--html", "none.html", "--quiet", "--allow-empty"});
  const std::string page = files::read_bytes(folder / "none.html");
  const Json report = json_in(page, "report");
  EXPECT_EQ(report["page"]["surfaces"], Json::array());
  EXPECT_EQ(report["page"]["notes"][0], "The mesh has no triangles.");
}

TEST(CliPage, SimplifiedMeshesAreComparedWithTheirInput) {
  const files::Folder folder;
  expect_done(folder, mesh({"--error", "0"}));
  expect_done(folder, {"simplify", "out.ply", "-o", "small.ply", "--error", "0.3", "--html", "small.html", "--report",
                       "small.json", "--quiet"});
  const Json report = report_of(folder, "small.json");
  EXPECT_EQ(report["page"]["surfaces"][0]["triangles"], report["input"]["triangles"]);
  EXPECT_GT(report["page"]["distance"]["max"], 0);
  EXPECT_LT(report["page"]["distance"]["sampled"]["both"]["mean"], 0.3);
}

TEST(CliPage, ResumedRunsWriteThePageThatWasAskedFor) {
  for (int trial = 0; trial < 20; ++trial) {
    const files::Folder folder;
    program::Setup setup;
    setup.signal = SIGTERM;
    setup.ready = [&](pid_t) { return std::filesystem::exists(folder / "run/state-0"); };
    Words arguments = mesh({"--html", "out.html", "--checkpoint", "run", "--every", "5layers", "--slab", "5"},
                           testing::kSanitized ? "generate:gyroid:48x48x160:uint8" : "generate:gyroid:96x96x160:uint8");
    const Result stopped = run(folder.path(), arguments, setup);
    if (stopped.code != 130) continue;  // it was faster than the signal
    EXPECT_EQ(listing(folder), Words{"run"});
    expect_done(folder, {"mesh", "--resume", "run", "--quiet"});
    const Json report = json_in(files::read_bytes(folder / "out.html"), "report");
    EXPECT_EQ(report["page"]["check"]["digest"], report["digest"]);
    EXPECT_EQ(report["page"]["surfaces"][0]["name"], "full");
    return;
  }
  FAIL() << "no run was stopped before its end";
}

TEST(CliPage, WhatCannotBeShownIsRefusedBeforeTheRun) {
  const files::Folder folder;
  const Words start{"mesh", kVolume, "--iso", "127.5", "--html", "out.html"};
  const auto with = [&](const Words& more) {
    Words arguments = start;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  expect_failure(folder, with({"--to-stdout", "ply"}), 2, "--html: expected a mesh file that isoweave can read again");
  expect_failure(folder, with({"-o", "a.glb", "--compress"}), 2, "found '--compress'");
  expect_failure(folder, with({"-o", "a.precomputed"}), 2, "found 'a.precomputed'");
  expect_failure(folder, with({"-o", "out.html"}), 2, "different files");
  expect_failure(folder, with({"-o", "a.ply", "--report", "out.html"}), 2, "different files");
  expect_failure(folder, with({"-o", "a.ply", "--page-triangles", "0"}), 2,
                 "--page-triangles: expected a whole number");
  expect_failure(folder, mesh({"--html", "none/out.html"}), 4, "none/out.html");
  expect_failure(folder, mesh({"--html", "out.html", "--memory", "150M"}), 5, "M or more, found 150M (for --html)");
}

TEST(CliView, ShowsAMeshFile) {
  const files::Folder folder;
  expect_done(folder, mesh({}));
  expect_done(folder, {"view", "out.ply"});
  EXPECT_EQ(listing(folder), (Words{"out.ply", "out.ply.html"}));
  const Json report = json_in(files::read_bytes(folder / "out.ply.html"), "report");
  Json check = Json::parse(run(folder.path(), {"check", "out.ply", "--json"}).out);
  EXPECT_EQ(check["warnings"], Json::array());
  check.erase("warnings");
  EXPECT_EQ(report["page"]["check"], check);
  EXPECT_EQ(report["page"]["surfaces"][0]["name"], "mesh");
  EXPECT_NE(report["page"]["notes"].dump().find("--before"), std::string::npos) << report["page"]["notes"];
}

TEST(CliView, ShowsAReportAndItsMesh) {
  const files::Folder folder;
  expect_done(folder, mesh({"--report", "out.json"}));
  expect_done(folder, {"mesh", kVolume, "--iso", "127.5", "-o", "full.ply", "--error", "0", "--quiet"});
  expect_done(folder, {"view", "out.json", "--before", "full.ply", "-o", "page.html", "--quiet"});
  Json shown = json_in(files::read_bytes(folder / "page.html"), "report");
  EXPECT_EQ(shown["page"]["surfaces"][0]["name"], "full");
  EXPECT_EQ(shown["page"]["notes"], Json::array());
  EXPECT_EQ(shown["before"], "full.ply");
  shown.erase("page");
  shown.erase("before");
  EXPECT_EQ(shown, report_of(folder, "out.json"));

  // Moved together, they are still found; another mesh in the place of the right one is told.
  std::filesystem::create_directory(folder / "moved");
  for (const char* name : {"out.ply", "out.json"})
    std::filesystem::rename(folder / name, folder / (std::string("moved/") + name));
  expect_done(folder, {"view", "moved/out.json", "-o", "moved.html", "--quiet"});
  std::filesystem::rename(folder / "full.ply", folder / "moved/out.ply");
  expect_done(folder, {"view", "moved/out.json", "-o", "other.html", "--quiet"});
  const Json notes = json_in(files::read_bytes(folder / "other.html"), "report")["page"]["notes"];
  EXPECT_NE(notes.dump().find("another digest"), std::string::npos) << notes;
}

TEST(CliView, WrongFilesAreErrors) {
  const files::Folder folder;
  expect_failure(folder, {"view"}, 2, "MESH|REPORT");
  expect_failure(folder, {"view", "none.ply"}, 3, "none.ply");
  files::write_bytes(folder / "bad.json", "{\"output\": ");
  expect_failure(folder, {"view", "bad.json"}, 3, "bad.json: expected a report that names its mesh");
  for (const std::string other :
       {"{\"output\": \"gone.ply\"}", "{\"triangles\": 4}", "{\"output\": 3, \"triangles\": 4}"}) {
    files::write_bytes(folder / "bad.json", other);
    expect_failure(folder, {"view", "bad.json"}, 3, "bad.json: expected a report that names its mesh");
  }
  files::write_bytes(folder / "bad.json", "{\"output\": \"gone.ply\", \"triangles\": 4}");
  expect_failure(folder, {"view", "bad.json"}, 3, "bad.json: expected the mesh gone.ply");
  files::write_bytes(folder / "bad.ply", "ply\nformat ascii 1.0\n");
  expect_failure(folder, {"view", "bad.ply"}, 3, "bad.ply");
  expect_done(folder, mesh({}));
  expect_failure(folder, {"view", "out.ply", "-o", "out.ply"}, 2, "different files");
  expect_failure(folder, {"view", "out.ply", "-o", "none/out.html"}, 4, "none/out.html");
  expect_failure(folder, {"view", "out.ply", "--before", "none.ply"}, 3, "none.ply");
  expect_failure(folder, {"view", "out.ply", "--page-triangles", "few"}, 2, "--page-triangles");
}

// Each surface of the page is that of its file, and the figures are those of the file as well.
TEST(CliPage, HasASurfaceForEachIsoValue) {
  const files::Folder folder;
  expect_done(folder, {"mesh", kVolume, "--iso", "100,150,400", "-o", "out.off", "--html", "out.html", "--report",
                       "out.json", "--quiet", "--allow-empty"});
  const std::string page = files::read_bytes(folder / "out.html");
  const Json report = json_in(page, "report");
  EXPECT_EQ(report, report_of(folder, "out.json"));
  ASSERT_EQ(report["page"]["surfaces"].size(), 2U) << "that of 400 is empty";
  for (std::size_t n = 0; n < 3; ++n) {
    const std::string file = report["isos"][n]["output"];
    const Json check = Json::parse(run(folder.path(), {"check", file, "--json"}).out);
    for (const char* key : {"triangles", "vertices", "euler", "area", "digest"}) {
      EXPECT_EQ(report["page"]["isos"][n][key], check[key]) << file << ' ' << key;
    }
    if (n == 2) continue;
    EXPECT_EQ(report["page"]["surfaces"][n]["iso"], n);
    const pages::Surface surface = pages::unpacked(json_in(page, "surface-" + std::to_string(n)));
    EXPECT_EQ(triangles_of(surface), triangles_of_off(files::read_bytes(folder / file), surface));
  }
}

TEST(CliPage, OfSeveralIsoValuesSharesItsTriangles) {
  const files::Folder folder;
  expect_done(folder, {"mesh", kVolume, "--iso", "100,150", "-o", "out.ply", "--html", "out.html", "--report",
                       "out.json", "--quiet", "--page-triangles", "4000"});
  const Json page = report_of(folder, "out.json")["page"];
  const int sum = page["surfaces"][0]["triangles"].get<int>() + page["surfaces"][1]["triangles"].get<int>();
  EXPECT_LE(sum, 4000);
  EXPECT_GT(sum, 3000);
  EXPECT_NE(page["notes"].dump().find("stand-in"), std::string::npos);
}

TEST(CliPage, OfSeveralIsoValuesRefusesWrongUse) {
  const files::Folder folder;
  const auto isos = [](const Words& more) {
    Words words{"mesh", kVolume, "--iso", "100,150"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  expect_failure(folder, isos({"-o", "a.glb", "--one-file", "--html", "a.html"}), 2, "--html");
  expect_failure(folder, isos({"-o", "a.precomputed", "--html", "a.html"}), 2, "--html");
  expect_failure(folder, isos({"-o", "a.ply", "--html", "a_iso150.ply"}), 2, "different files");
  expect_failure(folder, isos({"-o", "a.ply", "--html", "none/a.html"}), 4, "none/a.html");
}

TEST(CliPage, OfIsoValuesOfAVolumeHoldsTheJson) {
  const files::Folder folder;
  expect_done(folder, {"info", kVolume, "--isos", "--html", "isos.html"});
  EXPECT_EQ(listing(folder), Words{"isos.html"});
  const std::string page = files::read_bytes(folder / "isos.html");
  const Json printed = Json::parse(run(folder.path(), {"info", kVolume, "--isos", "--json"}).out);
  EXPECT_EQ(json_in(page, "report"), printed);
  EXPECT_EQ(occurrences(page, "<script"), 2U);
  expect_failure(folder, {"info", kVolume, "--html", "a.html"}, 2, "--isos");
  expect_failure(folder, {"info", kVolume, "--isos", "--html", "none/a.html"}, 4, "none/a.html");
  expect_failure(folder, {"info", "isos.html", "--isos", "--html", "isos.html"}, 2, "different files");
  expect_failure(folder, {"info", kVolume, "--isos", "--html", "isos.html", "--no-clobber"}, 4, "isos.html");
  expect_failure(folder, {"info", "none.nrrd", "--isos", "--html", "a.html"}, 3, "none.nrrd");
}

#endif

}  // namespace
}  // namespace isoweave::testing::cli_pages_test
