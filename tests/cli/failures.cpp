// Whatever goes wrong: one line on standard error, the right exit code, and a folder as it was.
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_failures_test {
namespace {

using program::listing;
using program::Result;
using program::run;

constexpr const char* kSmall = "generate:sphere:16x16x16";
constexpr const char* kEndless = "generate:smooth:64x64x2000000:uint8";

// One more than there may be: 256 besides the last.
std::string many_levels() {
  std::string list = "1vox";
  for (int n = 2; n <= 257; ++n) list += "," + std::to_string(n) + "vox";
  return list;
}

std::vector<std::string> mesh(const std::string& volume, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"mesh", volume, "-o", "out.ply", "--iso", "0"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += word + " ";
  return text;
}

void expect_failure(const files::Folder& folder, const std::vector<std::string>& arguments, int code,
                    const std::string& says, const program::Setup& setup = {}) {
  SCOPED_TRACE(joined(arguments));
  const std::vector<std::string> before = listing(folder);
  const Result result = run(folder.path(), arguments, setup);
  program::expect_failed(result, code, says);
  EXPECT_EQ(listing(folder), before);
}

std::string nrrd(const std::string& sizes, const std::string& type, std::size_t bytes) {
  return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: " + sizes + "\nencoding: raw\nendian: little\n\n" +
         std::string(bytes, '\1');
}

TEST(CliUsage, EveryWrongCommandLineIsRefused) {
  const files::Folder folder;
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{}, "expected a verb"},
      {{"frobnicate"}, "frobnicate"},
      {{"mesh"}, "required"},
      {{"mesh", kSmall, "--iso", "0"}, "--output"},
      {{"mesh", kSmall, "-o", "out.ply"}, "--iso"},
      {{"check", "a.ply", "b.ply"}, "b.ply"},
      {{"check", "a.ply", "--self-intersections", "--threads", "0"}, "--threads"},
      {{"generate", "sphere", "-o", "s.nrrd"}, "--size"},
      {{"generate", "cow", "-o", "s.nrrd", "--size", "8"}, "cow"},
      {{"generate", "sphere", "-o", "s.nrrd", "--size", "8x8"}, "8x8"},
      {{"generate", "sphere", "-o", "s.nrrd", "--size", "-8"}, "-8"},
      {{"generate", "sphere", "-o", "s.nrrd", "--size", "8", "--type", "int5"}, "int5"},
      {{"compare", "a.ply", "b.ply", "--samples", "0"}, "--samples"},
      {{"compare", "a.ply", "b.ply", "--voxel", "-1"}, "--voxel"},
      {{"compare", "a.ply", "b.ply", "--voxel", "0.5vox"}, "--voxel: expected a length above 0"},
      {{"compare", "a.ply", "b.ply", "--histogram", "0"}, "--histogram"},
      {{"compare", "a.ply", "b.ply", "--histogram", "1000001"}, "--histogram"},
      {{"compare", "a.ply", "b.ply", "--distances", "b.ply"}, "b.ply"},
      {{"simplify", "a.ply", "-o", "b.ply", "--error", "much"}, "much"},
      {mesh(kSmall, {"--frobnicate"}), "--frobnicate"},
      {mesh(kSmall, {"--error", "-1vox"}), "-1vox"},
      {mesh(kSmall, {"--error", "nan"}), "nan"},
      {mesh(kSmall, {"--lods", "0.3,0.2"}), "levels of detail: expected ascending errors"},
      {mesh(kSmall, {"--lods", many_levels()}), "levels of detail: expected at most 255 finer ones, found 256"},
      {mesh(kSmall, {"--quality", "superb"}), "superb"},
      {mesh(kSmall, {"--specks", "maybe"}), "maybe"},
      {mesh(kSmall, {"--step", "0"}), "--step"},
      {mesh(kSmall, {"--roi", "0:4,0:4"}), "--roi"},
      {mesh(kSmall, {"--roi", "0:4,0:4,1"}), "--roi"},
      {mesh(kSmall, {"--roi", "0:4,0:4,2:900"}), "2:900"},
      {mesh(kSmall, {"--slab", "0"}), "--slab"},
      {mesh(kSmall, {"--threads", "0"}), "--threads"},
      {mesh(kSmall, {"--threads", "two"}), "--threads: expected a whole number of at least 1, such as 8, or all"},
      {mesh(kSmall, {"--smooth=1.5"}), "--smooth: expected a whole number of at least 1, found '1.5'"},
      {mesh(kSmall, {"--preview=-1vox"}), "--preview: expected a length above 0 such as 0.2vox"},
      {mesh(kSmall, {"--iso", "1"}), "--iso: expected once, as in --iso 300,1200, found more often"},
      {mesh(kSmall, {"-o", "b.ply"}), "--output: expected once, found more often"},
      {mesh(kSmall, {"--error"}), "--error: expected a value, found none"},
      {mesh(kSmall, {"--threads", "99999999999999999999"}), "--threads"},
      {mesh(kSmall, {"--schedule", "later"}), "later"},
      {mesh(kSmall, {"--inside", "out"}), "--inside"},
      {mesh(kSmall, {"--space", "xyz"}), "--space"},
      {mesh(kSmall, {"--progress", "maybe"}), "--progress"},
      {mesh(kSmall, {"--open", "--closed"}), "--closed"},
      {mesh(kSmall, {"--spacing", "1,2"}), "--spacing"},
      {mesh(kSmall, {"--spacing", "0,1,1"}), "spacing"},
      {mesh(kSmall, {"--origin", "1,2,3"}), "--origin"},
      {mesh("x.raw", {"--raw", "0x4x4:uint8"}), "0x4x4"},
      {mesh("x.raw", {"--raw", "-4x4x4:uint8"}), "-4x4x4"},
      {mesh("x.raw", {"--raw", "4x4x4:colour"}), "colour"},
      {mesh("generate:sphere"), "generate:"},
      {mesh("generate:sphere:0x4x4"), "0x4x4"},
      {mesh("generate:sphere:4x4x4:uint8:seed"), "seed"},
      {mesh("generate:sphere:9000000000x9000000000x9000000000"), "9000000000"},
      {{"mesh", kSmall, "-o", "out.ply", "--iso", "high"}, "high"},
      {{"mesh", kSmall, "-o", "out.ply", "--iso", "nan"}, "nan"},
  };
  for (const auto& [arguments, says] : cases) expect_failure(folder, arguments, 2, says);
}

