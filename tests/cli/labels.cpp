// mesh --labels and --smooth: a file for each label, like those of runs on masks; and what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_labels_test {
namespace {

using nlohmann::json;
using program::listing;
using program::Result;
using program::run;

constexpr const char* kMap = "map_24x22x20_uint8.raw";

// Two balls that touch, 3 and 8, and a slab of label 200 at the border.
std::string map_bytes() {
  std::string bytes;
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 22; ++j) {
      for (int i = 0; i < 24; ++i) {
        const auto is_in = [&](int x, int r) {
          return (i - x) * (i - x) + (j - 10) * (j - 10) + (k - 9) * (k - 9) < r * r;
        };
        bytes += static_cast<char>(j > 18 ? 200 : is_in(7, 7) ? 3 : is_in(16, 6) ? 8 : 0);
      }
    }
  }
  return bytes;
}

std::string mask_bytes(int label) {
  std::string bytes = map_bytes();
  for (char& sample : bytes) sample = static_cast<char>(static_cast<unsigned char>(sample) == label);
  return bytes;
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

json report_of(const files::Folder& folder, const std::vector<std::string>& arguments) {
  const Result result = run(folder.path(), joined(arguments, {"--report", "r.json"}));
  EXPECT_EQ(result.code, 0) << result.err;
  return json::parse(files::read_bytes(folder / "r.json"));
}

void expect_refused(const files::Folder& folder, const std::vector<std::string>& arguments, int code,
                    const std::string& says, const program::Setup& setup = {}) {
  SCOPED_TRACE(says);
  const std::vector<std::string> before = listing(folder);
  program::expect_failed(run(folder.path(), arguments, setup), code, says);
  EXPECT_EQ(listing(folder), before);
}

class CliLabels : public ::testing::Test {
 protected:
  CliLabels() { files::write_bytes(folder_ / kMap, map_bytes()); }

  std::vector<std::string> mesh(const std::vector<std::string>& more) const {
    return joined({"mesh", kMap, "-o", "seg.ply"}, more);
  }

  files::Folder folder_;
};

TEST_F(CliLabels, AreFilesLikeThoseOfRunsOnMasks) {
  for (const std::vector<std::string>& how : {std::vector<std::string>{},
                                              {"--smooth", "--open"},
                                              {"--smooth=2", "--error", "0"},
                                              {"--ratio", "20%"},
                                              {"--triangles", "300", "--smooth"}}) {
    const json report = report_of(folder_, mesh(joined({"--labels", "all", "--slab", "3"}, how)));
    ASSERT_EQ(report.at("labels").size(), 3U);
    std::uint64_t triangles = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const int label = std::array{3, 8, 200}.at(n);
      const json& entry = report.at("labels").at(n);
      files::write_bytes(folder_ / "mask_24x22x20_uint8.raw", mask_bytes(label));
      const json direct =
          report_of(folder_, joined({"mesh", "mask_24x22x20_uint8.raw", "-o", "mask.ply", "--iso", "0.5"}, how));
      EXPECT_EQ(entry.at("label"), label);
      const std::string name = "seg_label" + std::to_string(label) + ".ply";
      EXPECT_EQ(entry.at("output"), name);
      for (const char* key : {"error", "triangles", "vertices", "components", "euler", "open_edges", "digest",
                              "triangles_extracted", "collapses"}) {
        EXPECT_EQ(entry.at(key), direct.at(key)) << name << ' ' << key;
      }
      EXPECT_EQ(entry.value("target", json()), direct.value("target", json())) << name;
      const json check = json::parse(run(folder_.path(), {"check", name, "--json"}).out);
      EXPECT_EQ(check.at("digest"), direct.at("digest"));
      triangles += entry.at("triangles").get<std::uint64_t>();
    }
    EXPECT_EQ(report.at("triangles"), triangles);
    EXPECT_EQ(report.at("input").at("max"), 200);
    const auto has = [&](const char* option) { return std::ranges::count(how, option) > 0; };
    EXPECT_EQ(report.at("smooth"), has("--smooth") ? 4 : has("--smooth=2") ? 2 : 0);
  }
}

