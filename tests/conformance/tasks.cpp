// Tasks of a mesh, done in any order, at the same time, and again after a crash, give the mesh of the sweep.
// Threads: TaskFolder.SeveralWorkersShareTheTasks:*Tasks.AnyOrder*/noise
#include "isoweave/tasks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <thread>

#include "block_scenes.hpp"
#include "files.hpp"
#include "files/file_lock.hpp"
#include "isoweave/error.hpp"

namespace isoweave::testing::tasks_test {
namespace {

TaskMesh mesh_of(const BlockScene& scene, const std::string& folder, std::int64_t size = 12) {
  TaskMesh mesh{folder, scene.open, scene.options, {}};
  mesh.blocks.size = size;
  mesh.blocks.first = {5, -3, 2};
  return mesh;
}

BlockRun collect(const BlockScene& scene, const TaskMesh& mesh) {
  return run_into_memory(scene, [&](std::span<MeshSink* const> sinks) { return collect_tasks(mesh, sinks); });
}

// Undoes a task: without the second file its process seems to have been killed, without the first it was lost.
void undo(const TaskMesh& mesh, std::uint64_t task, const std::string& file = ".rest") {
  std::filesystem::remove(mesh.folder + "/" + std::to_string(task) + file);
}

// Does all tasks in a random order, those that come too early later, and some of them twice.
void do_all(const TaskMesh& mesh, std::mt19937_64& random) {
  const TaskList tasks = list_tasks(mesh);
  std::vector<std::uint64_t> left(tasks.count());
  std::iota(left.begin(), left.end(), 0U);
  while (!left.empty()) {
    std::shuffle(left.begin(), left.end(), random);
    RunControl control;
    control.threads = 1 + static_cast<int>(random() % 2);
    if (do_task(mesh, left.back(), control) == TaskEnd::kTooEarly) {
      std::erase_if(left, [&](std::uint64_t task) {
        if (tasks.stage_of(task) != tasks.stage_of(*std::min_element(left.begin(), left.end()))) return false;
        do_task(mesh, task, control);
        return true;
      });
      continue;
    }
    EXPECT_TRUE(is_done(mesh, left.back()));
    EXPECT_EQ(do_task(mesh, left.back(), control), TaskEnd::kDoneBefore);
    if (random() % 5 == 0 && left.size() > 1) {
      undo(mesh, left.back(), random() % 2 == 0 ? ".rest" : ".final");
    } else {
      left.pop_back();
    }
  }
}

class Tasks : public ::testing::TestWithParam<BlockScene> {};

TEST_P(Tasks, AnyOrderGivesTheMeshOfTheSweep) {
  std::mt19937_64 random(3);
  const files::Folder folder;
  const TaskMesh mesh = mesh_of(GetParam(), folder.path(), kSanitized ? 24 : 16);
  do_all(mesh, random);
  expect_same(collect(GetParam(), mesh), run_sweep(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Tasks, ::testing::ValuesIn(some_scenes()),
                         [](const auto& one) { return one.param.name; });

TEST(TaskFolder, SeveralWorkersShareTheTasks) {
  const files::Folder folder;
  const TaskMesh mesh = mesh_of(noise_scene(), folder.path());
  const std::uint64_t count = list_tasks(mesh).count();
  const auto work = [&] {
    RunControl control;
    control.threads = 1;
    for (std::uint64_t task = 0; task < count;) {
      const TaskEnd end = do_task(mesh, task, control);
      if (end == TaskEnd::kDone || end == TaskEnd::kDoneBefore || end == TaskEnd::kElsewhere) ++task;
    }
  };
  std::vector<std::thread> workers;
  for (int n = 0; n < 3; ++n) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
  expect_same(collect(noise_scene(), mesh), run_sweep(noise_scene()));
  for (const std::string& name : folder.entries()) EXPECT_FALSE(name.ends_with(".lock")) << name;
}

TEST(TaskFolder, ATaskMayHaveManyFinalTriangles) {
  if (kSanitized) GTEST_SKIP() << "a large surface, by code that small ones go through as well";
  const files::Folder folder;
  const TaskMesh mesh = mesh_of(large_scene(), folder.path(), 300);
  const std::uint64_t count = list_tasks(mesh).count();
  for (std::uint64_t task = 0; task < count; ++task) do_task(mesh, task, {.slab = 300});
  const BlockRun expected = run_sweep(large_scene());
  EXPECT_GT(expected.report.triangles, 1U << 18);
  expect_same(collect(large_scene(), mesh), expected);
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const BadInput& error) {
    return error.what();
  }
  return "no error";
}

TEST(TaskFolder, ATaskThatAnotherProcessWorksOnIsLeftToIt) {
  const files::Folder folder;
  const TaskMesh mesh = mesh_of(noise_scene(), folder.path(), 24);
  {
    const auto lock = FileLock::take(folder / "0.lock");
    ASSERT_TRUE(lock);
    // A worker that waits for the task does not open the volume again and again.
    TaskMesh unopened = mesh;
    unopened.open = []() -> std::unique_ptr<SliceSource> { throw std::logic_error("opened"); };
    EXPECT_EQ(do_task(unopened, 0), TaskEnd::kElsewhere);
    EXPECT_FALSE(is_done(mesh, 0));
  }
  EXPECT_EQ(do_task(mesh, 0), TaskEnd::kDone);
}

TEST(TaskFolder, DamagedAndForeignFilesAreRefusedByName) {
  const files::Folder folder, other;
  const TaskMesh mesh = mesh_of(noise_scene(), folder.path(), 24);
  std::mt19937_64 random(1);
  EXPECT_NE(message_of([&] { collect(noise_scene(), mesh); }).find("task 0 undone"), std::string::npos);
  do_all(mesh, random);
  const std::string rest = folder / "0.rest", final = folder / "0.final";
  for (const std::string& path : {rest, final}) {
    const std::string whole = files::read_bytes(path);
    std::string damaged = whole;
    damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 1);
    files::write_bytes(path, damaged);
    EXPECT_NE(message_of([&] { collect(noise_scene(), mesh); }).find(path + ": "), std::string::npos);
    files::write_bytes(path, whole.substr(0, whole.size() - 9));
    EXPECT_NE(message_of([&] { collect(noise_scene(), mesh); }).find(path + ": "), std::string::npos);
    files::write_bytes(path, whole);
  }
  // Of the same volume with another error.
  BlockScene coarser = noise_scene();
  coarser.options.error = Length::voxels(0.5);
  const TaskMesh second = mesh_of(coarser, other.path(), 24);
  do_all(second, random);
  files::write_bytes(rest, files::read_bytes(other / "0.rest"));
  const std::string foreign = message_of([&] { collect(noise_scene(), mesh); });
  EXPECT_NE(foreign.find(rest + ": belongs to another mesh"), std::string::npos) << foreign;
  // Later tasks look at the files of the stage before.
  const std::uint64_t later = list_tasks(mesh).first_of(1);
  undo(mesh, later);
  EXPECT_NE(message_of([&] { do_task(mesh, later); }).find(rest + ": belongs to another mesh"), std::string::npos);
}

TEST(TaskFolder, ATaskThatLacksAFileIsUndone) {
  const files::Folder folder;
  const TaskMesh mesh = mesh_of(noise_scene(), folder.path(), 24);
  std::mt19937_64 random(1);
  do_all(mesh, random);
  const std::uint64_t later = list_tasks(mesh).first_of(1);
  for (const char* const file : {".final", ".rest"}) {
    undo(mesh, 0, file);
    EXPECT_FALSE(is_done(mesh, 0));
    EXPECT_NE(message_of([&] { collect(noise_scene(), mesh); }).find("found task 0 undone"), std::string::npos);
    undo(mesh, later, file);
    EXPECT_EQ(do_task(mesh, later), TaskEnd::kTooEarly);
    EXPECT_EQ(do_task(mesh, 0), TaskEnd::kDone);
    EXPECT_EQ(do_task(mesh, later), TaskEnd::kDone);
    expect_same(collect(noise_scene(), mesh), run_sweep(noise_scene()));
  }
}

TEST(TaskFolder, FilesOfTwoRunsOfATaskDoNotFitTogether) {
  const files::Folder folder;
  const TaskMesh mesh = mesh_of(noise_scene(), folder.path(), 24);
  std::mt19937_64 random(1);
  do_all(mesh, random);
  std::filesystem::copy_file(folder / "1.rest", folder / "kept");
  files::write_bytes(folder / "1.rest", files::read_bytes(folder / "0.rest"));
  EXPECT_NE(message_of([&] { collect(noise_scene(), mesh); }).find("expected the task 1, found 0"), std::string::npos);
}

}  // namespace
}  // namespace isoweave::testing::tasks_test
