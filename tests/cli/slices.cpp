// Volumes of one DICOM file per slice: what the options say of slices at uneven distances.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_slices_test {
namespace {

using Json = nlohmann::json;
using program::Result;
using program::run;

constexpr int kSide = 96;

std::string word(unsigned value) { return {static_cast<char>(value & 0xff), static_cast<char>(value >> 8 & 0xff)}; }

// An element of a data set in implicit little-endian form.
std::string element(unsigned group, unsigned number, std::string value) {
  if (value.size() % 2 != 0) value += ' ';
  const auto size = static_cast<unsigned>(value.size());
  return word(group) + word(number) + word(size & 0xffff) + word(size >> 16) + value;
}

// A slice of ripples at the height z, in a file without preamble.
std::string slice_at(double z) {
  std::string samples;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      samples += word(static_cast<unsigned>(1000 + 500 * std::sin(0.4 * i) * std::cos(0.5 * j) * std::sin(0.3 * z)));
    }
  }
  return element(8, 0x16, "1.2.840.10008.5.1.4.1.1.2") + element(8, 0x18, "1.9") + element(8, 0x60, "CT") +
         element(0x20, 0xe, "1.2.3") + element(0x20, 0x32, "0\\0\\" + std::to_string(z)) +
         element(0x20, 0x37, "1\\0\\0\\0\\1\\0") + element(0x28, 2, word(1)) + element(0x28, 4, "MONOCHROME2") +
         element(0x28, 0x10, word(kSide)) + element(0x28, 0x11, word(kSide)) + element(0x28, 0x30, "1\\1") +
         element(0x28, 0x100, word(16)) + element(0x28, 0x101, word(16)) + element(0x28, 0x102, word(15)) +
         element(0x28, 0x103, word(0)) + element(0x7fe0, 0x10, samples);
}

// 40 slices, of which the upper half lie three times as far apart as the lower.
void put_uneven(const files::Folder& folder) {
  std::filesystem::create_directory(folder / "ct");
  for (int n = 0; n < 40; ++n) {
    const double z = n < 20 ? n : 19 + 3 * (n - 19);
    files::write_bytes(folder / ("ct/" + std::to_string(n)), slice_at(z));
  }
}

std::vector<std::string> mesh(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"mesh", "ct",      "-o", "out.ply",  "--iso",
                                     "1100", "--error", "0",  "--report", "out.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

Json report(const files::Folder& folder) { return Json::parse(files::read_bytes(folder / "out.json")); }

TEST(CliUnevenSlices, AreResampledUnlessToldOtherwise) {
  const files::Folder folder;
  put_uneven(folder);
  const auto slices = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"info", "ct", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = run(folder.path(), arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return Json::parse(result.out).at("input").at("dims").at(2).get<int>();
  };
  EXPECT_EQ(slices({}), 80);
  EXPECT_EQ(slices({"--even-spacing", "resample"}), 80);
  EXPECT_EQ(slices({"--even-spacing", "mean"}), 40);
  const auto refused = [&](const std::vector<std::string>& arguments, int code, const std::string& says) {
    program::expect_failed(run(folder.path(), arguments), code, says);
  };
  refused({"info", "ct", "--even-spacing", "refuse"}, 3, "distances of 1 to 3 mm");
  refused({"info", "ct", "--even-spacing", "never"}, 2, "--even-spacing: expected one of resample, mean, refuse");
  refused({"info", "generate:sphere:8x8x8", "--even-spacing", "mean"}, 2, "does not go with a generated volume");
}

// What lies between label 1 and label 3 is not label 2.
TEST(CliUnevenSlices, AreNotInterpolatedForLabels) {
  const files::Folder folder;
  put_uneven(folder);
  const auto labels = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"mesh", "ct", "-o", "out.ply", "--labels", "1000", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(folder.path(), arguments);
  };
  program::expect_failed(labels({}), 3, "expected slices at an even distance");
  program::expect_failed(labels({"--even-spacing", "resample"}), 2, "nothing lies between two labels");
  EXPECT_EQ(labels({"--even-spacing", "mean"}).code, 0);
}

TEST(CliUnevenSlices, StayAsTheyWereReadWhenARunGoesOn) {
  for (const std::string spacing : {"mean", "resample"}) {
    const files::Folder folder;
    put_uneven(folder);
    ASSERT_EQ(run(folder.path(), mesh({"--even-spacing", spacing, "--quiet"})).code, 0);
    const Json expected = report(folder);
    std::filesystem::remove(folder / "out.ply");
    program::Setup setup;
    setup.file_limit = std::filesystem::file_size(folder / "out.json") + (200 << 10);
    const Result stopped =
        run(folder.path(),
            mesh({"--even-spacing", spacing, "--checkpoint", "run", "--every", "1layers", "--slab", "2"}), setup);
    ASSERT_EQ(stopped.code, 4) << stopped.err;
    const Result resumed = run(folder.path(), {"mesh", "--resume", "run", "--quiet"});
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_EQ(report(folder).at("digest"), expected.at("digest"));
  }
}

// A file that is usual beside slices is told by a note, one that may be a slice by a warning.
TEST(CliSlices, FilesBesideThemAreToldApart) {
  const files::Folder folder;
  put_uneven(folder);
  files::write_bytes(folder / "ct/README.txt", "hello");
  files::write_bytes(folder / "ct/scan.jpg", "hello");
  const Result made = run(folder.path(), mesh({}));
  EXPECT_EQ(made.code, 0);
  const std::string left_out = "1 file of the folder is no slice and is left out: ";
  EXPECT_NE(made.err.find("isoweave: " + left_out + "README.txt\n"), std::string::npos) << made.err;
  EXPECT_NE(made.err.find("isoweave: warning: " + left_out + "scan.jpg\n"), std::string::npos) << made.err;
  const std::string told = run(folder.path(), {"info", "ct"}).out;
  EXPECT_NE(told.find("note       " + left_out + "README.txt\n"), std::string::npos) << told;
  EXPECT_NE(told.find("warning    " + left_out + "scan.jpg\n"), std::string::npos) << told;
  const Json info = Json::parse(run(folder.path(), {"info", "ct", "--json"}).out);
  EXPECT_NE(info.at("input").at("notes").dump().find("README.txt"), std::string::npos);
}

}  // namespace
}  // namespace isoweave::testing::cli_slices_test
