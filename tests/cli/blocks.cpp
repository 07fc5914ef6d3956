// Meshes in blocks, and by tasks that many processes share: killed, restarted, with files that do not belong there.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::cli_blocks_test {
namespace {

using program::expect_failed;
using program::listing;
using program::Result;
using program::run;
using Words = std::vector<std::string>;

const std::string kVolume = testing::kSanitized ? "generate:noise:40x36x44" : "generate:noise:72x60x80";
// About a quarter of its triangles at a half.
const std::string kNumber = testing::kSanitized ? "20000" : "100000";

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

Words mesh(const Words& more) {
  return with({"mesh", kVolume, "--iso", "0.5", "-o", "out.ply", "--report", "out.json", "--quiet"}, more);
}

nlohmann::json report_in(const files::Folder& folder, const std::string& name = "out.json") {
  return nlohmann::json::parse(files::read_bytes(folder / name));
}

std::string digest_of_sweep() {
  const files::Folder folder;
  EXPECT_EQ(run(folder.path(), mesh({})).code, 0);
  return report_in(folder).at("digest");
}

TEST(CliBlocks, GiveTheMeshOfTheSweepAndSayWhatTheyHandedOn) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), mesh({"--blocks", "24"})).code, 0);
  const nlohmann::json report = report_in(folder);
  EXPECT_EQ(report.at("digest"), digest_of_sweep());
  const nlohmann::json& stages = report.at("blocks");
  ASSERT_GE(stages.size(), 3U);
  EXPECT_EQ(stages[0].at("size"), 24);
  EXPECT_EQ(stages[0].at("triangles"), report.at("triangles_extracted"));
  EXPECT_LT(stages[1].at("triangles"), stages[0].at("triangles"));
  EXPECT_EQ(listing(folder), (Words{"out.json", "out.ply"}));
}

TEST(CliBlocks, StopAtANumberAsSlabsDo) {
  const files::Folder folder;
  for (const Words& stop : {Words{"--triangles", "1000"}, Words{"--ratio", "10%"}}) {
    const auto digest = [&](const Words& more) -> std::string {
      const Result meshed = run(folder.path(), with(mesh(stop), more));
      EXPECT_EQ(meshed.code, 0) << meshed.err;
      return report_in(folder).at("digest");
    };
    EXPECT_EQ(digest({"--blocks", "24"}), digest({}));
  }
}

TEST(CliBlocks, TakeOverWhereSlabsDoNotFit) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer takes memory of its own";
  const files::Folder folder;
  const std::string size = "2400x2400x12";
  ASSERT_EQ(run(folder.path(), {"generate", "sphere", "--size", size, "--type", "uint16", "-o", "a.raw"}).code, 0);
  const Words mesh{"mesh", "a.raw", "--raw", size + ":uint16", "--iso", "127.5", "-o", "a.ply", "--threads", "1"};
  expect_failed(run(folder.path(), with(mesh, {"--memory", "80M", "--blocks", "off"})), 5, "expected --memory");
  const Result blocks = run(folder.path(), with(mesh, {"--memory", "80M"}));
  EXPECT_EQ(blocks.code, 0) << blocks.err;
  EXPECT_NE(blocks.err.find("--memory 80M: too little for slabs, so blocks of "), std::string::npos) << blocks.err;
  EXPECT_LT(blocks.peak_bytes, 80'000'000U);
  for (const Words& stop : {Words{"--triangles", "1000"}, Words{"--ratio", "1%"}}) {
    const Result few = run(folder.path(), with(with(mesh, stop), {"--memory", "80M"}));
    EXPECT_EQ(few.code, 0) << few.err;
    EXPECT_NE(few.err.find("so blocks of "), std::string::npos) << few.err;
    EXPECT_LT(few.peak_bytes, 80'000'000U);
  }
  EXPECT_EQ(listing(folder), (Words{"a.ply", "a.raw"}));
}

TEST(CliBlocks, AreRefusedWithWhatTheyDoNotHave) {
  const files::Folder folder;
  expect_failed(run(folder.path(), mesh({"--blocks", "7"})), 2, "--blocks");
  expect_failed(run(folder.path(), mesh({"--blocks", "24", "--extractor", "dual"})), 2,
                "--blocks: expected a run without --extractor dual");
  expect_failed(run(folder.path(), mesh({"--blocks", "24", "--max-distance", "1vox"})), 2, "--max-distance");
  expect_failed(run(folder.path(), mesh({"--blocks", "24", "--dry-run"})), 2, "--dry-run");
  expect_failed(run(folder.path(), with({"mesh", kVolume, "--iso", "0.4,0.5", "-o", "a.ply"}, {"--blocks", "24"})), 2,
                "--blocks");
  // A stream has to be read from its beginning.
  ASSERT_EQ(run(folder.path(), {"generate", "sphere", "--size", "24", "--type", "uint8", "-o", "a.raw"}).code, 0);
  ASSERT_EQ(std::system(("gzip -k '" + folder / "a.raw'").c_str()), 0);
  const Words packed{"mesh", "a.raw.gz", "--raw", "24x24x24:uint8", "--iso", "127.5", "-o", "b.ply", "--blocks", "12"};
  expect_failed(run(folder.path(), packed), 3, "a.raw.gz: expected a volume that can be read anywhere");
  EXPECT_EQ(listing(folder), (Words{"a.raw", "a.raw.gz"}));
}