// The most frequent sample of each block of 2 x 2 x 2, which all end within the map; of several the first.
std::string thinned_bytes() {
  const std::string map = map_bytes();
  std::string bytes;
  for (std::size_t k = 0; k < 20; k += 2) {
    for (std::size_t j = 0; j < 22; j += 2) {
      for (std::size_t i = 0; i < 24; i += 2) {
        std::vector<char> block;
        for (std::size_t n = 0; n < 8; ++n)
          block.push_back(map[(k + n / 4) * 22 * 24 + (j + n / 2 % 2) * 24 + i + n % 2]);
        char best = block[0];
        for (const char c : block) {
          if (std::ranges::count(block, c) > std::ranges::count(block, best)) best = c;
        }
        bytes += best;
      }
    }
  }
  return bytes;
}

TEST_F(CliLabels, AreThinnedByTheMostFrequentOfEachBlock) {
  const json report = report_of(folder_, mesh({"--labels", "all", "--step", "2", "--spacing", "1,1,1"}));
  files::write_bytes(folder_ / "small_12x11x10_uint8.raw", thinned_bytes());
  const json direct = report_of(folder_, {"mesh", "small_12x11x10_uint8.raw", "-o", "small.ply", "--labels", "all",
                                          "--spacing", "2,2,2", "--origin", "0.5,0.5,0.5"});
  ASSERT_EQ(report.at("labels").size(), 3U);
  for (std::size_t n = 0; n < 3; ++n) {
    for (const char* key : {"label", "samples", "triangles", "digest"}) {
      EXPECT_EQ(report.at("labels").at(n).at(key), direct.at("labels").at(n).at(key)) << key;
    }
  }
  EXPECT_EQ(report.at("input").at("spacing"), json({2.0, 2.0, 2.0}));
  EXPECT_EQ(report.at("input").at("type"), "uint8");
}

TEST_F(CliLabels, AreToldOfAlsoWhereTheMapIsMadeSmaller) {
  const std::string hint = "--labels all";
  EXPECT_NE(run(folder_.path(), {"info", kMap, "--step", "2"}).out.find(hint), std::string::npos);
  const Result made = run(folder_.path(), {"mesh", kMap, "-o", "a.ply", "--iso", "auto", "--step", "2"});
  EXPECT_NE(made.err.find("looks like a mask or label map: " + hint), std::string::npos) << made.err;
  ASSERT_EQ(run(folder_.path(), {"generate", "smooth", "--size", "32", "--type", "uint8", "-o", "grey.nrrd"}).code, 0);
  EXPECT_EQ(run(folder_.path(), {"info", "grey.nrrd", "--step", "2"}).out.find(hint), std::string::npos);
}

TEST_F(CliLabels, OnlyThoseNamedInTheirOrder) {
  const json report = report_of(folder_, mesh({"--labels", "200,3"}));
  ASSERT_EQ(report.at("labels").size(), 2U);
  EXPECT_EQ(report.at("labels").at(0).at("label"), 200);
  EXPECT_EQ(listing(folder_), (std::vector<std::string>{kMap, "r.json", "seg_label200.ply", "seg_label3.ply"}));
}

TEST_F(CliLabels, OneThatDoesNotOccurIsRefused) {
  program::expect_failed(run(folder_.path(), mesh({"--labels", "3,77"})), 3, "label 77 does not occur");
  EXPECT_EQ(listing(folder_), (std::vector<std::string>{kMap}));
}

TEST_F(CliLabels, OneThatDoesNotOccurIsAnEmptyMeshAndAWarning) {
  const Result result = run(folder_.path(), mesh({"--labels", "3,77", "--progress", "always", "--allow-empty"}));
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.err.find("label 77 does not occur"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("layer 20 of 20"), std::string::npos) << result.err;
  const json check = json::parse(run(folder_.path(), {"check", "seg_label77.ply", "--json"}).out);
  EXPECT_EQ(check.at("triangles"), 0);
  EXPECT_EQ(run(folder_.path(), mesh({"--labels", "3", "--quiet"})).err, "");
}