TEST(CliUsage, WhatIsPromisedForLaterIsRefusedNotIgnored) { const files::Folder folder; }

TEST(CliUsage, NumbersOfTrianglesAreChecked) {
  const files::Folder folder;
  expect_failure(folder, mesh(kSmall, {"--triangles", "0"}), 2, "--triangles");
  expect_failure(folder, mesh(kSmall, {"--ratio", "1.5"}), 2, "--ratio");
  expect_failure(folder, mesh(kSmall, {"--ratio", "0"}), 2, "--ratio");
  expect_failure(folder, mesh(kSmall, {"--ratio", "0.5", "--triangles", "100"}), 2, "excludes");
}

// By the library's table, with the names of the options, and before any file is looked at.
TEST(CliUsage, WhatADeviceDoesNotDoIsRefused) {
  const files::Folder folder;
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {{"--triangles", "9"}, "--triangles"},
      {{"--ratio", "0.5"}, "--ratio"},
      {{"--lods", "0.1,0.2"}, "--lods"},
      {{"--max-distance", "1vox"}, "--max-distance"},
      {{"--min-component", "9"}, "--min-component"},
      {{"--normals", "quadric"}, "--normals quadric"},
      {{"--color-by", "nothing.nrrd"}, "--color-by"},
      {{"--schedule", "queue"}, "a --schedule other than rounds"}};
  for (const auto& [more, option] : cases) {
    std::vector<std::string> arguments = mesh("nothing.nrrd", more);
    arguments.insert(arguments.end(), {"--device", "cuda"});
    expect_failure(folder, arguments, 2,
                   "--device cuda: expected a run without " + option + ", which takes processors");
  }
  expect_failure(folder, {"simplify", "nothing.ply", "-o", "b.ply", "--error", "1", "--device", "cuda"}, 2,
                 "simplify: expected a run without --device cuda, which takes a volume");
}

TEST(CliUsage, InputsAreNeverWrittenOver) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh(kSmall)).code, 0);
  ASSERT_EQ(::symlink((folder / "out.ply").c_str(), (folder / "link.ply").c_str()), 0);
  for (const std::string output : {"out.ply", "./out.ply", "link.ply"}) {
    expect_failure(folder, {"simplify", "out.ply", "-o", output, "--error", "1"}, 2, "different files");
  }
  expect_failure(folder, mesh(kSmall, {"--report", "./out.ply"}), 2, "different files");
}