// A folder with the tasks of the mesh.
void plan(const files::Folder& folder, const std::string& block) {
  const Result planned = run(folder.path(), {"plan", kVolume, "--iso", "0.5", "--blocks", block, "-o", "tasks"});
  ASSERT_EQ(planned.code, 0) << planned.err;
}

void expect_collected(const files::Folder& folder) {
  const Result collected = run(folder.path(), {"collect", "tasks", "-o", "out.ply", "--report", "out.json", "--quiet"});
  ASSERT_EQ(collected.code, 0) << collected.err;
  EXPECT_EQ(report_in(folder).at("digest"), digest_of_sweep());
  EXPECT_EQ(run(folder.path(), {"check", "out.ply"}).code, 0);
}

TEST(CliTasks, KilledWorkersLoseNothing) {
  const files::Folder folder;
  plan(folder, "24");
  std::mt19937 random(5);
  constexpr int kKills = testing::kSanitized ? 3 : 20;
  for (int n = 0; n < kKills; ++n) {
    std::vector<std::unique_ptr<program::Running>> workers;
    for (int worker = 0; worker < 2; ++worker) {
      workers.push_back(std::make_unique<program::Running>(folder.path(), Words{"work", "tasks", "--threads", "1"}));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 120));
    workers.clear();  // killed
  }
  ASSERT_EQ(run(folder.path(), {"work", "tasks", "--quiet"}).code, 0);
  expect_collected(folder);
}

TEST(CliTasks, AWorkerThatIsInterruptedSaysThatItsTasksStay) {
  const files::Folder folder;
  plan(folder, testing::kSanitized ? "16" : "24");
  program::Setup setup;
  setup.signal = SIGINT;
  setup.ready = [&](pid_t) { return std::filesystem::exists(folder / "tasks/3.rest"); };
  const Result worker = run(folder.path(), {"work", "tasks", "--threads", "1", "--quiet"}, setup);
  expect_failed(worker, 130, "tasks that are done stay done, and isoweave work tasks goes on with the others");
  EXPECT_TRUE(std::filesystem::exists(folder / "tasks/0.rest"));
  ASSERT_EQ(run(folder.path(), {"work", "tasks", "--quiet"}).code, 0);
  expect_collected(folder);
}

TEST(CliTasks, OneByOneInTheOrderOfStages) {
  const files::Folder folder;
  plan(folder, "40");
  const auto status = [&] {
    return nlohmann::json::parse(run(folder.path(), {"status", "tasks", "--json"}).out).at("stages");
  };
  const nlohmann::json stages = status();
  const std::uint64_t first = stages[0].at("tasks");
  expect_failed(run(folder.path(), {"work", "tasks", "--task", std::to_string(first)}), 3,
                "expected all tasks of that stage to be done");
  expect_failed(run(folder.path(), {"collect", "tasks", "-o", "out.ply"}), 3, "found task 0 undone");
  std::uint64_t count = 0;
  for (const nlohmann::json& stage : stages) count += stage.at("tasks").get<std::uint64_t>();
  expect_failed(run(folder.path(), {"work", "tasks", "--task", std::to_string(count)}), 2, "--task");
  for (std::uint64_t task = 0; task < count; ++task) {
    ASSERT_EQ(run(folder.path(), {"work", "tasks", "--task", std::to_string(task)}).code, 0);
  }
  for (const nlohmann::json& stage : status()) EXPECT_EQ(stage.at("done"), stage.at("tasks"));
  expect_collected(folder);
}

nlohmann::json report_to(const files::Folder& folder, const Words& words) {
  const Result result = run(folder.path(), with(words, {"-o", "out.ply", "--report", "out.json", "--quiet"}));
  EXPECT_EQ(result.code, 0) << result.err;
  return report_in(folder);
}

