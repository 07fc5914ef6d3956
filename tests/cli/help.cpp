// Help, man pages, completions, and usage errors that say what to do.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_help_test {
namespace {

using Json = nlohmann::json;
using program::run;
using Words = std::vector<std::string>;

const Words kVerbs{"mesh", "simplify", "info", "check", "compare", "render", "view", "generate"};

std::string output_of(const Words& words) {
  const files::Folder folder;
  const program::Result result = run(folder.path(), words);
  EXPECT_EQ(result.code, 0) << result.err;
  return result.out;
}

// The long options at the beginnings of the lines of a help text.
std::set<std::string> options_in(const std::string& help) {
  std::set<std::string> options;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t dashes = line.find("--");
    const std::size_t text = line.find_first_not_of(' ');
    if (dashes == std::string::npos || text != 2 || line[2] != '-' || dashes > 6) continue;
    options.insert(line.substr(dashes, line.find_first_of(" ,=", dashes) - dashes));
  }
  return options;
}

TEST(CliHelp, FitsATerminalAndSaysWhatIsMeant) {
  for (const std::string& verb : kVerbs) {
    const std::string help = output_of({"help", verb});
    EXPECT_EQ(help, output_of({verb, "--help"}));
    EXPECT_NE(help.find("Usage: isoweave " + verb + " "), std::string::npos) << help;
    EXPECT_NE(help.find("Examples:\n  isoweave " + verb + " "), std::string::npos) << help;
    for (const char* word : {"Excludes", "TEXT", "Needs:", "UINT"})
      EXPECT_EQ(help.find(word), std::string::npos) << word;
    std::istringstream lines(help);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
    EXPECT_GE(options_in(help).size(), 2U) << help;
  }
  EXPECT_EQ(output_of({"help"}), output_of({"--help"}));
  const std::string mesh = output_of({"help", "mesh"});
  for (const char* group : {"Input:", "Surface:", "Simplification:", "Output:", "Labels:", "Evidence:", "Resources:"}) {
    EXPECT_NE(mesh.find(std::string("\n") + group + "\n"), std::string::npos) << group;
  }
  EXPECT_NE(mesh.find("--quality HOW"), std::string::npos);
  EXPECT_NE(mesh.find("[normal]"), std::string::npos);
}

TEST(CliHelp, ManPagesAndCompletionsHaveTheSameOptions) {
  const std::string bash = output_of({"help", "--completion", "bash"});
  const std::string zsh = output_of({"help", "--completion", "zsh"});
  const std::string fish = output_of({"help", "--completion", "fish"});
  for (const std::string& verb : kVerbs) {
    const std::string man = output_of({"help", "--man", verb});
    EXPECT_EQ(man.find(".TH isoweave-" + verb), 0U);
    const std::size_t words = bash.find("    " + verb + ") words=\"");
    ASSERT_NE(words, std::string::npos);
    const std::string in_bash = bash.substr(words, bash.find('\n', words) - words) + " ";
    for (const std::string& option : options_in(output_of({"help", verb}))) {
      std::string in_roff;
      for (const char c : option) in_roff += c == '-' ? std::string("\\-") : std::string(1, c);
      EXPECT_NE(man.find("\\fB" + in_roff + "\\fR"), std::string::npos) << verb << ' ' << option;
      const bool known =
          in_bash.find(option + " ") != std::string::npos || in_bash.find(option + "\"") != std::string::npos;
      EXPECT_TRUE(known) << verb << ' ' << option;
      EXPECT_NE(zsh.find("'" + option + "["), std::string::npos) << option;
      EXPECT_NE(fish.find("__fish_seen_subcommand_from " + verb + "' -l " + option.substr(2)), std::string::npos);
    }
  }
  EXPECT_NE(output_of({"help", "--man"}).find("isoweave\\-mesh"), std::string::npos);
}

void expect_usage(const Words& words, const std::string& says) {
  const files::Folder folder;
  for (const char* name : {"a.tif", "b.tif", "c.tif"}) files::write_bytes(folder / name, "");
  program::expect_failed(run(folder.path(), words), 2, says);
}

