// Runs that are killed, interrupted or stopped by a full disk, and go on.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "program.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::cli_checkpoints_test {
namespace {

using program::listing;
using program::Result;
using program::run;

constexpr std::size_t kSide = testing::kSanitized ? 64 : 96;
constexpr std::size_t kSlices = testing::kSanitized ? 112 : 160;
const std::string kSlice = std::to_string(kSide) + "x" + std::to_string(kSide);
const std::string kVolume = "generate:gyroid:" + kSlice + "x" + std::to_string(kSlices) + ":uint8";

std::vector<std::string> mesh(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"mesh", kVolume, "-o", "out.ply", "--iso", "127.5", "--report", "out.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string digest(const std::string& report) {
  return nlohmann::json::parse(files::read_bytes(report)).at("digest").get<std::string>();
}

// Of a run that nothing disturbs.
std::string undisturbed_digest() {
  const files::Folder folder;
  EXPECT_EQ(run(folder.path(), mesh({"--quiet"})).code, 0);
  return digest(folder / "out.json");
}

// Sends the signal some time after the mesh has been begun.
program::Setup after(const files::Folder& folder, int signal, std::chrono::milliseconds delay) {
  using Clock = std::chrono::steady_clock;
  program::Setup setup;
  setup.signal = signal;
  setup.ready = [&folder, delay, begun = std::optional<Clock::time_point>()](pid_t) mutable {
    if (!begun && std::filesystem::exists(folder / "run/mesh.part")) begun = Clock::now();
    return begun && Clock::now() - *begun > delay;
  };
  return setup;
}

TEST(CliCheckpoint, KilledRunsGoOnToTheSameMesh) {
  const auto begun = std::chrono::steady_clock::now();
  const std::string expected = undisturbed_digest();
  // Killed before half of the time that a run takes here and now.
  const auto longest = (std::chrono::steady_clock::now() - begun) / std::chrono::milliseconds(2);
  std::mt19937 random(11);
  int kills = 0;
  for (int trial = 0; trial < (testing::kSanitized ? 1 : 5); ++trial) {
    const files::Folder folder;
    std::vector<std::string> arguments = mesh({"--checkpoint", "run", "--every", "10layers", "--slab", "5"});
    for (int part = 0; part < 100; ++part) {
      const std::chrono::milliseconds delay(std::uniform_int_distribution<std::int64_t>(0, longest)(random));
      const std::chrono::milliseconds patience(longest * part / 20);  // a machine that gets busier must come to an end
      const Result result = run(folder.path(), arguments, after(folder, SIGKILL, delay + patience));
      if (result.code == 0) break;
      ASSERT_EQ(result.signal, SIGKILL) << result.err;
      ++kills;
      if (std::filesystem::exists(folder / "out.ply")) break;  // killed when the mesh was complete
      const std::vector<std::string> left = listing(folder);
      ASSERT_TRUE(left == std::vector<std::string>{} || left == std::vector<std::string>{"run"}) << left[0];
      const bool saved =
          std::filesystem::exists(folder / "run/state-0") || std::filesystem::exists(folder / "run/state-1");
      if (!saved) continue;
      arguments = {"mesh", "--resume", "run", "--threads", std::to_string(1 + random() % 4)};
    }
    const Result check = run(folder.path(), {"check", "out.ply", "--json"});
    ASSERT_EQ(check.code, 0) << check.err;
    EXPECT_EQ(nlohmann::json::parse(check.out).at("digest").get<std::string>(), expected);
  }
  EXPECT_GT(kills, 0);
}

TEST(CliCheckpoint, InterruptedRunsSayHowToGoOn) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const files::Folder folder;
    const Result result = run(folder.path(), mesh({"--checkpoint", "run", "--slab", "2", "--threads", "1"}),
                              after(folder, signal, std::chrono::milliseconds(0)));
    ASSERT_EQ(result.code, 130) << result.err;
    EXPECT_TRUE(program::is_one_line(result.err)) << result.err;
    EXPECT_NE(result.err.find("can be resumed from run"), std::string::npos) << result.err;
    EXPECT_EQ(listing(folder), std::vector<std::string>{"run"});
    ASSERT_EQ(run(folder.path(), {"mesh", "--resume", "run", "--quiet"}).code, 0);
    EXPECT_EQ(digest(folder / "out.json"), undisturbed_digest());
    EXPECT_EQ(listing(folder), (std::vector<std::string>{"out.json", "out.ply", "run"}));
  }
}

