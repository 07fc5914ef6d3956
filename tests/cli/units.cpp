// Units and places of meshes: what is said of the input, and what becomes of it in the file.
#include <gtest/gtest.h>

#include <cmath>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_units_test {
namespace {

using Json = nlohmann::json;
using program::Result;
using program::run;
using Words = std::vector<std::string>;

constexpr const char* kVolume = "v_24x24x24_uint8.raw";

class CliUnits : public ::testing::Test {
 protected:
  CliUnits() {
    const Result made = run(folder_.path(), {"generate", "sphere", "--size", "24", "--type", "uint8", "-o", kVolume});
    EXPECT_EQ(made.code, 0) << made.err;
  }

  Result mesh(const std::string& name, const Words& more = {}) const {
    Words words{"mesh", kVolume, "-o", name, "--iso", "127.5", "--report", "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    return run(folder_.path(), words);
  }

  Json check(const std::string& name) const { return Json::parse(run(folder_.path(), {"check", name, "--json"}).out); }

  double width(const std::string& name) const {
    const Json box = check(name).at("box");
    return box.at("high").at(0).get<double>() - box.at("low").at(0).get<double>();
  }

  // The scale of the root of a GLB.
  double metres(const std::string& name) const {
    const std::string bytes = files::read_bytes(folder_ / name);
    const std::size_t begin = bytes.find('{');
    const Json scene = Json::parse(bytes.substr(begin, bytes.find("BIN", begin) - 4 - begin), nullptr, false);
    return scene.at("nodes").at(0).at("scale").at(0);
  }

  const files::Folder folder_;
};

TEST_F(CliUnits, NoneIsMillimetresEverywhere) {
  const Result glb = mesh("a.glb");
  ASSERT_EQ(glb.code, 0) << glb.err;
  EXPECT_NE(glb.err.find("does not say its unit: lengths are taken for it to be mm (--unit says otherwise)"),
            std::string::npos)
      << glb.err;
  EXPECT_EQ(metres("a.glb"), 0.001);
  EXPECT_EQ(mesh("a.ply").err.find("does not say its unit"), std::string::npos) << "nothing depends on it";
  ASSERT_EQ(mesh("a.precomputed").code, 0);
  ASSERT_EQ(mesh("b.precomputed", {"--unit", "mm"}).code, 0);
  EXPECT_TRUE(files::read_bytes(folder_ / "a.precomputed/1:0:0") == files::read_bytes(folder_ / "b.precomputed/1:0:0"));
  EXPECT_NE(run(folder_.path(), {"info", kVolume}).out.find("extent     24 x 24 x 24 mm"), std::string::npos);
}

TEST_F(CliUnits, OfTheInputCanBeSaid) {
  ASSERT_EQ(mesh("a.glb", {"--unit", "microns", "--error", "200nm"}).code, 0);
  EXPECT_EQ(metres("a.glb"), 1e-6);
  const Json report = Json::parse(files::read_bytes(folder_ / "r.json"));
  EXPECT_EQ(report.at("input").at("unit"), "um");
  EXPECT_EQ(report.at("error"), 0.2);
  ASSERT_EQ(mesh("c.ply", {"--unit", "cm"}).code, 0);
  EXPECT_EQ(Json::parse(files::read_bytes(folder_ / "r.json")).at("input").at("spacing"), Json({10.0, 10.0, 10.0}));
  program::expect_failed(mesh("b.ply", {"--unit", "parsec"}), 2, "unit: expected m, mm, um, nm or another length");
}

TEST_F(CliUnits, AndSizesOfTheOutput) {
  ASSERT_EQ(mesh("a.ply").code, 0);
  ASSERT_EQ(mesh("um.ply", {"--unit", "mm", "--output-unit", "um"}).code, 0);
  EXPECT_EQ(Json::parse(files::read_bytes(folder_ / "r.json")).at("digest"), check("um.ply").at("digest"));
  EXPECT_EQ(check("um.ply").at("unit"), "um");
  EXPECT_NEAR(width("um.ply"), 1000 * width("a.ply"), 1e-2);
  ASSERT_EQ(mesh("half.stl", {"--scale", "50%"}).code, 0);
  EXPECT_NEAR(width("half.stl"), width("a.ply") / 2, 1e-5);
  ASSERT_EQ(mesh("plate.stl", {"--center", "--ground"}).code, 0);
  const Json box = check("plate.stl").at("box");
  EXPECT_EQ(box.at("low").at(2), 0);
  EXPECT_NEAR(box.at("low").at(0).get<double>(), -box.at("high").at(0).get<double>(), 1e-5);
  ASSERT_EQ(run(folder_.path(), {"simplify", "a.ply", "-o", "s.ply", "--error", "1", "--ground"}).code, 0);
  EXPECT_EQ(check("s.ply").at("box").at("low").at(2), 0);
  ASSERT_EQ(mesh("l.ply", {"--lods", "0.1,0.5", "--scale", "2"}).code, 0);
  EXPECT_EQ(Json::parse(files::read_bytes(folder_ / "r.json")).at("levels").at(0).at("digest"),
            check("l_lod0.ply").at("digest"));
  files::write_bytes(folder_ / "m_4x4x4_uint8.raw", std::string(21, '\1') + std::string(43, '\0'));
  const Result labels = run(folder_.path(), {"mesh", "m_4x4x4_uint8.raw", "-o", "m.ply", "--labels", "1",
                                             "--output-unit", "um", "--report", "r.json"});
  ASSERT_EQ(labels.code, 0) << labels.err;
  EXPECT_EQ(Json::parse(files::read_bytes(folder_ / "r.json")).at("labels").at(0).at("digest"),
            check("m_label1.ply").at("digest"));
}

TEST_F(CliUnits, WrongUseIsRefused) {
  program::expect_failed(mesh("b.ply", {"--scale", "0"}), 2, "--scale: expected a number above 0");
  program::expect_failed(mesh("b.ply", {"--output-unit", "cm"}), 2, "unit: expected m, mm, um, nm or in, found 'cm'");
  program::expect_failed(mesh("b.ply", {"--center", "--lods", "0.1,0.5"}), 2, "expected one mesh");
  program::expect_failed(mesh("b.glb", {"--scale", "2", "--one-file", "--lods", "0.1,0.5"}), 2, "--one-file");
  program::expect_failed(mesh("b.ply", {"--scale", "2", "--checkpoint", "states"}), 2, "--checkpoint");
}

// The line of standard error that has these words, or nothing.
std::string line_with(const std::string& words, const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(words) != std::string::npos) return line;
  }
  return "";
}