TEST(CliTasks, EndAtANumberOrAShareOfAllTriangles) {
  const Words more_than_all{"--triangles", "10000k"};
  for (const Words& stop : {Words{"--triangles", kNumber}, more_than_all, Words{"--ratio", "30%"}}) {
    const files::Folder folder;
    const Words surface = with({kVolume, "--iso", "0.5"}, stop);
    const nlohmann::json one = report_to(folder, with({"mesh"}, surface));
    ASSERT_EQ(run(folder.path(), with(with({"plan"}, surface), {"--blocks", "24", "-o", "tasks"})).code, 0);
    ASSERT_EQ(run(folder.path(), {"work", "tasks", "--quiet"}).code, 0);
    const nlohmann::json collected = report_to(folder, {"collect", "tasks"});
    for (const char* const key : {"digest", "triangles", "error", "target"}) {
      EXPECT_EQ(collected.at(key), one.at(key)) << key;
    }
  }
}

// A forecast is a guess: here a plan has one that leaves too little.
TEST(CliTasks, ThatWentTooFarAreDoneAgain) {
  const files::Folder folder;
  const Words surface{kVolume, "--iso", "0.5", "--triangles", kNumber};
  const nlohmann::json one = report_to(folder, with({"mesh"}, surface));
  ASSERT_EQ(run(folder.path(), with(with({"plan"}, surface), {"--blocks", "24", "-o", "tasks", "--quiet"})).code, 0);
  nlohmann::json plan = nlohmann::json::parse(files::read_bytes(folder / "tasks/plan.json"));
  const double forecast = plan.at("head_start");
  EXPECT_GT(forecast, 0);
  plan["head_start"] = 10 * forecast;
  files::write_bytes(folder / "tasks/plan.json", plan.dump());
  ASSERT_EQ(run(folder.path(), {"work", "tasks", "--quiet"}).code, 0);
  const Result refused = run(folder.path(), {"collect", "tasks", "-o", "far.ply"});
  expect_failed(refused, 3, "tasks: expected tasks that leave more than " + kNumber + " triangles, found ");
  expect_failed(refused, 3, ": the plan has a lower error now: isoweave work tasks, then collect again");
  EXPECT_FALSE(std::filesystem::exists(folder / "far.ply"));
  expect_failed(run(folder.path(), {"collect", "tasks", "-o", "far.ply"}), 3, "found task 0 undone");
  ASSERT_EQ(run(folder.path(), {"work", "tasks", "--quiet"}).code, 0);
  EXPECT_EQ(report_to(folder, {"collect", "tasks"}).at("digest"), one.at("digest"));
}