TEST(CliUsage, ALinkStaysALinkWhetherOrNotItsFileIsThere) {
  const files::Folder folder;
  std::filesystem::create_directory(folder / "kept");
  std::filesystem::create_symlink("kept/second.ply", folder / "out.ply");
  std::filesystem::create_symlink("last.ply", folder / "kept/second.ply");
  for (int time = 0; time < 2; ++time) {
    const Result result = run(folder.path(), mesh(kSmall));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "out.ply"));
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "kept/second.ply"));
    EXPECT_TRUE(std::filesystem::is_regular_file(std::filesystem::symlink_status(folder / "kept/last.ply")));
  }
  for (const auto& [target, says] : {std::pair("nowhere/out.ply", "out.ply: cannot create a file in 'nowhere'"),
                                     std::pair("out.ply", "out.ply: cannot be looked up")}) {
    std::filesystem::remove(folder / "out.ply");
    std::filesystem::create_symlink(target, folder / "out.ply");
    expect_failure(folder, mesh(kSmall), 4, says);
  }
}

TEST(CliBadInput, NothingThereAndNoFile) {
  const files::Folder folder;
  expect_failure(folder, mesh("nothing.nrrd"), 3, "nothing.nrrd");
  expect_failure(folder, mesh("."), 3, "directory");
  expect_failure(folder, mesh("slices/*.tif"), 3, "files that match the pattern, found none");
  expect_failure(folder, mesh("nothing.nrrd", {"--series", "1.2"}), 3, "nothing.nrrd");
  files::write_bytes(folder / "box.nrrd", nrrd("8 8 8", "uchar", 512));
  expect_failure(folder, mesh("box.nrrd", {"--series", "1.2"}), 3, "expected the DICOM series '1.2', found no DICOM");
  expect_failure(folder, mesh(kSmall, {"--series", "1.2"}), 2, "--series does not go with a generated volume");
  for (const std::string option : {"--dataset", "--level", "--channel", "--time"}) {
    const std::string expected = option == "--dataset" ? "expected HDF5, Zarr, N5, VTI, VTR, legacy VTK or NPZ for "
                                 : option == "--level" ? "expected HDF5, Zarr, N5 or a precomputed volume for "
                                                       : "expected an axis for ";
    expect_failure(folder, mesh("box.nrrd", {option, "1"}), 3, expected + option);
    expect_failure(folder, mesh(kSmall, {option, "1"}), 2, option + " does not go with a generated volume");
  }
  files::write_bytes(folder / "box.bin", std::string(8, 'x'));
  expect_failure(folder, mesh("box.bin", {"--raw", "2x2x2:uint8", "--time", "0"}), 3,
                 "N5 for --channel, --time and --slices-from, found raw");
  expect_failure(folder, mesh("box.nrrd", {"--slices-from", "z"}), 2, "--slices-from: expected one of channel, time");
  expect_failure(folder, mesh("box.nrrd", {"--level", "-1"}), 2, "--level: expected a whole number from 0 on");
  expect_failure(folder, {"info", "nothing.nrrd"}, 3, "nothing.nrrd");
  expect_failure(folder, {"check", "nothing.ply"}, 3, "nothing.ply");
  expect_failure(folder, {"check", "."}, 3, ".");
  expect_failure(folder, {"compare", "nothing.ply", "nothing.ply"}, 3, "nothing.ply");
  expect_failure(folder, {"simplify", "nothing.ply", "-o", "b.ply", "--error", "1"}, 3, "nothing.ply");
}

TEST(CliBadInput, HeadersThatLie) {
  const files::Folder folder;
  files::write_bytes(folder / "cut.nrrd", nrrd("8 8 8", "uint8", 100));
  files::write_bytes(folder / "huge.nrrd", nrrd("100000 100000 100000", "uint8", 100));
  files::write_bytes(folder / "overflow.nrrd", nrrd("9000000000 9000000000 9000000000", "float", 100));
  files::write_bytes(folder / "zero.nrrd", nrrd("0 8 8", "uint8", 100));
  files::write_bytes(folder / "negative.nrrd", nrrd("-8 -8 8", "uint8", 512));
  files::write_bytes(folder / "type.nrrd", nrrd("8 8 8", "colour", 512));
  files::write_bytes(folder / "empty.nrrd", "");
  files::write_bytes(folder / "text.txt", "no volume at all\n");
  files::write_bytes(folder / "x.raw", std::string(100, '\0'));
  for (const std::string name : {"cut.nrrd", "huge.nrrd", "overflow.nrrd", "zero.nrrd", "negative.nrrd", "type.nrrd",
                                 "empty.nrrd", "text.txt"}) {
    expect_failure(folder, mesh(name), 3, name);
    expect_failure(folder, {"info", name, "--json"}, 3, name);
  }
  expect_failure(folder, mesh("x.raw"), 3, "x.raw");
  expect_failure(folder, mesh("x.raw", {"--raw", "8x8x8:uint8"}), 3, "512");
  expect_failure(folder, mesh("x.raw", {"--raw", "9000000000x9000000000x9000000000:uint8"}), 3, "x.raw");
}

