// States that are refused, and the folder that holds them.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "checkpoint_runs.hpp"
#include "files.hpp"
#include "isoweave/error.hpp"
#include "pipeline/checkpoint.hpp"

namespace isoweave::testing::saved_states_test {
namespace {

using testing::mesh_options;
using testing::run_whole;
using testing::SurfaceCase;

// A state in a folder, and how it is refused.
class SavedState : public ::testing::Test {
 protected:
  void SetUp() override {
    RunControl control = saving();
    std::atomic<bool> stop = false;
    int slabs = 3;
    control.stop = borrow(stop);
    control.progress = [&](const Progress&) { stop = --slabs == 0; };
    const auto sink = open_mesh_file(folder_ / "a.obj", {false, {}, folder_.path()});
    ASSERT_THROW(mesh_volume(*generate_volume(surface_.volume), *sink, options_, control), Interrupted);
    whole_ = run_whole(surface_, options_).digest;
  }

  RunControl saving() const {
    RunControl control;
    control.checkpoint.folder = folder_.path();
    control.checkpoint.layers = 1;
    control.slab = 4;
    return control;
  }

  MeshReport resume(SliceSource& volume, const MeshOptions& options) {
    const Checkpoint checkpoint = read_checkpoint(folder_.path());
    RunControl control = saving();
    control.resume = checkpoint;
    const auto sink = open_mesh_file(folder_ / "a.obj", {false, {}, folder_.path(), checkpoint.marks.at(0)});
    return mesh_volume(volume, *sink, options, control);
  }

  MeshReport resume() { return resume(*generate_volume(surface_.volume), options_); }

  // Changes one byte.
  void damage(const std::string& name, std::size_t at) {
    std::string bytes = files::read_bytes(folder_ / name);
    bytes[at % bytes.size()] = static_cast<char>(bytes[at % bytes.size()] ^ 1);
    files::write_bytes(folder_ / name, bytes);
  }

  template <class Exception>
  void expect_refused(const std::function<void()>& what, const std::string& says) {
    try {
      what();
      ADD_FAILURE() << "expected: " << says;
    } catch (const Exception& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  }

  const SurfaceCase surface_{{"noise", {20, 20, 40}, SampleType::kUint8}, true, 0.3};
  MeshOptions options_ = mesh_options(surface_);
  files::Folder folder_;
  std::uint64_t whole_ = 0;
};

TEST_F(SavedState, TheOneBeforeServesWhenTheNewestIsDamaged) {
  const Checkpoint newest = read_checkpoint(folder_.path());
  damage(std::filesystem::path(newest.path).filename(), 1000);
  const Checkpoint older = read_checkpoint(folder_.path());
  EXPECT_LT(older.layer, newest.layer);
  EXPECT_NE(older.path, newest.path);
  EXPECT_EQ(resume().digest, whole_);
}

// What a process leaves that dies between the names of two meshes.
class DiesAtTheEnd final : public MeshSink {
 public:
  explicit DiesAtTheEnd(MeshSink& sink) : sink_(sink) {}
  void append(const MeshPiece& piece) override { sink_.append(piece); }
  void finish() override { throw CannotWrite("the process dies"); }
  std::string mark() override { return sink_.mark(); }