TEST(CliCheckpoint, AFullDiskIsNoLoss) {
  const files::Folder folder;
  program::Setup setup;
  setup.file_limit = 900 << 10;
  const Result result =
      run(folder.path(), mesh({"--checkpoint", "run", "--every", "1layers", "--error", "0", "--slab", "2"}), setup);
  ASSERT_EQ(result.code, 4) << result.err;
  EXPECT_EQ(listing(folder), std::vector<std::string>{"run"});
  ASSERT_EQ(run(folder.path(), {"mesh", "--resume", "run", "--quiet"}).code, 0);
  const files::Folder other;
  ASSERT_EQ(run(other.path(), mesh({"--error", "0", "--quiet"})).code, 0);
  EXPECT_EQ(digest(folder / "out.json"), digest(other / "out.json"));
}

TEST(CliCheckpoint, ResumesFromAnywhere) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh({"--checkpoint", "run", "--slab", "2", "--threads", "1"}),
                after(folder, SIGINT, std::chrono::milliseconds(0)))
                .code,
            130);
  ASSERT_EQ(run("/", {"mesh", "--resume", folder / "run", "--quiet"}).code, 0);
  EXPECT_EQ(digest(folder / "out.json"), undisturbed_digest());
}

TEST(CliCheckpoint, DroppedComponentsStayDropped) {
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = mesh({"--largest", "--min-component", "50"});
    arguments[1] = "generate:noise:" + kSlice + "x" + std::to_string(kSlices / 2) + ":uint8";
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const files::Folder whole;
  ASSERT_EQ(run(whole.path(), with({"--quiet"})).code, 0);
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), with({"--checkpoint", "run", "--slab", "2", "--threads", "1"}),
                after(folder, SIGINT, std::chrono::milliseconds(0)))
                .code,
            130);
  ASSERT_EQ(run(folder.path(), {"mesh", "--resume", "run", "--quiet"}).code, 0);
  EXPECT_EQ(files::read_bytes(folder / "out.ply").size(), files::read_bytes(whole / "out.ply").size());
  EXPECT_EQ(digest(folder / "out.json"), digest(whole / "out.json"));
  const nlohmann::json report = nlohmann::json::parse(files::read_bytes(folder / "out.json"));
  EXPECT_EQ(report.at("components"), 1);
  EXPECT_GT(report.at("components_dropped"), 0);
}

// The volume as the second channel of an array of Zarr, in chunks of 8 slices; the first is left out.
void put_array(const files::Folder& folder) {
  const std::string size = kSlice + "x" + std::to_string(kSlices);
  ASSERT_EQ(run(folder.path(), {"generate", "gyroid", "--size", size, "--type", "uint8", "-o", "a.raw"}).code, 0);
  const std::string samples = files::read_bytes(folder / "a.raw");
  std::filesystem::create_directories(folder / "a/deep");
  const std::size_t chunk = 8 * kSide * kSide;
  for (std::size_t n = 0; n < kSlices / 8; ++n) {
    files::write_bytes(folder / ("a/deep/1." + std::to_string(n) + ".0.0"), samples.substr(n * chunk, chunk));
  }
  files::write_bytes(folder / "a/deep/.zattrs", R"({"_ARRAY_DIMENSIONS": ["c", "z", "y", "x"]})");
  files::write_bytes(folder / "a/.zgroup", R"({"zarr_format": 2})");
  const nlohmann::json metadata = {{"zarr_format", 2},      {"shape", {2, kSlices, kSide, kSide}},
                                   {"order", "C"},          {"chunks", {1, 8, kSide, kSide}},
                                   {"dtype", "|u1"},        {"fill_value", 0},
                                   {"compressor", nullptr}, {"filters", nullptr}};
  files::write_bytes(folder / "a/deep/.zarray", metadata.dump());
}

