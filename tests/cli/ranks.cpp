// isoweave-mpi under the programs that start ranks: OpenMPI and MPICH.
#include <gtest/gtest.h>
#include <sys/types.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_ranks_test {
namespace {

using program::listing;
using program::Result;
using program::run;
using Words = std::vector<std::string>;

struct Mpi {
  const char* name;
  const char* run;      // the program that starts ranks
  const char* program;  // isoweave-mpi for it
};

void PrintTo(const Mpi& mpi, std::ostream* out) { *out << mpi.name; }

Words with(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

const std::string kVolume = "generate:noise:72x60x80";

Words mesh(const Words& more) {
  return with({"mesh", kVolume, "--iso", "0.5", "-o", "out.ply", "--report", "out.json", "--threads", "1", "--quiet"},
              more);
}

nlohmann::json report_in(const files::Folder& folder) {
  return nlohmann::json::parse(files::read_bytes(folder / "out.json"));
}

class Ranks : public ::testing::TestWithParam<Mpi> {
 protected:
  // As many ranks as a test wants, for any user, on any machine.
  program::Setup setup() const {
    program::Setup setup;
    setup.program = GetParam().run;
    setup.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                         "OMPI_MCA_rmaps_base_oversubscribe=1", "OMPI_MCA_orte_execute_quiet=1"};
    return setup;
  }

  Words ranks(int count, const Words& arguments) const {
    return with({"-n", std::to_string(count), GetParam().program}, arguments);
  }

  Result run_ranks(const files::Folder& folder, int count, const Words& arguments) const {
    return run(folder.path(), ranks(count, arguments), setup());
  }

  // One line of the program, whatever the one that starts ranks says besides.
  static void expect_one_line(const Result& result, int code, const std::string& says) {
    EXPECT_EQ(result.code, code) << result.err;
    const std::size_t first = result.err.find("isoweave: ");
    ASSERT_NE(first, std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("isoweave: ", first + 1), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
  }

  // The mesh of one process.
  static std::string digest() {
    const files::Folder folder;
    EXPECT_EQ(run(folder.path(), mesh({})).code, 0);
    return report_in(folder).at("digest");
  }
};

TEST_P(Ranks, GiveTheMeshOfOneProcess) {
  const std::string expected = digest();
  for (const int count : {1, 2, 3, 4, 8}) {
    const files::Folder folder;
    const Result result = run_ranks(folder, count, mesh({"--blocks", "24"}));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    const nlohmann::json report = report_in(folder);
    EXPECT_EQ(report.at("digest"), expected) << count;
    ASSERT_EQ(report.at("ranks").size(), static_cast<std::size_t>(count));
    std::uint64_t taken = 0;
    for (const nlohmann::json& rank : report.at("ranks")) taken += rank.at("triangles").get<std::uint64_t>();
    std::uint64_t all = 0;
    for (const nlohmann::json& stage : report.at("blocks")) all += stage.at("triangles").get<std::uint64_t>();
    EXPECT_EQ(taken, all);
    EXPECT_EQ(listing(folder), (Words{"out.json", "out.ply"}));
    // The file is what the report says.
    const Result check = run(folder.path(), {"check", "out.ply"});
    EXPECT_NE(check.out.find(expected), std::string::npos) << check.out;
  }
}

TEST_P(Ranks, EndAtANumberOrAShareOfAllTriangles) {
  for (const Words& stop : {Words{"--triangles", "100k"}, Words{"--ratio", "30%"}}) {
    const files::Folder folder;
    ASSERT_EQ(run(folder.path(), mesh(stop)).code, 0);
    const nlohmann::json one = report_in(folder);
    const Result result = run_ranks(folder, 3, with(mesh(stop), {"--blocks", "24"}));
    ASSERT_EQ(result.code, 0) << result.err;
    for (const char* const key : {"digest", "triangles", "error", "target"}) {
      EXPECT_EQ(report_in(folder).at(key), one.at(key)) << key;
    }
  }
}

TEST_P(Ranks, WriteOtherFormatsAndLevels) {
  const files::Folder folder;
  const Words levels{"mesh", kVolume, "--iso", "0.5", "--lods", "0,0.1vox,0.3vox", "-o", "a.glb", "--quiet"};
  ASSERT_EQ(run(folder.path(), with(levels, {"--report", "one.json"})).code, 0);
  ASSERT_EQ(run_ranks(folder, 3, with(levels, {"--report", "three.json", "--blocks", "24"})).code, 0);
  const auto read = [&](const char* name) { return nlohmann::json::parse(files::read_bytes(folder / name)); };
  const nlohmann::json one = read("one.json"), three = read("three.json");
  EXPECT_EQ(three.at("digest"), one.at("digest"));
  ASSERT_EQ(three.at("levels").size(), one.at("levels").size());
  for (std::size_t level = 0; level < one.at("levels").size(); ++level) {
    EXPECT_EQ(three.at("levels")[level].at("digest"), one.at("levels")[level].at("digest"));
  }
}

TEST_P(Ranks, WriteAnOctreeAsOneProcessDoes) {
  const files::Folder folder;
  const auto levels = [&](const std::string& name) {
    return Words{"mesh",       kVolume,      "--iso", "0.5", "--lods", "0,0.3vox",
                 "--one-file", "--compress", "-o",    name,  "--quiet"};
  };
  const Result one = run(folder.path(), levels("one.precomputed"));
  if (one.code == 4) GTEST_SKIP() << one.err;
  ASSERT_EQ(run_ranks(folder, 3, with(levels("three.precomputed"), {"--blocks", "24"})).code, 0);
  for (const char* file : {"/info", "/0.shard"}) {
    const std::string expected = files::read_bytes(folder / (std::string("one.precomputed") + file));
    EXPECT_TRUE(files::read_bytes(folder / (std::string("three.precomputed") + file)) == expected) << file;
  }
}

TEST_P(Ranks, FailWithOneLineAndLeaveNothing) {
  const files::Folder folder;
  expect_one_line(run_ranks(folder, 3, {"mesh", "no.nrrd", "--iso", "1", "-o", "out.ply"}), 3,
                  "no.nrrd: cannot be opened");
  expect_one_line(run_ranks(folder, 3, {"mesh", "--iso", "1"}), 2, "VOLUME is required");
  expect_one_line(run_ranks(folder, 3, {"info", "no.nrrd"}), 2, "expected one of mesh");
  expect_one_line(run_ranks(folder, 2, mesh({"--max-distance", "1vox"})), 2,
                  "isoweave-mpi: expected a run without --max-distance");
  expect_one_line(run_ranks(folder, 2, mesh({"--ratio", "2"})), 2, "--ratio");
  expect_one_line(run_ranks(folder, 2, mesh({"--labels", "all"})), 2, "--labels");
  expect_one_line(run_ranks(folder, 2, mesh({"--html", "out.html"})), 2, "--html");
  expect_one_line(run_ranks(folder, 2, mesh({"-o", "none/out.ply"})), 2, "--output");
  expect_one_line(run_ranks(folder, 2, {"mesh", kVolume, "--iso", "0.5", "-o", "none/out.ply"}), 4, "none/out.ply");
  expect_one_line(run_ranks(folder, 2, {"mesh", kVolume, "--iso", "9", "-o", "out.ply"}), 3, "iso");
  expect_one_line(run_ranks(folder, 2, mesh({"--memory", "1M"})), 5, "1000000 bytes");
  EXPECT_TRUE(listing(folder).empty());
}

// A file that one rank does not see ends all of them, whichever rank it is.
TEST_P(Ranks, AFileThatOneRankDoesNotSeeEndsAll) {
  for (const bool first : {true, false}) {
    const files::Folder folder;
    std::filesystem::create_directory(folder / "with");
    std::filesystem::create_directory(folder / "without");
    ASSERT_EQ(run(folder / "with", {"generate", "noise", "--size", "40x40x40", "--type", "uint8", "-o", "a.raw"}).code,
              0);
    const auto part = [&](int count, const char* where) {
      return Words{"-n",
                   std::to_string(count),
                   "-wdir",
                   folder / where,
                   GetParam().program,
                   "mesh",
                   "a.raw",
                   "--raw",
                   "40x40x40:uint8",
                   "--iso",
                   "127",
                   "-o",
                   "a.ply"};
    };
    Words words = part(first ? 1 : 2, first ? "without" : "with");
    words.emplace_back(":");
    const Result result = run(folder.path(), with(words, part(first ? 2 : 1, first ? "with" : "without")), setup());
    expect_one_line(result, 3, "a.raw: cannot be opened");
    EXPECT_EQ(listing(folder / "with"), Words{"a.raw"});
    EXPECT_TRUE(listing(folder / "without").empty());
  }
}

// The processes that belong to a folder: ranks that work there.
std::vector<pid_t> ranks_in(const files::Folder& folder) {
  std::vector<pid_t> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", error)) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const auto where = std::filesystem::read_symlink(entry.path() / "cwd", error);
    std::string command;
    std::ifstream(entry.path() / "comm") >> command;
    if (!error && where == folder.path() && command.starts_with("isoweave-mpi")) found.push_back(std::stoi(name));
  }
  return found;
}

// Waits until a rank has begun: on a busy machine that takes seconds.
void wait_for_ranks(const files::Folder& folder) {
  for (int n = 0; n < 6000 && ranks_in(folder).empty(); ++n) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

TEST_P(Ranks, AKilledRankLosesNothing) {
  const std::string expected = digest();
  const files::Folder folder;
  std::mt19937 random(3);
  const Words arguments = mesh({"--blocks", "24", "--checkpoint", "run"});
  constexpr int kKills = 6;
  int killed = 0;
  for (int n = 0; n < kKills; ++n) {
    const int count = 1 + static_cast<int>(random() % 3);
    program::Running job(folder.path(), ranks(count, arguments), setup());
    wait_for_ranks(folder);
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % 300));
    const std::vector<pid_t> found = ranks_in(folder);
    if (!found.empty() && ::kill(found[random() % found.size()], SIGKILL) == 0) ++killed;
    if (job.wait().code == 0) break;
    if (!std::filesystem::exists(folder / "out.ply")) continue;
    // Killed with nothing left to do but to end: the file is complete.
    const Result check = run(folder.path(), {"check", "out.ply"});
    EXPECT_NE(check.out.find(expected), std::string::npos) << check.out << check.err;
    break;
  }
  EXPECT_GT(killed, 0);
  const Result last = run_ranks(folder, 2, arguments);
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_EQ(report_in(folder).at("digest"), expected);
  EXPECT_EQ(listing(folder), (Words{"out.json", "out.ply", "run"}));
  EXPECT_TRUE(listing(folder / "run").empty());
}