 private:
  MeshSink& sink_;
};

TEST_F(SavedState, LevelsGoOnWhenOnlyTheFirstHasItsName) {
  const files::Folder folder, fine, coarse, meshes;
  options_.levels = {{0.1, true}};
  const auto run = [&](const std::optional<Checkpoint>& resume, bool dies) {
    RunControl control = saving();
    control.checkpoint.folder = folder.path();
    control.resume = resume;
    const auto mark = [&](std::size_t level) { return !resume ? "" : resume->marks.at(level); };
    const auto first = open_mesh_file(meshes / "fine.ply", {false, {}, fine.path(), mark(0)});
    const auto second = open_mesh_file(meshes / "coarse.ply", {false, {}, coarse.path(), mark(1)});
    DiesAtTheEnd dying(*second);
    const std::vector<MeshSink*> sinks{first.get(), dies ? &dying : second.get()};
    return mesh_volume(*generate_volume(surface_.volume), sinks, options_, control);
  };
  EXPECT_THROW(run(std::nullopt, true), CannotWrite);
  EXPECT_EQ(meshes.entries().size(), 1U);
  const Checkpoint checkpoint = read_checkpoint(folder.path());
  const MeshReport report = run(checkpoint, false);
  EXPECT_EQ(report.digest, whole_);
  EXPECT_EQ(check_mesh(read_mesh(meshes / "coarse.ply")).digest, whole_);
  EXPECT_EQ(check_mesh(read_mesh(meshes / "fine.ply")).digest, report.levels.at(0).digest);
  EXPECT_TRUE(fine.entries().empty() && coarse.entries().empty());
}

TEST_F(SavedState, DamagedFilesAreRefusedWhereverTheDamageIs) {
  for (const std::size_t at : {0U, 8U, 30U, 500U, 5000U}) {
    damage("state-0", at);
    damage("state-1", at);
    expect_refused<BadInput>([&] { read_checkpoint(folder_.path()); }, "damaged");
    damage("state-0", at);
    damage("state-1", at);
  }
  files::write_bytes(folder_ / "state-0", "x");
  files::write_bytes(folder_ / "state-1", "");
  expect_refused<BadInput>([&] { read_checkpoint(folder_.path()); }, "expected a saved state");
}

TEST_F(SavedState, AnotherVolumeIsRefused) {
  GenerateOptions other = surface_.volume;
  other.dims[1] = 21;
  expect_refused<BadInput>([&] { resume(*generate_volume(other), options_); }, "the volume has changed");
  other = surface_.volume;
  other.seed = 99;
  expect_refused<BadInput>([&] { resume(*generate_volume(other), options_); }, "expected the samples that");
  EXPECT_EQ(resume().digest, whole_) << "nothing was lost";
}

TEST_F(SavedState, AnotherTaskIsRefused) {
  const ComponentChoice choice = choose_components(*generate_volume(surface_.volume), options_, {60, false});
  for (const auto& change : std::vector<std::function<void(MeshOptions&)>>{
           [](MeshOptions& o) { o.iso += 1; }, [](MeshOptions& o) { o.closed = false; },
           [](MeshOptions& o) { o.error.value = 0.31; }, [](MeshOptions& o) { o.max_distance = Length::voxels(1); },
           [](MeshOptions& o) { o.quality = Quality::kFine; }, [&](MeshOptions& o) { o.components = borrow(choice); },
           [](MeshOptions& o) { o.inside_above = false; }, [](MeshOptions& o) { o.space = OutputSpace::kIndex; }}) {
    MeshOptions options = options_;
    change(options);
    expect_refused<BadInput>([&] { resume(*generate_volume(surface_.volume), options); }, "the task has changed");
  }
  EXPECT_EQ(resume().digest, whole_);
}

TEST_F(SavedState, OfARunThatMeasuredNothingIsRefusedByOneThatDoes) {
  const files::Folder folder;
  std::atomic<bool> stop = false;
  RunControl control = saving();
  control.checkpoint.folder = folder.path();
  control.measure = false;
  control.stop = borrow(stop);
  control.progress = [&](const Progress&) { stop = true; };
  const auto run = [&](const std::optional<Checkpoint>& resume) {
    control.resume = resume;
    const std::string mark = !resume ? "" : resume->marks.at(0);
    const auto sink = open_mesh_file(folder_ / "b.obj", {false, {}, folder.path(), mark});
    return mesh_volume(*generate_volume(surface_.volume), *sink, options_, control);
  };
  EXPECT_THROW(run(std::nullopt), Interrupted);
  const Checkpoint checkpoint = read_checkpoint(folder.path());
  control.stop = nullptr;
  control.measure = true;
  expect_refused<BadInput>([&] { run(checkpoint); }, "the task has changed");
  control.measure = false;
  run(checkpoint);
  EXPECT_EQ(check_mesh(read_mesh(folder_ / "b.obj")).digest, whole_);
}

TEST_F(SavedState, OfAnotherVersionIsRefused) {
  StateWriter writer(folder_ / "state-0");
  writer.list(std::string("isoweave state 15\n"));
  writer.list(std::string("0.0.0"));
  writer.commit();
  std::filesystem::remove(folder_ / "state-1");
  expect_refused<BadInput>([&] { read_checkpoint(folder_.path()); }, "version 0.0.0");
  StateWriter foreign(folder_ / "state-1");
  foreign.list(std::string("another program"));
  foreign.commit();
  std::filesystem::remove(folder_ / "state-0");
  expect_refused<BadInput>([&] { read_checkpoint(folder_.path()); }, "found another file");
}

TEST_F(SavedState, WhatAStateSaysOfItselfStaysOnOneLine) {
  StateWriter writer(folder_ / "state-0");
  writer.list(std::string("isoweave state 15\n"));
  writer.list(std::string("1\n2"));
  writer.commit();
  std::filesystem::remove(folder_ / "state-1");
  expect_refused<BadInput>([&] { read_checkpoint(folder_.path()); }, "version 1?2");
}

TEST_F(SavedState, ShortOrMissingPartsAreRefused) {
  std::filesystem::resize_file(folder_ / "mesh.part", 10);
  expect_refused<BadInput>([&] { resume(); }, "mesh.part: expected the");
  std::filesystem::remove(folder_ / "mesh.part");
  expect_refused<BadInput>([&] { resume(); }, "No such file");
}

// Every byte that the state counts on: a plausible mesh of wrong bytes would not be noticed.
TEST_F(SavedState, OneWrongBitInAPartIsRefused) {
  const std::string bytes = files::read_bytes(folder_ / "mesh.part");
  std::mt19937 random(7);
  for (int trial = 0; trial < 40; ++trial) {
    std::string damaged = bytes;
    const std::size_t bit = random() % (8 * damaged.size());
    damaged[bit / 8] = static_cast<char>(damaged[bit / 8] ^ (1 << bit % 8));
    files::write_bytes(folder_ / "mesh.part", damaged);
    expect_refused<BadInput>([&] { resume(); }, "its checksum does not fit");
    EXPECT_EQ(files::read_bytes(folder_ / "mesh.part").size(), bytes.size()) << "nothing is cut off then";
  }
  files::write_bytes(folder_ / "mesh.part", bytes);
  EXPECT_EQ(resume().digest, whole_);
}

TEST_F(SavedState, StatesThatWereNotRenamedAreRemoved) {
  files::write_bytes(folder_ / ".state-0.abcdef.partial", "x");
  files::write_bytes(folder_ / ".state-of-mind", "x");
  EXPECT_EQ(resume().digest, whole_);
  EXPECT_EQ(folder_.entries(), (std::vector<std::string>{".state-of-mind", "a.obj"}));
}

TEST_F(SavedState, TwoRunsDoNotShareAFolder) {
  {
    const CheckpointLock other(folder_.path());
    expect_refused<CannotWrite>([&] { resume(); }, "process " + std::to_string(::getpid()));
  }
  EXPECT_EQ(resume().digest, whole_);
}

// Opening a part again cuts it off: that must not happen under somebody who writes to it.
TEST_F(SavedState, PartsThatSomebodyWritesToAreRefused) {
  const Checkpoint checkpoint = read_checkpoint(folder_.path());
  const MeshFileOptions options{false, {}, folder_.path(), checkpoint.marks.at(0)};
  {
    const auto first = open_mesh_file(folder_ / "a.obj", options);
    expect_refused<CannotWrite>([&] { open_mesh_file(folder_ / "a.obj", options); }, "another process is writing");
  }
  EXPECT_EQ(resume().digest, whole_);
}

TEST(CheckpointLock, IsOfOneAtATimeAndLeavesNothing) {
  const files::Folder folder;
  {
    const CheckpointLock lock(folder.path());
    EXPECT_THROW(CheckpointLock(folder.path()), CannotWrite);
  }
  EXPECT_TRUE(folder.entries().empty());
  EXPECT_THROW(CheckpointLock(folder / "missing"), CannotWrite);
  files::write_bytes(folder / "lock", "left by a process that was killed");
  const CheckpointLock lock(folder.path());
}

TEST_F(SavedState, PartsOfAnotherRunAreNotWrittenOver) {
  expect_refused<CannotWrite>(
      [&] {
        open_mesh_file(folder_ / "b.ply", {false, {}, folder_.path()});
      },
      "unfinished run");
}

TEST(Checkpoints, AStateSaysHowMuchItHolds) {
  const files::Folder folder;
  std::vector<std::uint64_t> many(1000, 7);
  StateWriter writer(folder / "a");
  writer.value(std::uint64_t{1} << 60);  // read as a length below
  writer.commit();
  StateReader reader(folder / "a");
  EXPECT_THROW(reader.list(many), BadInput);
  EXPECT_EQ(many.size(), 1000U);
}

}  // namespace
}  // namespace isoweave::testing::saved_states_test