TEST(CliCheckpoint, AnArrayIsResumedByItsPart) {
  const files::Folder folder;
  put_array(folder);
  if (run(folder.path(), {"info", "a"}).err.find("nlohmann") != std::string::npos) GTEST_SKIP() << "built without Zarr";
  const Result result = run(folder.path(),
                            {"mesh", "a", "--dataset", "deep", "--channel", "1", "-o", "out.ply", "--iso", "127.5",
                             "--report", "out.json", "--checkpoint", "run", "--slab", "2", "--threads", "1"},
                            after(folder, SIGINT, std::chrono::milliseconds(0)));
  ASSERT_EQ(result.code, 130) << result.err;
  const std::string metadata = files::read_bytes(folder / "a/deep/.zarray");
  const auto changed = std::filesystem::last_write_time(folder / "a/deep/.zarray");
  files::write_bytes(folder / "a/deep/.zarray", metadata + " ");
  const Result refused = run(folder.path(), {"mesh", "--resume", "run", "--quiet"});
  EXPECT_EQ(refused.code, 3);
  EXPECT_NE(refused.err.find("the volume has changed"), std::string::npos) << refused.err;
  files::write_bytes(folder / "a/deep/.zarray", metadata);
  std::filesystem::last_write_time(folder / "a/deep/.zarray", changed);
  ASSERT_EQ(run(folder.path(), {"mesh", "--resume", "run", "--quiet"}).code, 0);
  EXPECT_EQ(digest(folder / "out.json"), undisturbed_digest());
}

// The slices of the volume as times of a NRRD.
TEST(CliCheckpoint, SlicesThatWereWrittenAsTimesAreResumed) {
  const files::Folder folder;
  const std::string size = kSlice + "x" + std::to_string(kSlices);
  ASSERT_EQ(run(folder.path(), {"generate", "gyroid", "--size", size, "--type", "uint8", "-o", "a.raw"}).code, 0);
  const std::string side = std::to_string(kSide);
  files::write_bytes(folder / "a.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: " + side + " " + side + " 1 " +
                                            std::to_string(kSlices) +
                                            "\nkinds: domain domain domain time\nspacings: 1 1 1 nan\n"
                                            "encoding: raw\n\n" +
                                            files::read_bytes(folder / "a.raw"));
  const Result result = run(folder.path(),
                            {"mesh", "a.nrrd", "--slices-from", "time", "-o", "out.ply", "--iso", "127.5", "--report",
                             "out.json", "--checkpoint", "run", "--slab", "2", "--threads", "1"},
                            after(folder, SIGINT, std::chrono::milliseconds(0)));
  ASSERT_EQ(result.code, 130) << result.err;
  ASSERT_EQ(run(folder.path(), {"mesh", "--resume", "run", "--quiet"}).code, 0);
  EXPECT_EQ(digest(folder / "out.json"), undisturbed_digest());
}

void expect_refused(const files::Folder& folder, const std::vector<std::string>& arguments, int code,
                    const std::string& says) {
  const std::vector<std::string> before = listing(folder);
  const Result result = run(folder.path(), arguments);
  EXPECT_EQ(result.code, code) << result.err;
  EXPECT_TRUE(program::is_one_line(result.err)) << result.err;
  EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
  EXPECT_EQ(listing(folder), before);
}

// A second process in the folder of a run that goes on, whether it would resume or begin.
TEST(CliCheckpoint, AFolderBelongsToOneProcess) {
  const files::Folder folder;
  Result second, third;
  program::Setup setup;
  setup.signal = SIGCONT;  // changes nothing
  setup.ready = [&](pid_t) {
    if (!std::filesystem::exists(folder / "run/state-1")) return false;
    second = run(folder.path(), {"mesh", "--resume", "run", "--slab", "7"});
    third = run(folder.path(), mesh({"--checkpoint", "run"}));
    return true;
  };
  const Result first =
      run(folder.path(), mesh({"--checkpoint", "run", "--every", "1layers", "--slab", "2", "--threads", "1"}), setup);
  ASSERT_EQ(first.code, 0) << first.err;
  for (const Result& refused : {second, third}) {
    EXPECT_EQ(refused.code, 4) << refused.err;
    EXPECT_TRUE(program::is_one_line(refused.err)) << refused.err;
    EXPECT_NE(refused.err.find("run: expected a folder of saved states that nobody uses"), std::string::npos)
        << refused.err;
  }
  EXPECT_EQ(digest(folder / "out.json"), undisturbed_digest());
  EXPECT_EQ(listing(folder), (std::vector<std::string>{"out.json", "out.ply"}));
}

