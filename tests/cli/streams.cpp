// Standard streams that are closed, full or read by nobody: messages may be lost, results may not; and what reaches a
// terminal is printable.
#include <gtest/gtest.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_streams_test {
namespace {

using program::Result;
using program::run;
using Words = std::vector<std::string>;

constexpr const char* kSmall = "generate:sphere:24x24x24";

Words mesh(const std::string& output) { return {"mesh", kSmall, "--iso", "0", "-o", output, "--progress", "always"}; }

std::string traced(const Words& words) {
  std::string text;
  for (const std::string& word : words) text += word + " ";
  return text;
}

// Ways to lose what is written to standard error.
std::vector<program::Setup> without_messages() {
  std::vector<program::Setup> setups(4);
  setups[0].closed = {STDERR_FILENO};
  setups[1].err_path = "/dev/full";
  setups[2].closed = {STDOUT_FILENO, STDERR_FILENO};
  setups[3].closed = {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO};
  return setups;
}

TEST(CliStreams, MessagesThatCannotBeWrittenCostNoMesh) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh("right.ply")).code, 0);
  const std::string right = files::read_bytes(folder / "right.ply");
  for (const program::Setup& setup : without_messages()) {
    ASSERT_EQ(run(folder.path(), mesh("out.ply"), setup).code, 0);
    EXPECT_EQ(files::read_bytes(folder / "out.ply"), right);
    for (const Words& more : {Words{"simplify", "out.ply", "-o", "less.ply", "--error", "1"},
                              {"render", "out.ply", "-o", "out.png", "--size", "20x20"},
                              {"generate", "sphere", "-o", "out.nrrd", "--size", "8"},
                              {"view", "out.ply", "-o", "out.html"}}) {
      SCOPED_TRACE(traced(more));
      const Result result = run(folder.path(), more, setup);
      EXPECT_EQ(result.code, 0);
      EXPECT_EQ(result.signal, 0);
    }
  }
}

TEST(CliStreams, ErrorsKeepTheirCodesWhereNobodyHearsThem) {
  const files::Folder folder;
  for (const program::Setup& setup : without_messages()) {
    EXPECT_EQ(run(folder.path(), {"info", "nothing.nrrd"}, setup).code, 3);
    EXPECT_EQ(run(folder.path(), {"check", "nothing.ply"}, setup).code, 3);
    EXPECT_EQ(run(folder.path(), mesh("missing/out.ply"), setup).code, 4);
    EXPECT_EQ(run(folder.path(), {"frobnicate"}, setup).code, 2);
  }
}

// What these verbs make goes to standard output.
std::vector<Words> verbs_that_print() {
  return {{"check", "out.ply"},
          {"check", "out.ply", "--json"},
          {"compare", "out.ply", "out.ply"},
          {"info", kSmall, "--json"},
          {"mesh", kSmall, "--iso", "0", "--to-stdout", "ply"}};
}

TEST(CliStreams, ResultsThatCannotBeWrittenAreAnError) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh("out.ply")).code, 0);
  std::vector<program::Setup> setups(3);
  setups[0].closed = {STDOUT_FILENO};
  setups[1].out_path = "/dev/full";
  setups[2].out_unread = true;
  for (const program::Setup& setup : setups) {
    for (const Words& words : verbs_that_print()) {
      SCOPED_TRACE(traced(words));
      const Result result = run(folder.path(), words, setup);
      EXPECT_EQ(result.code, 4);
      EXPECT_NE(result.err.find("isoweave: standard output: "), std::string::npos) << result.err;
    }
  }
}

TEST(CliStreams, WhoStopsReadingHelpIsToldNothing) {
  const files::Folder folder;
  program::Setup setup;
  setup.out_unread = true;
  for (const Words& words : {Words{"--help"},
                             {"--version"},
                             {"mesh", "--help"},
                             {"info", kSmall},
                             {"mesh", kSmall, "--iso", "0", "-o", "out.ply", "--dry-run"}}) {
    SCOPED_TRACE(traced(words));
    const Result result = run(folder.path(), words, setup);
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
  }
}

// Clears a screen, turns the direction of writing, ends lines, hides; as UTF-8 and as bytes that are none.
constexpr const char* kHostile =
    "a\x1b[2J\xc2\x9b"
    "31m\xe2\x80\xae\xe2\x81\xa6\xe2\x80\x8b\nok\x9b\xff\x7f";

void expect_printable(const std::string& text) {
  for (const char* bad :
       {"\x1b", "\xc2\x9b", "\xe2\x80\xae", "\xe2\x81\xa6", "\xe2\x80\x8b", "\nok", "\x9b", "\xff", "\x7f"}) {
    EXPECT_EQ(text.find(bad), std::string::npos) << text;
  }
}

TEST(CliStreams, NamesAndHeadersCannotDriveATerminal) {
  const files::Folder folder;
  const std::string name = std::string(kHostile) + ".nrrd";
  const std::string header =
      "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: raw\nspace: a\x1b[2J\xe2\x80\xae"
      "b\n\n";
  files::write_bytes(folder / name, header + std::string(32, '\0') + std::string(32, '\2'));
  const std::string output = std::string(kHostile) + ".ply";
  for (const Words& words : {Words{"info", name},
                             {"info", name, "--json"},
                             {"mesh", name, "--iso", "1", "-o", output, "--report", "r.json"},
                             {"check", output},
                             {"check", output, "--json"},
                             {"simplify", output, "-o", "b.ply", "--error", "0"},
                             {"render", output, "-o", std::string(kHostile) + ".png", "--size", "20x20"},
                             {"view", output}}) {
    const Result result = run(folder.path(), words);
    EXPECT_EQ(result.code, 0) << result.err;
    expect_printable(result.out);
    expect_printable(result.err);
  }
  expect_printable(files::read_bytes(folder / "r.json"));
  EXPECT_EQ(nlohmann::json::parse(files::read_bytes(folder / "r.json")).at("triangles").get<int>() > 0, true);
  expect_printable(run(folder.path(), {"info", output}).err);
  expect_printable(run(folder.path(), {"check", std::string(kHostile)}).err);
}

TEST(CliStreams, JsonEscapesWhatATextHides) {
  const files::Folder folder;
  const std::string name = "\xf3\xa0\x80\x81\xe2\x80\xae\xc3\xa4.nrrd";  // a tag, an override, an umlaut
  files::write_bytes(folder / name, "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n12345678");
  const Result result = run(folder.path(), {"info", name, "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.out.find("\\udb40\\udc01\\u202e\xc3\xa4.nrrd"), std::string::npos) << result.out;
  EXPECT_EQ(nlohmann::json::parse(result.out).at("input").at("path"), name);
}

}  // namespace
}  // namespace isoweave::testing::cli_streams_test
