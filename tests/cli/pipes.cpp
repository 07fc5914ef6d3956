// Volumes from standard input: the same mesh as from the file, whatever reads the volume more than once.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "packing.hpp"
#include "program.hpp"

namespace isoweave::testing::cli_pipes_test {
namespace {

using program::Result;
using program::run;

// A pipe outside the folder of the run, into which a thread writes.
class Pipe {
 public:
  explicit Pipe(std::string content) : content_(std::move(content)) {
    EXPECT_EQ(::mkfifo(path().c_str(), 0600), 0);
    writer_ = std::thread([this] { std::ofstream(path(), std::ios::binary) << content_; });
  }
  ~Pipe() { writer_.join(); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  std::string path() const { return folder_ / "pipe"; }

 private:
  files::Folder folder_;
  std::string content_;
  std::thread writer_;
};

Result run_with_input(const files::Folder& folder, const std::vector<std::string>& arguments,
                      const std::string& in_path) {
  program::Setup setup;
  setup.in_path = in_path;
  return run(folder.path(), arguments, setup);
}

std::string digest_in(const std::string& text, const std::string& before = "digest ") {
  const std::size_t at = text.find(before);
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? "" : text.substr(at + before.size(), 16);
}

std::string digest_of(const Result& result) {
  EXPECT_EQ(result.code, 0) << result.err;
  return digest_in(result.err);
}

TEST(CliPipes, StandardInputGivesTheMeshOfTheFile) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"generate", "shells", "-o", "in.nrrd", "--size", "24x20x28"}).code, 0);
  const std::string volume = files::read_bytes(folder / "in.nrrd");
  const std::vector<std::vector<std::string>> tasks{
      {"--iso", "auto"},
      {"--iso", "0.1", "--largest", "--ratio", "0.5"},
      {"--iso", "0.1", "--ratio", "10%"},
      {"--iso", "0.1", "--triangles", "1k"},
      {"--iso", "0.1", "--roi", "4:,2:18,5:"},
      {"--iso", "0.1", "--memory", "500M", "--lods", "0.1vox,0.5vox"},
      {"--iso", "0.1", "--color-by", "-"},
  };
  for (const std::vector<std::string>& task : tasks) {
    std::vector<std::string> from_file{"mesh", "in.nrrd", "-o", "out.ply"};
    from_file.insert(from_file.end(), task.begin(), task.end());
    std::vector<std::string> from_input = from_file;
    from_input[1] = "-";
    if (from_file.back() == "-") from_file.back() = "in.nrrd";
    const std::string expected = digest_of(run(folder.path(), from_file));
    const Pipe pipe(volume);
    EXPECT_EQ(digest_of(run_with_input(folder, from_input, pipe.path())), expected) << task.back();
    EXPECT_EQ(digest_of(run_with_input(folder, from_input, folder / "in.nrrd")), expected) << task.back();
  }
}

TEST(CliPipes, ADryRunAndInfoReadStandardInput) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"generate", "sphere", "-o", "in.nrrd", "--size", "16"}).code, 0);
  const std::string volume = files::read_bytes(folder / "in.nrrd");
  const Result info = run_with_input(folder, {"info", "-"}, Pipe(volume).path());
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_NE(info.out.find("16 x 16 x 16"), std::string::npos) << info.out;
  const Result dry =
      run_with_input(folder, {"mesh", "-", "-o", "o.ply", "--iso", "0", "--dry-run"}, Pipe(volume).path());
  EXPECT_EQ(dry.code, 0) << dry.err;
  EXPECT_NE(dry.out.find("triangles"), std::string::npos) << dry.out;
}

TEST(CliPipes, WhatStandardInputCannotDoIsRefused) {
  const files::Folder folder;
  const std::vector<std::string> mesh{"mesh", "-", "-o", "o.ply", "--iso", "0"};
  program::expect_failed(run_with_input(folder, mesh, Pipe("no volume").path()), 3, "found text");
  program::expect_failed(run_with_input(folder, mesh, Pipe("").path()), 3, "nothing before the end of the pipe");
  program::expect_failed(run_with_input(folder, mesh, "/dev/null"), 3, "expected a regular file");
  std::vector<std::string> saved = mesh;
  saved.insert(saved.end(), {"--checkpoint", "state"});
  program::expect_failed(run_with_input(folder, saved, "/dev/null"), 2, "--resume can read again, found a pipe");
  EXPECT_EQ(folder.entries().size(), 0u);
}

// Room on the disk, as a limit on the size of files.
TEST(CliPipes, APipeThatDoesNotFitIsRefused) {
  const files::Folder folder;
  const Pipe pipe(std::string(20000, 'x'));
  program::Setup setup;
  setup.in_path = pipe.path();
  setup.file_limit = 1000;
  program::expect_failed(run(folder.path(), {"info", "-"}, setup), 4, "cannot keep what comes out of /dev/stdin");
}

// Every verb that reads a mesh.
TEST(CliPipes, MeshesInGzipAndFromStandardInputAreThoseOfTheFile) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"mesh", "generate:sphere:16x16x16", "--iso", "0", "-o", "a.ply"}).code, 0);
  const std::string mesh = files::read_bytes(folder / "a.ply");
  const std::string kDigest = "\"digest\": \"";
  files::write_bytes(folder / "a.ply.gz", testing::gzipped(mesh));
  const std::vector<std::vector<std::string>> tasks{
      {"check", "a.ply", "--json"},
      {"simplify", "a.ply", "-o", "o.ply", "--error", "0.1"},
      {"compare", "a.ply", "a.ply", "--samples", "10"},
      {"render", "a.ply", "-o", "o.png", "--size", "16x16"},
      {"view", "a.ply", "-o", "o.html"},
  };
  for (const std::vector<std::string>& task : tasks) {
    const Result plain = run(folder.path(), task);
    if (plain.code != 0) continue;  // pictures and pages are not of every build
    std::vector<std::string> named = task;
    named[1] = "a.ply.gz";
    const Result packed = run(folder.path(), named);
    EXPECT_EQ(packed.code, 0) << packed.err;
    if (task[0] == "check") {
      EXPECT_EQ(digest_in(packed.out, kDigest), digest_in(plain.out, kDigest));
    }
    named[1] = "-";
    const Pipe pipe(mesh);
    const Result piped = run_with_input(folder, named, pipe.path());
    EXPECT_EQ(piped.code, 0) << task[0] << piped.err;
    if (task[0] == "check") {
      EXPECT_EQ(digest_in(piped.out, kDigest), digest_in(plain.out, kDigest));
    }
  }
}

TEST(CliPipes, DamagedGzipOfAMeshEndsWithThree) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"mesh", "generate:sphere:16x16x16", "--iso", "0", "-o", "a.ply"}).code, 0);
  const std::string packed = testing::gzipped(files::read_bytes(folder / "a.ply"));
  files::write_bytes(folder / "b.ply.gz", packed.substr(0, packed.size() / 2));
  for (const std::vector<std::string>& task : std::vector<std::vector<std::string>>{
           {"check", "b.ply.gz"}, {"simplify", "b.ply.gz", "-o", "o.ply", "--error", "0.1"}}) {
    program::expect_failed(run(folder.path(), task), 3, "b.ply.gz: expected a complete compressed stream");
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "o.ply"));
}

}  // namespace
}  // namespace isoweave::testing::cli_pipes_test