TEST_F(CliUnits, LengthsThatDoNotFitTheVolumeAreTold) {
  const std::string large = line_with("is the unit right?", mesh("a.ply", {"--error", "1cm", "--allow-empty"}).err);
  EXPECT_EQ(
      large,
      "isoweave: warning: --error 1cm is 10 mm, and the volume is 24 x 24 x 24 mm large: more than a twentieth of "
      "its diagonal; is the unit right?");
  const std::string small = line_with("is the unit right?", mesh("a.ply", {"--unit", "um", "--lods", "0.5nm,1um"}).err);
  EXPECT_EQ(small,
            "isoweave: warning: --lods 0.5nm is 0.0005 um, and the volume is 24 x 24 x 24 um large: less than a "
            "thousandth of its voxels; is the unit right?");
  for (const Words& fit : {Words{"--error", "2mm"}, Words{"--error", "0.001mm"}, Words{"--error", "0"},
                           Words{"--error", "9vox", "--allow-empty"}, Words{"--error", "20%", "--allow-empty"}}) {
    EXPECT_EQ(line_with("is the unit right?", mesh("a.ply", fit).err), "") << fit[1];
  }
  EXPECT_NE(line_with("--max-distance 3 is 3 mm", mesh("a.ply", {"--max-distance", "3"}).err), "");
  EXPECT_NE(line_with("--preview 5 is 5 mm", mesh("a.ply", {"--preview=5"}).err), "");
  const Words plan{"plan", kVolume, "--iso", "127.5", "--blocks", "16", "--error", "1cm", "-o", "tasks"};
  EXPECT_NE(line_with("--error 1cm is 10 mm", run(folder_.path(), plan).err), "");
}