TEST(CliUsage, ErrorsSayWhatToDo) {
  expect_usage({"mesh", "a.nii", "-o", "a.ply", "--iso", "1", "--erorr", "0.2vox"},
               "unknown option --erorr, did you mean --error?; see isoweave mesh --help");
  expect_usage({"info", "a.nii", "--jsn"}, "unknown option --jsn, did you mean --json?; see isoweave info --help");
  expect_usage({"info", "a.nii", "--entirely-else"}, "unknown option --entirely-else; see isoweave info --help");
  expect_usage({"info", "a.nii", "-j"}, "unknown option -j; see isoweave info --help");
  expect_usage({"info", "a.nii", "-5"}, "'-5' is one argument too many");
  expect_usage({"mehs", "a.nii"}, "did you mean 'mesh'");
  expect_usage({"mesh", "a.tif", "b.tif", "c.tif", "--iso", "1", "-o", "a.ply"},
               "found 2 files more than one: put a pattern in quotes, such as 'slices/*.tif'");
  expect_usage({"mesh", "a.tif", "--iso", "1", "-o", "a.ply", "--smooth", "10"},
               "'10' is one argument too many: write --smooth=10");
  expect_usage({"mesh", "a.tif", "-o", "a.ply"}, "--iso is required: a number, or auto; isoweave info VOLUME");
  expect_usage({"mesh", "generate:sphere:8x8x8", "--iso", "0"}, "--output is required: a file to write");
  expect_usage({"check"}, "see isoweave check --help");
}

TEST(CliUsage, AMissingOutputIsBesideTheInput) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"generate", "sphere", "--size", "16", "-o", "ball.nrrd"}).code, 0);
  ASSERT_EQ(run(folder.path(), {"mesh", "ball.nrrd", "--iso", "0"}).code, 0);
  ASSERT_EQ(run(folder.path(), {"simplify", "ball.ply", "--ratio", "50%"}).code, 0);
  EXPECT_EQ(program::listing(folder), (Words{"ball.nrrd", "ball.ply", "ball_simplified.ply"}));
  program::expect_failed(run(folder.path(), {"mesh", "ball.nrrd", "--iso", "0"}), 4,
                         "ball.ply: exists; -o names the file that is to be written");
}

TEST(CliValues, WithOneMeaningAreTaken) {
  const files::Folder folder;
  const auto report = [&](const Words& more) {
    Words words{"mesh", "generate:gyroid:32x32x32:u8", "--iso", "127.5", "-o", "a.ply", "--report", "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    const program::Result result = run(folder.path(), words);
    EXPECT_EQ(result.code, 0) << result.err;
    return Json::parse(files::read_bytes(folder / "r.json"));
  };
  const auto same = [&](const Words& a, const Words& b) { EXPECT_EQ(report(a).at("digest"), report(b).at("digest")); };
  same({"--triangles", "5k"}, {"--triangles", "5000"});
  same({"--triangles", "2.5k"}, {"--triangles", "2500"});
  same({"--ratio", "10%"}, {"--ratio", "0.1"});
  same({"--error", "0.3voxels"}, {"--error", "0.3vox"});
  EXPECT_EQ(report({"--spacing", "2"}).at("input").at("spacing"), Json({2.0, 2.0, 2.0}));
  files::write_bytes(folder / "v.bin", std::string(27, '\1'));
  EXPECT_EQ(run(folder.path(), {"info", "v.bin", "--raw", "3x3x3:byte"}).code, 0);
  program::expect_failed(run(folder.path(), {"info", "v.bin", "--raw", "3x3x3:bytes"}), 2, "--raw: ");
  std::string labels(64, '\0');
  for (std::size_t n = 0; n < labels.size(); ++n) labels[n] = static_cast<char>(n / 16);
  files::write_bytes(folder / "l_4x4x4_uint8.raw", labels);
  ASSERT_EQ(run(folder.path(), {"mesh", "l_4x4x4_uint8.raw", "-o", "l.ply", "--labels", "1-3"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "l_label2.ply"));
#ifdef ISOWEAVE_HAS_PNG
  ASSERT_EQ(run(folder.path(), {"render", "a.ply", "-o", "a.PNG", "--size", "40", "--color", "red"}).code, 0);
#endif
  program::expect_failed(
      run(folder.path(), {"mesh", "generate:sphere:8x8x8", "--iso", "0", "-o", "b.ply", "--triangles", "1.0001k"}), 2,
      "--triangles: expected a whole number of at least 1, such as 5000 or 50k");
}

}  // namespace
}  // namespace isoweave::testing::cli_help_test