TEST_F(CliLabels, ObjectsOfNeuroglancerHaveTheLabelsNumber) {
  ASSERT_EQ(run(folder_.path(), {"mesh", kMap, "-o", "seg.precomputed", "--labels", "8"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "seg_label8.precomputed/8:0"));
  ASSERT_EQ(run(folder_.path(), {"mesh", kMap, "-o", "own.precomputed", "--labels", "8", "--segment", "5"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "own_label8.precomputed/5:0"));
  expect_refused(folder_, {"mesh", kMap, "-o", "n.precomputed", "--labels=-8"}, 2,
                 "--labels: expected labels of 0 or more");
}

TEST_F(CliLabels, WrongUseIsRefused) {
  for (const std::string labels : {"", "some", "1,,2", "1,", "1.5", "1,2,1", "99999999999999999999"}) {
    expect_refused(folder_, mesh({"--labels=" + labels}), 2, "--labels");
  }
  const std::vector<std::vector<std::string>> of_the_program{
      {"--iso", "0.5"}, {"--inside", "below"}, {"--dry-run"}, {"--html", "a.html"}, {"--every", "9s"}};
  for (const std::vector<std::string>& more : of_the_program) {
    expect_refused(folder_, mesh(joined({"--labels", "all"}, more)), 2, "--labels");
  }
  expect_refused(folder_, {"mesh", kMap, "--to-stdout", "ply", "--labels", "3"}, 2, "--labels");
  expect_refused(folder_, mesh({"--labels", "3", "--report", "seg_label3.ply"}), 2, "seg_label3.ply");
  expect_refused(folder_, mesh({"--labels", "3", "--error", "much"}), 2, "much");
  expect_refused(folder_, {"mesh", kMap, "-o", "none/seg.ply", "--labels", "all"}, 4, "none/seg_label1.ply");
}

// By the library's table, with the names of both options, and before the map is looked at.
TEST_F(CliLabels, WhatTakesOneSurfaceIsRefused) {
  const std::vector<std::vector<std::string>> together{
      {"--lods", "0.1,0.2"}, {"--memory", "1G"}, {"--checkpoint", "run"},  {"--color-by", kMap},
      {"--device", "cuda"},  {"--largest"},      {"--min-component", "9"},
  };
  for (const std::vector<std::string>& more : together) {
    const std::string option = more[0] == "--device" ? "--device cuda" : more[0];
    const std::string says = "--labels: expected a run without " + option + ", which takes one surface";
    expect_refused(folder_, mesh(joined({"--labels", "all"}, more)), 2, says);
    expect_refused(folder_, joined({"mesh", "nothing.nrrd", "-o", "a.ply", "--labels", "all"}, more), 2, says);
  }
#ifdef ISOWEAVE_HAS_WATCH
  expect_refused(folder_, mesh({"--labels", "all", "--watch"}), 2,
                 "--labels: expected a run without --watch, which takes one surface");
#endif
}

// The slab is larger than a block, and the balls are not.
TEST_F(CliLabels, InBlocksAreThoseOfTheSweep) {
  for (const std::vector<std::string>& how : std::vector<std::vector<std::string>>{{}, {"--smooth"}, {"--open"}}) {
    const json sweep = report_of(folder_, joined(mesh({"--labels", "all"}), how));
    for (const char* const size : {"18", "100"}) {
      const json blocks = report_of(folder_, joined(mesh({"--labels", "all", "--blocks", size}), how));
      EXPECT_EQ(blocks.at("digest"), sweep.at("digest"));
      ASSERT_EQ(blocks.at("labels").size(), 3U);
      for (std::size_t n = 0; n < 3; ++n) {
        EXPECT_EQ(blocks["labels"][n].at("label"), sweep["labels"][n].at("label"));
        EXPECT_EQ(blocks["labels"][n].at("digest"), sweep["labels"][n].at("digest"));
        EXPECT_EQ(blocks["labels"][n].at("samples"), sweep["labels"][n].at("samples"));
      }
      EXPECT_TRUE(blocks.at("input").at("min").is_null()) << "not all samples are looked at";
    }
  }
  expect_refused(folder_, mesh({"--labels", "all", "--blocks", "7"}), 2, "--blocks");
  ASSERT_EQ(std::system(("gzip -k '" + folder_ / kMap + "'").c_str()), 0);
  expect_refused(folder_,
                 {"mesh", std::string(kMap) + ".gz", "--raw", "24x22x20:uint8", "-o", "b.ply", "--labels", "all",
                  "--blocks", "16"},
                 3, "expected a volume that can be read anywhere");
}

TEST_F(CliLabels, MapsThatAreNoneAreRefused) {
  const auto refused = [&](const std::string& volume, const std::string& says) {
    expect_refused(folder_, {"mesh", volume, "-o", "seg.ply", "--labels", "all"}, 3, says);
  };
  refused("generate:sphere:8x8x8", "expected whole numbers as labels, found ");
  files::write_bytes(folder_ / "empty_4x4x4_uint8.raw", std::string(64, '\0'));
  refused("empty_4x4x4_uint8.raw", "found none");
  std::string many;
  for (int n = 0; n < 32 * 32 * 8; ++n) many += std::string{static_cast<char>(n & 255), static_cast<char>(n >> 8)};
  files::write_bytes(folder_ / "many_32x32x8_uint16.raw", many);
  refused("many_32x32x8_uint16.raw", "--labels all expects at most 4096 labels for a file each, found 8191");
  EXPECT_EQ(run(folder_.path(), {"mesh", "many_32x32x8_uint16.raw", "-o", "s.ply", "--labels", "5000"}).code, 0);
}

TEST_F(CliLabels, AGreyImageIsRefusedUnlessOneInsists) {
  const auto mesh_grey = [](const std::string& labels) {
    return std::vector<std::string>{"mesh", "generate:noise:24x22x20:uint8", "-o", "g.ply", "--labels", labels};
  };
  expect_refused(folder_, mesh_grey("all"), 3, "--labels all expects a label map, found ");
  EXPECT_EQ(run(folder_.path(), mesh_grey("100,101")).code, 0);
  EXPECT_GT(report_of(folder_, mesh_grey("all!")).at("labels").size(), 100U);
}

// 2^63 + 5 and the id of a neuron: 64 bits, and no sign.
TEST_F(CliLabels, IdsOf64BitsAreExact) {
  const std::array<std::uint64_t, 2> ids{720575940621039145U, (std::uint64_t{1} << 63) + 5};
  std::string bytes;
  for (const char sample : map_bytes()) {
    const std::uint64_t id = sample == 3 ? ids[0] : sample == 8 ? ids[1] : 0;
    bytes.append(reinterpret_cast<const char*>(&id), sizeof id);
  }
  files::write_bytes(folder_ / "ids_24x22x20_uint64.raw", bytes);
  const std::vector<std::string> all{"mesh", "ids_24x22x20_uint64.raw", "-o", "n.precomputed", "--labels", "all"};
  const json report = report_of(folder_, all);
  const json small = report_of(folder_, mesh({"--labels", "3,8"}));
  ASSERT_EQ(report.at("labels").size(), 2U);
  for (std::size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(report.at("labels").at(n).at("label").get<std::uint64_t>(), ids.at(n));
    EXPECT_EQ(report.at("labels").at(n).at("digest"), small.at("labels").at(n).at("digest"));
    const std::string id = std::to_string(ids.at(n));
    EXPECT_TRUE(std::filesystem::exists(folder_ / ("n_label" + id + ".precomputed/" + id + ":0"))) << id;
  }
  const json info = json::parse(run(folder_.path(), {"info", "ids_24x22x20_uint64.raw", "--json"}).out);
  EXPECT_EQ(info.at("input").at("max").get<std::uint64_t>(), ids[1]);
  EXPECT_NE(run(folder_.path(), {"info", "ids_24x22x20_uint64.raw"}).out.find("0 to 9223372036854775813"),
            std::string::npos);
}

TEST_F(CliLabels, NamesAreThoseOfAFile) {
  files::write_bytes(folder_ / "lut.txt",
                     "#No. Label Name: R G B A\n0 Unknown 0 0 0 0\n3 Left-Hippocampus 220 216 20 0\n8 a/b 1 2 3 0\n");
  const json report = report_of(folder_, mesh({"--labels", "all", "--label-names", "lut.txt"}));
  const json& labels = report.at("labels");
  EXPECT_EQ(labels.at(0).at("output"), "seg_Left-Hippocampus.ply");
  EXPECT_EQ(labels.at(0).at("name"), "Left-Hippocampus");
  EXPECT_EQ(labels.at(0).at("color"), "#dcd814");
  EXPECT_EQ(labels.at(1).at("output"), "seg_a_b.ply");
  EXPECT_EQ(labels.at(2).at("output"), "seg_label200.ply");
  EXPECT_EQ(labels.at(2).at("name"), "");
  EXPECT_NE(files::read_bytes(folder_ / "seg_Left-Hippocampus.ply").find("comment name Left-Hippocampus\n"),
            std::string::npos);
  const json one = report_of(folder_, mesh({"--labels", "a/b,200", "--label-names", "lut.txt"}));
  EXPECT_EQ(one.at("labels").at(0).at("label"), 8);
  EXPECT_EQ(one.at("labels").at(0).at("digest"), labels.at(1).at("digest"));
  expect_refused(folder_, mesh({"--labels", "Amygdala", "--label-names", "lut.txt"}), 2, "found 'Amygdala'");
  expect_refused(folder_, mesh({"--labels", "3,Left-Hippocampus", "--label-names", "lut.txt"}), 2, "each label once");
  expect_refused(folder_, mesh({"--labels", "3", "--label-names", kMap}), 3, kMap);
  expect_refused(folder_, mesh({"--labels", "3", "--label-names", "none.txt"}), 3, "none.txt");
  expect_refused(folder_, mesh({"--iso", "3", "--label-names", "lut.txt"}), 2, "--label");
}

// Layer 0 holds 3 and 8, layer 1 a segment of value 3 that overlaps both, and one that is empty.
TEST_F(CliLabels, SegmentsThatOverlapAreASurfaceEach) {
  std::string samples;
  const std::string map = map_bytes();
  for (std::size_t n = 0; n < map.size(); ++n)
    samples += {map[n] == 3 || map[n] == 8 ? map[n] : '\0', map[n] != 0 ? '\3' : '\0'};
  files::write_bytes(folder_ / "a.seg.nrrd",
                     "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 2 24 22 20\nkinds: list domain domain domain\n"
                     "space dimension: 3\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
                     "encoding: raw\nSegment0_Name:=ball\nSegment0_LabelValue:=3\nSegment0_Layer:=0\n"
                     "Segment0_Color:=1 0.5 0\nSegment1_Name:=other\nSegment1_LabelValue:=8\nSegment1_Layer:=0\n"
                     "Segment2_Name:=Ball\nSegment2_LabelValue:=3\nSegment2_Layer:=1\n"
                     "Segment3_Name:=none\nSegment3_LabelValue:=4\nSegment3_Layer:=1\n\n" +
                         samples);
  const json report = report_of(folder_, {"mesh", "a.seg.nrrd", "-o", "s.ply", "--labels", "all"});
  const json& labels = report.at("labels");
  ASSERT_EQ(labels.size(), 4U);
  const json single = report_of(folder_, mesh({"--labels", "3,8"}));
  EXPECT_EQ(labels.at(0).at("output"), "s_ball_label3.ply");
  EXPECT_EQ(labels.at(0).at("color"), "#ff8000");
  EXPECT_EQ(labels.at(0).at("digest"), single.at("labels").at(0).at("digest"));
  EXPECT_EQ(labels.at(1).at("output"), "s_other.ply");
  EXPECT_EQ(labels.at(1).at("digest"), single.at("labels").at(1).at("digest"));
  EXPECT_EQ(labels.at(2).at("output"), "s_Ball_layer1_label3.ply");
  std::string any = map_bytes();
  for (char& sample : any) sample = sample != 0;
  files::write_bytes(folder_ / "any_24x22x20_uint8.raw", any);
  const json mask = report_of(folder_, {"mesh", "any_24x22x20_uint8.raw", "-o", "m.ply", "--iso", "0.5"});
  EXPECT_EQ(labels.at(2).at("digest"), mask.at("digest"));
  EXPECT_EQ(labels.at(3).at("triangles"), 0);
  EXPECT_EQ(report.at("triangles").get<int>(), labels.at(0).at("triangles").get<int>() +
                                                   labels.at(1).at("triangles").get<int>() +
                                                   labels.at(2).at("triangles").get<int>());
  const json one = report_of(folder_, {"mesh", "a.seg.nrrd", "-o", "s.ply", "--labels", "Ball"});
  ASSERT_EQ(one.at("labels").size(), 1U);
  EXPECT_EQ(one.at("labels").at(0).at("digest"), mask.at("digest"));
  const json layer = report_of(folder_, {"mesh", "a.seg.nrrd", "-o", "s.ply", "--labels", "all", "--channel", "1"});
  EXPECT_EQ(layer.at("labels").size(), 2U);
}

TEST_F(CliLabels, NothingIsLeftOfARunThatFails) {
  program::Setup small;
  small.file_limit = 2000;
  expect_refused(folder_, mesh({"--labels", "all", "--error", "0"}), 4, "seg_label", small);
  program::Setup stopped;
  stopped.signal = SIGINT;
  stopped.ready = [&](pid_t process) { return program::has_file_open_in(process, folder_); };
  expect_refused(folder_, {"mesh", "generate:smooth:64x64x2000000:uint8", "-o", "seg.ply", "--labels", "100"}, 130,
                 "interrupted", stopped);
}

TEST_F(CliLabels, APartIsWhereItIsInTheWhole) {
  const json whole = report_of(folder_, mesh({"--labels", "8", "--error", "0"}));
  const json part = report_of(folder_, mesh({"--labels", "8", "--error", "0", "--roi", "2:,1:,1:"}));
  EXPECT_EQ(part.at("labels").at(0).at("digest"), whole.at("labels").at(0).at("digest"));
}

// Files far from the origin hold an offset, which is added once.
TEST_F(CliLabels, LieWhereTheyShouldFarFromTheOrigin) {
  const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 24 22 20\nspace dimension: 3\n"
      "space directions: (0.001,0,0) (0,0.001,0) (0,0,0.001)\nspace origin: (400000,500000,600000)\nencoding: raw\n\n";
  files::write_bytes(folder_ / "far.nrrd", header + map_bytes());
  const json report = report_of(folder_, {"mesh", "far.nrrd", "-o", "f.ply", "--labels", "3"});
  const std::string file = report.at("labels").at(0).at("output");
  const json check = json::parse(run(folder_.path(), {"check", file, "--json"}).out);
  EXPECT_EQ(check.at("digest"), report.at("labels").at(0).at("digest"));
  EXPECT_NEAR(check.at("box").at("low").at(0).get<double>(), 400000, 1);
}

TEST(CliSmooth, WrongUseIsRefused) {
  const files::Folder folder;
  const auto mesh = [](const std::string& smooth) {
    return std::vector<std::string>{"mesh", "generate:sphere:8x8x8", "-o", "a.ply", "--iso", "0", smooth};
  };
  for (const char* smooth : {"--smooth=0", "--smooth=-1", "--smooth=65", "--smooth=much", "--smooth=1.5"}) {
    expect_refused(folder, mesh(smooth), 2, "--smooth");
  }
}

TEST(CliSmooth, IsReportedAndSavedWithTheTask) {
  const files::Folder folder;
  const auto mesh = [](const std::vector<std::string>& more) {
    return joined({"mesh", "generate:noise:24x24x24:uint8", "-o", "a.ply", "--iso", "127.5", "--smooth=3"}, more);
  };
  const json whole = report_of(folder, mesh({}));
  EXPECT_EQ(whole.at("iso"), 127.5);
  EXPECT_EQ(whole.at("smooth"), 3);
  EXPECT_LE(whole.at("input").at("max"), 255);
  EXPECT_GT(whole.at("input").at("max"), 127.5);
  program::Setup setup;
  setup.signal = SIGINT;
  setup.ready = [&](pid_t) { return std::filesystem::exists(folder / "run/state-1"); };
  const Result stopped = run(folder.path(),
                             {"mesh", "generate:noise:24x24x20000:uint8", "-o", "b.ply", "--iso", "127.5", "--smooth=3",
                              "--checkpoint", "run", "--every", "1layers", "--slab", "2"},
                             setup);
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  const std::string state = files::read_bytes(folder / "run/state-0");
  EXPECT_NE(state.find("\"smooth\":\"3\""), std::string::npos);
  EXPECT_NE(state.find(", smooth 3"), std::string::npos);
}

}  // namespace
}  // namespace isoweave::testing::cli_labels_test