// Holds task 0 as a process that works on it does, until release().
class HeldTask {
 public:
  explicit HeldTask(const files::Folder& folder)
      : file_(::open((folder / "tasks/0.lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    EXPECT_EQ(::flock(file_, LOCK_EX | LOCK_NB), 0);
  }
  ~HeldTask() { release(); }
  HeldTask(const HeldTask&) = delete;
  HeldTask& operator=(const HeldTask&) = delete;

  void release() {
    if (file_ >= 0) ::close(file_);
    file_ = -1;
  }

 private:
  int file_;
};

TEST(CliTasks, OneOfAnotherProcessIsRefusedOrWaitedFor) {
  const files::Folder folder;
  plan(folder, "80");
  HeldTask held(folder);
  expect_failed(run(folder.path(), {"work", "tasks", "--task", "0"}), 4, "another process works on task 0");
  expect_failed(run(folder.path(), {"work", "tasks", "--wait"}), 2, "--wait");
  program::Running second(folder.path(), {"work", "tasks", "--task", "0", "--wait"});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  EXPECT_FALSE(second.has_ended());
  held.release();
  EXPECT_EQ(second.wait().code, 0);
  EXPECT_TRUE(std::filesystem::exists(folder / "tasks/0.rest"));
}

TEST(CliTasks, WaitingForOneEndsWithTheSignalToStop) {
  const files::Folder folder;
  plan(folder, "80");
  const HeldTask held(folder);
  program::Running second(folder.path(), {"work", "tasks", "--task", "0", "--wait"});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  ::kill(second.process(), SIGINT);
  expect_failed(second.wait(), 130, "interrupted while another process works on the task");
}

TEST(CliTasks, MakeWorksOnThem) {
  const files::Folder folder;
  plan(folder, "40");
  const std::string program = std::filesystem::absolute(ISOWEAVE_BINARY).string();
  const std::string make = "make -s -j3 -C '" + folder / "tasks' ISOWEAVE='" + program + "'";
  ASSERT_EQ(std::system(make.c_str()), 0);
  for (const std::string lost : {"tasks/0.final", "tasks/1.rest"}) {
    std::filesystem::remove(folder / lost);
    ASSERT_EQ(std::system(make.c_str()), 0);
    EXPECT_TRUE(std::filesystem::exists(folder / lost)) << lost;
  }
  ASSERT_EQ(std::system(("sh -n '" + folder / "tasks/slurm.sh'").c_str()), 0);
  expect_collected(folder);
}

TEST(CliTasks, OtherFoldersAndVolumesAreRefused) {
  const files::Folder folder;
  expect_failed(run(folder.path(), {"work", "nothing"}), 3, "nothing/plan.json: expected the plan");
  ASSERT_EQ(run(folder.path(), {"generate", "sphere", "--size", "24", "--type", "uint8", "-o", "a.nrrd"}).code, 0);
  const Words plan{"plan", "a.nrrd", "--iso", "127.5", "--blocks", "16", "-o", "tasks"};
  ASSERT_EQ(run(folder.path(), plan).code, 0);
  expect_failed(run(folder.path(), plan), 4, "tasks: expected a new or empty folder");
  expect_failed(run(folder.path(), with(plan, {"--max-distance", "1vox"})), 2, "--max-distance");
  ASSERT_EQ(run(folder.path(), {"work", "tasks", "--task", "0"}).code, 0);
  // The result of a task of another mesh.
  ASSERT_EQ(run(folder.path(), {"generate", "box", "--size", "24", "--type", "uint8", "-o", "b.nrrd"}).code, 0);
  ASSERT_EQ(run(folder.path(), {"plan", "b.nrrd", "--iso", "127.5", "--blocks", "16", "-o", "others"}).code, 0);
  for (const std::string file : {"/0.final", "/0.rest"}) {
    std::filesystem::copy(folder / ("tasks" + file), folder / ("others" + file));
  }
  expect_failed(run(folder.path(), {"work", "others", "--quiet"}), 3, "others/0.rest: belongs to another mesh");
  files::write_bytes(folder / "tasks/plan.json", "{}");
  expect_failed(run(folder.path(), {"status", "tasks"}), 3, "tasks/plan.json");
}

// Replaces the samples of a volume whose tasks are done, and puts them back as they were.
void expect_changes_refused(const files::Folder& folder, const std::string& volume, const std::string& samples) {
  ASSERT_EQ(run(folder.path(), {"plan", volume, "--iso", "127.5", "--blocks", "16", "-o", "tasks", "--quiet"}).code, 0);
  ASSERT_EQ(run(folder.path(), {"work", "tasks", "--quiet"}).code, 0);
  const std::string bytes = files::read_bytes(folder / samples);
  const auto changed = std::filesystem::last_write_time(folder / samples);
  std::string others = bytes;
  others.back() = '\x7f';
  files::write_bytes(folder / samples, others);
  std::filesystem::last_write_time(folder / samples, changed + std::chrono::seconds(1));
  const std::string says = volume + ": changed since it was planned in tasks/plan.json: expected ";
  for (const Words& words : {Words{"work", "tasks"}, Words{"work", "tasks", "--task", "0"}, Words{"status", "tasks"},
                             Words{"collect", "tasks", "-o", "a.ply"}}) {
    expect_failed(run(folder.path(), words), 3, says);
  }
  files::write_bytes(folder / samples, bytes);
  std::filesystem::last_write_time(folder / samples, changed);
  ASSERT_EQ(run(folder.path(), {"collect", "tasks", "-o", "a.ply", "--quiet"}).code, 0);
}

TEST(CliTasks, AreCollectedOverNoFileThatIsToBeKept) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"plan", "generate:sphere:16x16x16", "--iso", "0", "-o", "tasks", "--quiet"}).code, 0);
  ASSERT_EQ(run(folder.path(), {"work", "tasks", "--quiet"}).code, 0);
  const Words collect{"collect", "tasks", "-o", "a.ply", "--report", "a.json", "--no-clobber", "--quiet"};
  for (const std::string name : {"a.ply", "a.json"}) {
    files::write_bytes(folder / name, "kept");
    expect_failed(run(folder.path(), collect), 4, name + ": exists, and --no-clobber keeps it");
    std::filesystem::remove(folder / name);
  }
  EXPECT_EQ(run(folder.path(), collect).code, 0);
}

TEST(CliTasks, OfAVolumeThatHasChangedAreNotDone) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"generate", "sphere", "--size", "24", "--type", "uint8", "-o", "a.nrrd"}).code, 0);
  expect_changes_refused(folder, "a.nrrd", "a.nrrd");
}

TEST(CliTasks, OfAHeaderWhoseSamplesHaveChangedAreNotDone) {
  const files::Folder folder;
  ASSERT_EQ(run(folder.path(), {"generate", "sphere", "--size", "24", "--type", "uint8", "-o", "a.raw"}).code, 0);
  files::write_bytes(folder / "a.nhdr",
                     "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 24 24 24\nencoding: raw\ndata file: a.raw\n");
  expect_changes_refused(folder, "a.nhdr", "a.raw");
}

}  // namespace
}  // namespace isoweave::testing::cli_blocks_test
