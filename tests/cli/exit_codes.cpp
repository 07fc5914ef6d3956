// The exit code of every verb for what may be wrong with names of files: 3 for what is read, 4 for what is written.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_exit_codes_test {
namespace {

using program::listing;
using program::run;
using Words = std::vector<std::string>;

constexpr const char* kSmall = "generate:sphere:16x16x16";

void expect_code(const files::Folder& folder, const Words& words, int code, const std::string& says) {
  std::string traced;
  for (const std::string& word : words) traced += word + " ";
  SCOPED_TRACE(traced);
  const Words before = listing(folder);
  program::expect_failed(run(folder.path(), words), code, says);
  EXPECT_EQ(listing(folder), before);
}

// A verb up to the name of what it writes, the ending of that, and whether any other ending does as well.
struct Writer {
  Words words;
  std::string ending;
  bool any_ending;
};

std::vector<Writer> writers() {
  const Words mesh{"mesh", kSmall, "--iso", "0"};
  const auto beside = [&](const std::string& option) {
    Words words = mesh;
    words.insert(words.end(), {"-o", "new.ply", option});
    return words;
  };
  return {{{"mesh", kSmall, "--iso", "0", "-o"}, ".ply", false},
          {{"mesh", kSmall, "--iso", "0", "-o"}, ".glb", false},
          {{"mesh", kSmall, "--iso", "0", "-o"}, ".precomputed", false},
          {{"simplify", "in.ply", "--error", "0.1", "-o"}, ".stl", false},
          {{"generate", "sphere", "--size", "8", "-o"}, ".nrrd", false},
          {{"compare", "in.ply", "in.ply", "--distances"}, ".ply", false},
          {{"render", "in.ply", "-o"}, ".png", false},
          {{"view", "in.ply", "-o"}, ".html", true},
          {beside("--report"), ".json", true},
          {beside("--html"), ".html", true}};
}

TEST(CliExitCodes, WhatCannotBeWrittenIs4) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"mesh", kSmall, "--iso", "0", "-o", "in.ply"}).code, 0);
  std::filesystem::create_directory(folder / "folder");
  for (const Writer& writer : writers()) {
    const std::string taken = "taken" + writer.ending;
    std::filesystem::create_directory(folder / taken);
    files::write_bytes(folder / taken + "/kept", "");
    std::vector<std::string> names{"missing/new" + writer.ending, taken, "folder/", "in.ply/new" + writer.ending};
    if (!writer.any_ending) names.insert(names.end(), {"new.unknown", "new", "folder", writer.ending + "x"});
    for (const std::string& name : names) {
      Words words = writer.words;
      words.push_back(name);
      expect_code(folder, words, 4, name);
    }
    std::filesystem::remove_all(folder / taken);
  }
}

TEST(CliExitCodes, WhatCannotBeReadIs3) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"mesh", kSmall, "--iso", "0", "-o", "in.ply"}).code, 0);
  std::filesystem::create_directory(folder / "folder");
  files::write_bytes(folder / "empty", "");
  files::write_bytes(folder / "text", "no volume, no mesh\n");
  for (const std::string name : {"missing", "missing/file", "folder", "empty", "text", "in.ply/file"}) {
    for (const Words& words : {Words{"info", name},
                               {"info", name, "--json"},
                               {"mesh", name, "--iso", "0", "-o", "new.ply"},
                               {"mesh", name, "--iso", "auto", "-o", "new.ply"},
                               {"mesh", name, "--labels", "all", "-o", "new.ply"},
                               {"mesh", name, "--iso", "0", "-o", "new.ply", "--dry-run"},
                               {"mesh", kSmall, "--iso", "0", "-o", "new.ply", "--color-by", name},
                               {"simplify", name, "-o", "new.ply", "--error", "1"},
                               {"check", name},
                               {"check", name, "--json"},
                               {"compare", name, "in.ply"},
                               {"compare", "in.ply", name},
                               {"render", name, "-o", "new.png"},
                               {"view", name, "-o", "new.html"},
                               {"view", "in.ply", "-o", "new.html", "--before", name}}) {
      expect_code(folder, words, 3, name);
    }
  }
}

TEST(CliExitCodes, CoordinatesThatAreNotNumbersNameTheirFile) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"mesh", kSmall, "--iso", "0", "-o", "in.ply"}).code, 0);
  files::write_bytes(folder / "nan.obj", "v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n");
  files::write_bytes(folder / "inf.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 inf 0\n3 0 1 2\n");
  for (const std::string name : {"nan.obj", "inf.off"}) {
    for (const Words& words : {Words{"check", name},
                               {"compare", name, "in.ply"},
                               {"compare", "in.ply", name},
                               {"simplify", name, "-o", "new.ply", "--error", "1"},
                               {"render", name, "-o", "new.png"},
                               {"view", name, "-o", "new.html"}}) {
      expect_code(folder, words, 3, name);
    }
  }
}

Words mesh_with(const std::string& option, const std::string& value) {
  return {"mesh", kSmall, "--iso", "0", "-o", "new.ply", option, value};
}

// As where a variable of a script is empty: an option is never left out in silence.
TEST(CliUsage, AnEmptyValueIsRefused) {
  const files::Folder folder;
  for (const std::string option : {"--report", "--error", "--memory", "--roi", "--color-by", "--html", "--checkpoint",
                                   "--lods", "--spacing", "--raw", "--space", "--triangles", "--threads"}) {
    expect_code(folder, mesh_with(option, ""), 2, option + ": expected a value, found ''");
    Words joined = mesh_with(option + "=", "");
    joined.pop_back();
    expect_code(folder, joined, 2, option + ": ");
  }
  expect_code(folder, {"info", kSmall, "--series", ""}, 2, "--series: expected a value, found ''");
}

TEST(CliUsage, AnOptionThatSaysNothingAloneIsRefused) {
  const files::Folder folder;
  expect_code(folder, mesh_with("--every", "3layers"), 2, "--every: expected --checkpoint as well");
  expect_code(folder, mesh_with("--page-triangles", "3000"), 2, "--page-triangles requires --html");
}

TEST(CliUsage, NumbersThatDoNotDoAreNamed) {
  const files::Folder folder;
  expect_code(folder, mesh_with("--spacing", "0,1,1"), 2, "spacing: expected lengths from 1e-30 to 1e30, found 0");
  expect_code(folder, mesh_with("--spacing", "1,1,1e31"), 2, "found 1e+31");
  expect_code(folder, mesh_with("--scale", "1e40"), 2, "scale: expected one with which 32 bits hold all coordinates");
  expect_code(folder, mesh_with("--threads", "0"), 2, "--threads: expected a whole number of at least 1, found '0'");
}

}  // namespace
}  // namespace isoweave::testing::cli_exit_codes_test