TEST_F(CliUnits, LengthsThatDoNotFitTheMeshAreTold) {
  ASSERT_EQ(mesh("a.stl").code, 0);
  const auto told = [&](const Words& more) {
    Words words{"simplify", "a.stl", "-o", "s.ply", "--allow-empty"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = run(folder_.path(), words);
    EXPECT_EQ(result.code, 0) << result.err;
    return result.err;
  };
  EXPECT_NEAR(width("a.stl"), 19.34, 0.01);
  const std::string large = told({"--error", "0.5cm"});
  EXPECT_NE(line_with("a.stl: does not say its unit: lengths are taken for it to be mm, and so it is 19.3", large), "");
  EXPECT_NE(line_with("--error 0.5cm is 5 mm, and the mesh is 19.3", large), "");
  EXPECT_NE(line_with("mm large: more than a twentieth of its diagonal; is the unit right?", large), "");
  EXPECT_NE(line_with("mm large: less than coordinates of 32 bits tell apart; is the unit", told({"--error", "1nm"})),
            "");
  EXPECT_EQ(line_with("is the unit right?", told({"--error", "10nm"})), "");
  EXPECT_EQ(line_with("is the unit right?", told({"--error", "1.5"})), "");
  EXPECT_EQ(line_with("does not say its unit", told({"--error", "0.1vox"})), "");
  EXPECT_EQ(line_with("does not say its unit", told({"--error", "0.1%"})), "");
}

TEST_F(CliUnits, PercentIsOfTheDiagonal) {
  const auto digest = [&] { return Json::parse(files::read_bytes(folder_ / "r.json")).at("digest"); };
  ASSERT_EQ(mesh("a.ply", {"--error", "1%"}).code, 0);
  const Json report = Json::parse(files::read_bytes(folder_ / "r.json"));
  const double diagonal = 24 * std::sqrt(3.0);
  EXPECT_NEAR(report.at("error").get<double>(), diagonal / 100, 1e-12);
  std::ostringstream number;
  number << std::setprecision(17) << diagonal / 100;
  ASSERT_EQ(mesh("b.ply", {"--error", number.str()}).code, 0);
  EXPECT_EQ(digest(), report.at("digest"));
  ASSERT_EQ(mesh("c.ply", {"--spacing", "2,2,2", "--lods", "0.5%,1%", "--max-distance", "5%"}).code, 0);
  EXPECT_NEAR(Json::parse(files::read_bytes(folder_ / "r.json")).at("levels").at(0).at("error").get<double>(),
              diagonal / 100, 1e-12);
  ASSERT_EQ(mesh("look.ply", {"--preview=5%"}).code, 0);
  EXPECT_NEAR(Json::parse(files::read_bytes(folder_ / "r.json")).at("preview").at("cell").get<double>(), diagonal / 20,
              1e-9);
  const Json box = check("b.ply").at("box");
  double squared = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double side = box.at("high").at(axis).get<double>() - box.at("low").at(axis).get<double>();
    squared += side * side;
  }
  ASSERT_EQ(run(folder_.path(), {"simplify", "b.ply", "-o", "s.ply", "--error", "1%", "--report", "r.json"}).code, 0);
  EXPECT_NEAR(Json::parse(files::read_bytes(folder_ / "r.json")).at("error").get<double>(), std::sqrt(squared) / 100,
              1e-6);
  program::expect_failed(mesh("d.ply", {"--error", "%"}), 2, "--error: expected a length");
  program::expect_failed(mesh("d.ply", {"--error", "-1%"}), 2, "--error: expected a length");
}

}  // namespace
}  // namespace isoweave::testing::cli_units_test