TEST(CliCheckpoint, DamagedPartsAreBadInput) {
  const files::Folder folder;
  program::Setup full_disk;  // ends the run in its middle, however fast it is
  full_disk.file_limit = 900 << 10;
  ASSERT_EQ(
      run(folder.path(), mesh({"--checkpoint", "run", "--every", "1layers", "--error", "0", "--slab", "2"}), full_disk)
          .code,
      4);
  for (const char* part : {"run/mesh.part", "run/faces.part"}) {
    const std::string bytes = files::read_bytes(folder / part);
    ASSERT_FALSE(bytes.empty());
    std::string damaged = bytes;
    damaged[damaged.size() / 3] = static_cast<char>(damaged[damaged.size() / 3] ^ 4);
    for (const std::string& wrong : {damaged, bytes.substr(0, bytes.size() / 2)}) {
      files::write_bytes(folder / part, wrong);
      const Result result = run(folder.path(), {"mesh", "--resume", "run", "--quiet"});
      EXPECT_EQ(result.code, 3) << result.err;
      EXPECT_NE(result.err.find(part), std::string::npos) << result.err;
      EXPECT_EQ(listing(folder), std::vector<std::string>{"run"});
    }
    files::write_bytes(folder / part, bytes);
  }
  EXPECT_EQ(run(folder.path(), {"mesh", "--resume", "run", "--quiet"}).code, 0);
}

TEST(CliCheckpoint, WrongUseIsRefused) {
  const files::Folder folder;
  expect_refused(folder, {"mesh", "--resume", "run"}, 3, "run: expected a folder with a saved state");
  expect_refused(folder, {"mesh", "--resume", "run", "--iso", "3"}, 2, "--iso");
  expect_refused(folder, {"mesh", kVolume, "--resume", "run"}, 2, "VOLUME");
  expect_refused(folder, mesh({"--checkpoint", "run", "--every", "5"}), 2, "--every: expected a number of layers");
  expect_refused(folder, mesh({"--checkpoint", "run", "--every", "0min"}), 2, "--every");
  files::write_bytes(folder / "file", "x");
  expect_refused(folder, mesh({"--checkpoint", "file/run"}), 4, "cannot be created");
  ASSERT_EQ(run(folder.path(), mesh({"--checkpoint", "run", "--slab", "2", "--threads", "1"}),
                after(folder, SIGINT, std::chrono::milliseconds(0)))
                .code,
            130);
  expect_refused(folder, mesh({"--checkpoint", "run"}), 4, "holds an unfinished run");
}

// Folders of states are made before outputs are opened. Those that were there stay.
TEST(CliCheckpoint, RefusedOutputsLeaveNoFolder) {
  const files::Folder folder;
  std::filesystem::create_directories(folder / "old/empty");
  const auto into = [](const char* states, const char* output) {
    return std::vector<std::string>{"mesh",  kVolume,  "-o",        output,         "--iso",
                                    "127.5", "--lods", "1vox,2vox", "--checkpoint", states};
  };
  expect_refused(folder, into("run", "none/out.ply"), 4, "none/out_lod0.ply");
  expect_refused(folder, into("old/new/run", "none/out.ply"), 4, "none/out_lod0.ply");
  expect_refused(folder, into("old/empty/", "none/out.ply"), 4, "none/out_lod0.ply");
  EXPECT_EQ(listing(folder / "old"), std::vector<std::string>{"empty"});
  EXPECT_TRUE(std::filesystem::is_empty(folder / "old/empty"));
}

}  // namespace
}  // namespace isoweave::testing::cli_checkpoints_test