TEST(CliBadInput, NamesCannotBreakTheLine) {
  const files::Folder folder;
  expect_failure(folder, mesh("no\nsuch\rfile.nrrd"), 3, "file.nrrd");
}

TEST(CliBadInput, AutomaticIsoNeedsTwoValues) {
  const files::Folder folder;
  files::write_bytes(folder / "flat.nrrd", nrrd("8 8 8", "uint8", 512));
  expect_failure(folder, {"mesh", "flat.nrrd", "-o", "out.ply", "--iso", "auto"}, 3, "flat.nrrd");
}

TEST(CliBadInput, MeshesWithoutTrianglesAreNotCompared) {
  const files::Folder folder;
  files::write_bytes(folder / "empty.obj", "v 0 0 0\n");
  expect_failure(folder, {"compare", "empty.obj", "empty.obj"}, 3, "empty.obj");
}

TEST(CliCannotWrite, FolderMissingOrNameUnknown) {
  const files::Folder folder;
  ASSERT_EQ(::mkdir((folder / "folder.ply").c_str(), 0700), 0);
  for (const std::string output : {"missing/out.ply", "folder.ply", "out.xyz", "out"}) {
    expect_failure(folder, {"mesh", kSmall, "-o", output, "--iso", "0"}, 4, output);
    expect_failure(folder, {"mesh", kEndless, "-o", output, "--iso", "auto"}, 4, output);
  }
  expect_failure(folder, {"generate", "sphere", "-o", "missing/s.nrrd", "--size", "8"}, 4, "missing/s.nrrd");
  expect_failure(folder, {"generate", "sphere", "-o", "s.jpg", "--size", "8"}, 4, "s.jpg");
}

// In a pass over the whole volume, the surface is counted or its components are chosen, before the mesh is made.
TEST(CliCannotWrite, MeshProblemsAreFoundBeforeAnyPass) {
  const files::Folder folder;
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--largest"}, {"--ratio", "0.1"}, {"--memory", "1G"}, {"--lods", "1vox,2vox"}}) {
    std::vector<std::string> arguments = {"mesh", kEndless, "-o", "missing/out.ply", "--iso", "127"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_failure(folder, arguments, 4, "missing/out");
  }
}

TEST(CliCannotWrite, ProblemsAreFoundBeforeMeshesAreRead) {
  const files::Folder folder;
  expect_failure(folder, {"simplify", "nothing.ply", "-o", "missing/a.ply", "--error", "1"}, 4, "missing/a.ply");
  expect_failure(folder, {"simplify", "nothing.ply", "-o", "a.ply", "--error", "1", "--report", "missing/r.json"}, 4,
                 "missing/r.json");
  expect_failure(folder, {"compare", "nothing.ply", "nothing.ply", "--distances", "missing/a.ply"}, 4, "missing/a.ply");
  expect_failure(folder, {"compare", "nothing.ply", "nothing.ply", "--distances", "a.xyz"}, 4, "a.xyz");
  expect_failure(folder, {"render", "nothing.ply", "-o", "missing/a.png"}, 4, "missing/a.png");
  expect_failure(folder, {"view", "nothing.ply", "-o", "missing/a.html"}, 4, "missing/a.html");
}

TEST(CliCannotWrite, ReportProblemsAreFoundBeforeTheRun) {
  const files::Folder folder;
  for (const std::string report : {"missing/r.json", "."}) {
    expect_failure(folder, {"mesh", kEndless, "-o", "out.ply", "--iso", "127", "--report", report}, 4, report);
  }
}

TEST(CliCannotWrite, ReadOnlyFolder) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const files::Folder folder;
  ASSERT_EQ(::chmod(folder.path().c_str(), 0500), 0);
  expect_failure(folder, mesh(kSmall), 4, "out.ply");
  ::chmod(folder.path().c_str(), 0700);
}

TEST(CliCannotWrite, FilesOfLimitedSize) {
  const files::Folder folder;
  program::Setup setup;
  setup.file_limit = 4096;
  for (const std::string output :
       {"out.ply", "out.stl", "out.obj", "out.off", "out.glb", "out.vtp", "out.3mf", "out.precomputed"}) {
    expect_failure(folder, {"mesh", "generate:sphere:48x48x48", "-o", output, "--iso", "0", "--error", "0"}, 4, output,
                   setup);
  }
  expect_failure(folder, {"generate", "sphere", "-o", "s.nrrd", "--size", "48"}, 4, "s.nrrd", setup);
}

