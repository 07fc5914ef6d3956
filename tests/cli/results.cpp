// Results that cannot mislead: empty surfaces, files that are kept, the border alone, what stopped a run, and what a
// volume is.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_results_test {
namespace {

using Json = nlohmann::json;
using program::listing;
using program::Result;
using program::run;
using Words = std::vector<std::string>;

constexpr const char* kVolume = "ramp_8x8x8_uint8.raw";

// Samples from 0 to 130 along x, as the skull has air and bone.
void write_ramp(const files::Folder& folder) {
  std::string samples;
  for (int n = 0; n < 8 * 8 * 8; ++n) samples += static_cast<char>(n % 8 == 7 ? 130 : n % 8 * 18);
  files::write_bytes(folder / kVolume, samples);
}

Words mesh(const std::string& iso, const Words& more = {}) {
  Words words{"mesh", kVolume, "-o", "a.ply", "--iso", iso};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(CliEmptySurface, IsAnErrorAndReplacesNothing) {
  const files::Folder folder;
  write_ramp(folder);
  ASSERT_EQ(run(folder.path(), mesh("60")).code, 0);
  const std::string before = files::read_bytes(folder / "a.ply");
  program::expect_failed(run(folder.path(), mesh("300")), 3,
                         "the samples go from 0 to 130, iso is 300: try --iso auto (--allow-empty writes");
  EXPECT_TRUE(files::read_bytes(folder / "a.ply") == before);
  program::expect_failed(run(folder.path(), mesh("300", {"--checkpoint", "states", "--every", "1layers"})), 3, "empty");
  EXPECT_FALSE(std::filesystem::exists(folder / "states"));
  EXPECT_EQ(run(folder.path(), mesh("60", {"--checkpoint", "states"})).code, 0) << "nothing is left to be resumed";
  const Result allowed = run(folder.path(), mesh("300", {"--allow-empty"}));
  EXPECT_EQ(allowed.code, 0) << allowed.err;
  EXPECT_EQ(Json::parse(run(folder.path(), {"check", "a.ply", "--json"}).out).at("triangles"), 0);
}

TEST(CliNoClobber, KeepsWhatIsThere) {
  const files::Folder folder;
  write_ramp(folder);
  ASSERT_EQ(run(folder.path(), mesh("60", {"--report", "r.json", "--no-clobber"})).code, 0);
  const auto kept = [&](const Words& words, const std::string& name) {
    program::expect_failed(run(folder.path(), words), 4, name + ": exists, and --no-clobber keeps it");
  };
  kept(mesh("30", {"--no-clobber"}), "a.ply");
  kept({"mesh", kVolume, "-o", "b.ply", "--iso", "30", "--report", "r.json", "--no-clobber"}, "r.json");
  kept({"simplify", "a.ply", "-o", "r.json", "--error", "1", "--no-clobber"}, "r.json");
  kept({"generate", "sphere", "--size", "8", "-o", "a.ply", "--no-clobber"}, "a.ply");
  kept({"compare", "a.ply", "a.ply", "--distances", "r.json", "--no-clobber"}, "r.json");
  kept({"render", "a.ply", "-o", "r.json", "--no-clobber"}, "r.json");
  files::write_bytes(folder / "l_label1.ply", "kept");
  kept({"mesh", kVolume, "-o", "l.ply", "--labels", "18,1", "--no-clobber", "--allow-empty"}, "l_label1.ply");
  EXPECT_EQ(files::read_bytes(folder / "l_label1.ply"), "kept");
  EXPECT_EQ(listing(folder), (Words{"a.ply", "l_label1.ply", "r.json", kVolume}));
}

TEST(CliBorder, OfTheVolumeAloneIsAWarning) {
  const files::Folder folder;
  write_ramp(folder);
  const Result result = run(folder.path(), mesh("-40"));
  EXPECT_EQ(result.code, 0);
  EXPECT_NE(result.err.find("warning: " + std::string(kVolume) + ": the surface is nothing but the border"),
            std::string::npos)
      << result.err;
}

TEST(CliBorder, IsToldWhereMuchOfTheSurfaceIsCaps) {
  const files::Folder folder;
  const auto told = [&](const std::string& volume, const Words& more) {
    Words words{"mesh", volume, "--iso", "0", "-o", "a.ply", "--report", "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    const Result result = run(folder.path(), words);
    EXPECT_EQ(result.code, 0) << result.err;
    const std::string line = "isoweave: closed at the border of the volume by flat caps, about ";
    return result.err.find(line) != std::string::npos &&
           result.err.find(" % of the surface: --open leaves it open there\n") != std::string::npos;
  };
  const std::string gyroid = "generate:gyroid:24x24x24";
  EXPECT_TRUE(told(gyroid, {}));
  const Json report = Json::parse(files::read_bytes(folder / "r.json"));
  EXPECT_GT(report.at("cap_cells").get<double>(), 0.05 * report.at("cells_crossed").get<double>());
  EXPECT_TRUE(told(gyroid, {"--preview"}));
  EXPECT_FALSE(told(gyroid, {"--open"}));
  EXPECT_FALSE(Json::parse(files::read_bytes(folder / "r.json")).contains("cap_cells"));
  EXPECT_FALSE(told(gyroid, {"--closed"})) << "it was asked for";
  EXPECT_FALSE(told(gyroid, {"--quiet"}));
  EXPECT_FALSE(told("generate:sphere:24x24x24", {}));
}

TEST(CliTriangles, SayWhatStoppedThem) {
  const files::Folder folder;
  const auto err = [&](const Words& more) {
    Words words{"mesh", "generate:gyroid:32x32x32", "--iso", "0", "-o", "a.ply", "--triangles", "500"};
    words.insert(words.end(), more.begin(), more.end());
    return run(folder.path(), words).err;
  };
  const std::string stopped = err({"--error", "0.05vox"});
  EXPECT_NE(stopped.find("stopped by --error 0.05vox at "), std::string::npos) << stopped;
  EXPECT_NE(stopped.find(" of 500 triangles\n"), std::string::npos) << stopped;
  EXPECT_EQ(err({}).find("stopped by"), std::string::npos);
  const std::string distance = err({"--error", "inf", "--max-distance", "0.05vox"});
  EXPECT_NE(distance.find("no other collapse within a distance of 0.05 keeps"), std::string::npos) << distance;
  EXPECT_NE(distance.find("stopped by --max-distance 0.05vox at "), std::string::npos) << distance;
  EXPECT_NE(distance.find("or a --max-distance above 0.05vox\n"), std::string::npos) << distance;
  EXPECT_EQ(distance.find("--error"), std::string::npos) << distance;
}

TEST(CliThreads, MoreThanThereAreProcessorsSayNothing) {
  const files::Folder folder;
  const std::string threads = std::to_string(std::thread::hardware_concurrency() + 3);
  const program::Result result = run(folder.path(), {"mesh", "generate:gyroid:48x48x48", "--iso", "0", "-o", "a.ply",
                                                     "--threads", threads, "--quiet"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.err, "");
}

std::string nrrd(const std::string& type, const std::string& sizes, const std::string& samples) {
  return "NRRD0005\ntype: " + type + "\ndimension: 3\nsizes: " + sizes + "\nendian: little\nencoding: raw\n\n" +
         samples;
}

std::string int16_samples(const std::vector<int>& values, int count) {
  std::string bytes;
  for (int n = 0; n < count; ++n) {
    const int value = values[static_cast<std::size_t>(n) % values.size()];
    bytes += static_cast<char>(value & 255);
    bytes += static_cast<char>(value >> 8 & 255);
  }
  return bytes;
}

TEST(CliTissues, HaveNamesInCt) {
  const files::Folder folder;
  files::write_bytes(folder / "ct.nrrd", nrrd("int16", "8 8 8", int16_samples({-1000, -1000, 40, 60, 700}, 512)));
  const Json info = Json::parse(run(folder.path(), {"info", "ct.nrrd", "--json"}).out);
  EXPECT_EQ(info.at("suggested_iso").at("presets"), Json({{"bone", 226}, {"skin", -300}, {"lung", -500}}));
  EXPECT_EQ(info.at("suggested_iso").at("three_classes").size(), 2U);
  EXPECT_FALSE(info.at("input").at("label_map").get<bool>());
  const auto iso = [&](const std::string& name) {
    const Result result = run(folder.path(), {"mesh", "ct.nrrd", "-o", "a.ply", "--iso", name, "--report", "r.json"});
    EXPECT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err.find("is it CT?"), std::string::npos);
    return Json::parse(files::read_bytes(folder / "r.json")).at("iso");
  };
  EXPECT_EQ(iso("bone"), 226);
  EXPECT_EQ(iso("skin"), -300);
  EXPECT_EQ(iso("lung"), -500);
  const Result found = run(folder.path(), {"mesh", "ct.nrrd", "-o", "a.ply", "--iso", "auto"});
  EXPECT_NE(found.err.find("other surfaces of CT: --iso bone (226), skin (-300), lung (-500)"), std::string::npos)
      << found.err;
  write_ramp(folder);
  const Result other = run(folder.path(), mesh("bone", {"--allow-empty"}));
  EXPECT_NE(other.err.find("--iso bone is 226 in Hounsfield units, but the samples go from 0 to 130"),
            std::string::npos)
      << other.err;
  program::expect_failed(run(folder.path(), mesh("teeth")), 2, "--iso: expected a number, auto, bone, skin or lung");
}

TEST(CliLabelMaps, AreRecognised) {
  const files::Folder folder;
  std::string blocks;
  for (int n = 0; n < 24 * 24 * 24; ++n)
    blocks += static_cast<char>(n / 576 / 6 * 16 + n / 24 % 24 / 6 * 4 + n % 24 / 6);
  files::write_bytes(folder / "map_24x24x24_uint8.raw", blocks);
  const Result info = run(folder.path(), {"info", "map_24x24x24_uint8.raw"});
  EXPECT_NE(info.out.find("--labels all (looks like a mask or label map)"), std::string::npos) << info.out;
  const Result meshed = run(folder.path(), {"mesh", "map_24x24x24_uint8.raw", "-o", "a.ply", "--iso", "auto"});
  EXPECT_EQ(meshed.code, 0);
  EXPECT_NE(meshed.err.find("looks like a mask or label map: --labels all"), std::string::npos) << meshed.err;
  ASSERT_EQ(run(folder.path(), {"generate", "noise", "--size", "48x40x32", "--type", "uint8", "-o", "n.nrrd"}).code, 0);
  EXPECT_EQ(run(folder.path(), {"info", "n.nrrd"}).out.find("label map"), std::string::npos);
}

// The output of info for a volume whose samples are the values, over and over.
template <class T>
std::string info_of(const std::string& type, const std::vector<T>& values) {
  const files::Folder folder;
  std::string bytes;
  for (std::size_t n = 0; n < 4 * 5 * 6; ++n) {
    const T value = values[n % values.size()];
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  const std::string name = "v_4x5x6_" + type + ".raw";
  files::write_bytes(folder / name, bytes);
  const Result result = run(folder.path(), {"info", name, "--isos"});
  EXPECT_EQ(result.code, 0) << result.err;
  return result.out;
}

// The numbers behind a word at the beginning of lines, as they are printed.
Words numbers_behind(const std::string& word, const std::string& text) {
  Words numbers;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string first, number;
    if (fields >> first >> number && first == word) numbers.push_back(number);
  }
  return numbers;
}

TEST(CliHistogram, SaysInOneLineWhyItHasNoBars) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  const auto expect_reason = [](const std::string& text, const std::string& reason) {
    EXPECT_NE(text.find("\nhistogram  none: " + reason + "\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\nisos       none: " + reason + "\n"), std::string::npos) << text;
    EXPECT_TRUE(numbers_behind("from", text).empty()) << text;
  };
  expect_reason(info_of<std::uint8_t>("uint8", {7}), "all samples are equal");
  expect_reason(info_of<double>("float64", {-0.25}), "all samples are equal");
  expect_reason(info_of<double>("float64", {7, kNan}), "all finite samples are equal");
  expect_reason(info_of<double>("float64", {7, -kInfinite}), "all finite samples are equal");
  expect_reason(info_of<double>("float64", {kNan}), "no sample is finite");
  expect_reason(info_of<double>("float64", {kInfinite, -kInfinite}), "no sample is finite");
  expect_reason(info_of<double>("float64", {1, std::nextafter(1.0, 2)}), "the samples differ by their last digits");
  expect_reason(info_of<double>("float64", {0, 5e-324}), "the samples differ by their last digits");
  const std::int64_t odd = (std::int64_t{1} << 60) + 1;
  expect_reason(info_of<std::int64_t>("int64", {odd, odd}), "all samples are equal");
  expect_reason(info_of<std::int64_t>("int64", {odd, odd - 1}), "the samples differ by their last digits");
}

TEST(CliHistogram, TellsItsLinesApart) {
  const std::vector<std::vector<double>> volumes{
      {0, 1}, {1e9, 1e9 + 1, 1e9 + 7}, {-1e15, 16 - 1e15}, {-1e308, 1.7e308}, {0, 1e-300}, {1, 1 + 1e-13}};
  for (const std::vector<double>& values : volumes) {
    const std::string text = info_of<double>("float64", values);
    const Words froms = numbers_behind("from", text), isos = numbers_behind("iso", text);
    ASSERT_EQ(froms.size(), 16U) << text;
    EXPECT_FALSE(isos.empty()) << text;
    for (const Words& numbers : {froms, isos}) {
      for (std::size_t n = 0; n < numbers.size(); ++n) {
        const double number = std::stod(numbers[n]);
        EXPECT_TRUE(number >= values.front() && number <= values.back()) << number << "\n" << text;
        EXPECT_TRUE(n == 0 || std::stod(numbers[n - 1]) < number) << text;
      }
    }
    const std::size_t suggested = text.find("--iso ");
    ASSERT_NE(suggested, std::string::npos) << text;
    const double iso = std::stod(text.substr(suggested + 6));
    EXPECT_TRUE(iso > values.front() && iso <= values.back()) << text;
  }
}

TEST(CliHistogram, OfDistancesSaysThatAllAreZero) {
  const files::Folder folder;
  files::write_bytes(folder / "a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Result same = run(folder.path(), {"compare", "a.off", "a.off", "--histogram", "4"});
  EXPECT_NE(same.out.find("A to B: all distances are 0\nB to A: all distances are 0\n"), std::string::npos) << same.out;
}

}  // namespace
}  // namespace isoweave::testing::cli_results_test