// Starts a rank by a shell that leaves the rank's exit code in a file.
Words noting_codes(Words ranks) {
  const auto program = std::find_if(ranks.begin(), ranks.end(), [](const std::string& word) { return word[0] == '/'; });
  ranks.insert(program, {"/bin/sh", "-c", R"(trap : TERM; "$0" "$@"; code=$?; echo $code > "code.$$"; exit $code)"});
  return ranks;
}

void expect_ranks_ended_with(const files::Folder& folder, int code, std::size_t count) {
  std::size_t found = 0;
  for (const std::string& name : listing(folder)) {
    if (!name.starts_with("code.")) continue;
    EXPECT_EQ(files::read_bytes(folder / name), std::to_string(code) + "\n");
    ++found;
  }
  EXPECT_EQ(found, count);
}

TEST_P(Ranks, AnInterruptedJobGoesOnWithOtherRanks) {
  const files::Folder folder;
  const auto arguments = [](const char* blocks) {
    Words words{"mesh",     "generate:noise:96x96x96",
                "--iso",    "0.5",
                "-o",       "out.ply",
                "--report", "out.json",
                "--quiet",  "--threads",
                "1",        "--checkpoint",
                "run"};
    return *blocks == '\0' ? words : with(words, {"--blocks", blocks});
  };
  program::Setup interrupted = setup();
  interrupted.signal = SIGTERM;
  interrupted.ready = [&](pid_t) { return std::filesystem::exists(folder / "run/3.rest"); };
  const Result result = run(folder.path(), noting_codes(ranks(3, arguments("32"))), interrupted);
  // The mpiexec of MPICH ends with 0 now and then when it is stopped itself: its ranks are asked. Those of OpenMPI
  // cannot be, as all that it started is killed soon.
  if (GetParam().name == std::string("Mpich")) {
    expect_ranks_ended_with(folder, 130, 3);
  } else {
    EXPECT_NE(result.code, 0);
  }
  EXPECT_NE(result.err.find("the same command goes on with what is in run"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out.ply"));
  // The size of blocks is that of the results.
  const Result last = run(folder.path(), ranks(2, arguments("")), setup());
  ASSERT_EQ(last.code, 0) << last.err;
  EXPECT_EQ(report_in(folder).at("blocks")[0].at("size"), 32);
  const files::Folder other;
  ASSERT_EQ(run(other.path(),
                {"mesh", "generate:noise:96x96x96", "--iso", "0.5", "-o", "out.ply", "--report", "out.json", "--quiet"})
                .code,
            0);
  EXPECT_EQ(report_in(folder).at("digest"), report_in(other).at("digest"));
}

const std::vector<Mpi> kMpis{
#ifdef ISOWEAVE_OPENMPI_RUN
    {"OpenMpi", ISOWEAVE_OPENMPI_RUN, ISOWEAVE_OPENMPI_BINARY},
#endif
#ifdef ISOWEAVE_MPICH_RUN
    {"Mpich", ISOWEAVE_MPICH_RUN, ISOWEAVE_MPICH_BINARY},
#endif
};

INSTANTIATE_TEST_SUITE_P(Mpis, Ranks, ::testing::ValuesIn(kMpis), [](const auto& one) { return one.param.name; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(Ranks);

}  // namespace
}  // namespace isoweave::testing::cli_ranks_test