TEST(CliCannotWrite, DiskFull) {
  const files::Folder folder;
  if (::mount("none", folder.path().c_str(), "tmpfs", 0, "size=64k") != 0) GTEST_SKIP() << "may not mount a small disk";
  for (const std::string output :
       {"out.ply", "out.stl", "out.obj", "out.off", "out.glb", "out.vtp", "out.3mf", "out.precomputed"}) {
    expect_failure(folder, {"mesh", "generate:sphere:64x64x64", "-o", output, "--iso", "0", "--error", "0"}, 4, output);
  }
  expect_failure(folder, {"generate", "sphere", "-o", "s.nrrd", "--size", "64"}, 4, "s.nrrd");
  EXPECT_EQ(::umount(folder.path().c_str()), 0);
}

TEST(CliCannotWrite, StandardOutputIsFull) {
  if (::access("/dev/full", W_OK) != 0) GTEST_SKIP() << "no /dev/full";
  const files::Folder folder;
  program::Setup setup;
  setup.out_path = "/dev/full";
  expect_failure(folder, {"info", kSmall, "--json"}, 4, "standard output", setup);
  expect_failure(folder, {"info", kSmall}, 4, "standard output", setup);
  expect_failure(folder, {"--help"}, 4, "standard output", setup);
  expect_failure(folder, {"--version"}, 4, "standard output", setup);
}

TEST(CliDevice, WithoutOneARunByCudaEndsWithItsOwnCode) {
  const files::Folder folder;
  if (run(folder.path(), mesh(kSmall, {"--device", "cuda"})).code == 0) {
    GTEST_SKIP() << "there is a CUDA device";
  }
  expect_failure(folder, mesh(kSmall, {"--device", "cuda"}), 6, "CUDA");
}

TEST(CliDevice, WhatTakesProcessorsIsRefused) {
  const files::Folder folder;
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--triangles", "9"}, {"--lods", "0.1,0.2"}, {"--schedule", "queue"}}) {
    std::vector<std::string> arguments = mesh(kSmall, {"--device", "cuda"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Result result = run(folder.path(), arguments);
    EXPECT_EQ(result.code, 2) << result.err;
    EXPECT_NE(result.err.find("which takes processors"), std::string::npos) << result.err;
    EXPECT_EQ(listing(folder), std::vector<std::string>{});
  }
}

// Sends the signal once the output has been begun.
void expect_interrupted(const std::vector<std::string>& arguments, int signal) {
  const files::Folder folder;
  program::Setup setup;
  setup.signal = signal;
  setup.ready = [&](pid_t process) { return program::has_file_open_in(process, folder); };
  expect_failure(folder, arguments, 130, "interrupted", setup);
  EXPECT_EQ(listing(folder), std::vector<std::string>{});
}

TEST(CliInterrupted, NothingIsLeftBehind) {
  for (const int signal : {SIGINT, SIGTERM}) {
    expect_interrupted({"mesh", kEndless, "-o", "out.ply", "--iso", "127", "--report", "out.json"}, signal);
    expect_interrupted({"mesh", kEndless, "-o", "out.stl", "--iso", "127", "--schedule", "queue"}, signal);
    expect_interrupted({"mesh", kEndless, "-o", "out.ply", "--iso", "auto", "--report", "out.json"}, signal);
    expect_interrupted({"generate", "smooth", "-o", "out.nrrd", "--size", "64x64x100000000"}, signal);
  }
}

TEST(CliInterrupted, AnOlderFileStays) {
  const files::Folder folder;
  files::write_bytes(folder / "out.ply", "precious");
  program::Setup setup;
  setup.signal = SIGINT;
  setup.ready = [&](pid_t process) { return program::has_file_open_in(process, folder); };
  expect_failure(folder, {"mesh", kEndless, "-o", "out.ply", "--iso", "127"}, 130, "interrupted", setup);
  EXPECT_EQ(files::read_bytes(folder / "out.ply"), "precious");
}

TEST(CliInterrupted, InfoEndsAtOnce) {
  const files::Folder folder;
  const auto start = std::chrono::steady_clock::now();
  program::Setup setup;
  setup.signal = SIGTERM;
  // It leaves no trace to wait for; long enough to have begun under a sanitizer, too.
  setup.ready = [&](pid_t) { return std::chrono::steady_clock::now() - start > std::chrono::seconds(2); };
  expect_failure(folder, {"info", kEndless}, 130, "interrupted", setup);
}

}  // namespace
}  // namespace isoweave::testing::cli_failures_test
