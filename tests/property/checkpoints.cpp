// A run that is cut off and resumed makes the mesh of a run that is not.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "files.hpp"
#include "meshes.hpp"
#include "pipeline/checkpoint.hpp"
#include "surfaces.hpp"

namespace isoweave {
namespace {

using testing::SurfaceCase;

MeshOptions mesh_options(const SurfaceCase& surface) {
  MeshOptions options;
  options.iso = suggested_iso(surface.volume.kind, surface.volume.type);
  options.closed = surface.closed;
  options.error = {surface.error, true};
  options.quality = surface.quality;
  return options;
}

MeshReport run_whole(const SurfaceCase& surface, const MeshOptions& options) {
  testing::MemorySink sink;
  return mesh_volume(*generate_volume(surface.volume), sink, options);
}

GenerateOptions values_beside(const SurfaceCase& surface) {
  GenerateOptions values = surface.volume;
  values.kind = "noise";
  values.seed = 77;
  return values;
}

// A run that stops after a number of slabs, and goes on as often as it takes; each part has a schedule, a number of
// threads and a slab of its own.
class InterruptedRun {
 public:
  InterruptedRun(const SurfaceCase& surface, const MeshOptions& options, std::string name = "a.ply")
      : surface_(surface), options_(options), name_(std::move(name)) {}

  std::string mesh_path() const { return folder_ / name_; }
  std::string state_folder() const { return folder_ / "run"; }

  MeshReport finish_in_steps(int slabs_each) {
    std::filesystem::create_directory(state_folder());
    const std::array<Schedule, 3> schedules{Schedule::kLocal, Schedule::kRounds, Schedule::kQueue};
    for (std::size_t part = 0;; ++part) {
      RunControl control;
      control.schedule = schedules[part % schedules.size()];
      control.threads = static_cast<int>(1 + part % 3);
      options_.slab = static_cast<std::int64_t>(2 + part % 4);
      try {
        return run_part(control, part > 0, slabs_each);
      } catch (const Interrupted&) {
        ++interruptions;
      }
    }
  }

  int interruptions = 0;
  bool with_values = false;

 private:
  MeshReport run_part(RunControl control, bool resume, int slabs) {
    std::atomic<bool> stop = false;
    control.stop = &stop;
    control.progress = [&](const Progress&) { stop = --slabs == 0; };
    control.checkpoint.folder = state_folder();
    Checkpoint checkpoint;
    if (resume) checkpoint = read_checkpoint(state_folder());
    if (resume) control.resume = &checkpoint;
    const std::string mark = resume ? checkpoint.marks.at(0) : "";
    MeshFileOptions file{options_.normals != Normals::kAbsent, {"a test"}, state_folder(), mark};
    file.values = with_values;
    const auto sink = open_mesh_file(mesh_path(), file);
    const auto values = generate_volume(values_beside(surface_));
    options_.values = with_values ? values.get() : nullptr;
    return mesh_volume(*generate_volume(surface_.volume), *sink, options_, control);
  }

  SurfaceCase surface_;
  MeshOptions options_;
  std::string name_;
  files::Folder folder_;
};

void expect_same_result(const MeshReport& a, const MeshReport& b) {
  EXPECT_EQ(a.digest, b.digest);
  EXPECT_EQ(a.triangles, b.triangles);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.euler, b.euler);
  EXPECT_EQ(a.open_edges, b.open_edges);
  EXPECT_EQ(a.nonmanifold_edges, b.nonmanifold_edges);
  EXPECT_EQ(a.triangles_extracted, b.triangles_extracted);
  EXPECT_EQ(a.vertices_extracted, b.vertices_extracted);
  EXPECT_EQ(a.cells_crossed, b.cells_crossed);
  EXPECT_EQ(a.collapses, b.collapses);
  EXPECT_EQ(a.postponed, b.postponed);
  EXPECT_EQ(a.rekeyed, b.rekeyed);
  EXPECT_EQ(a.min, b.min);
  EXPECT_EQ(a.max, b.max);
}

class Resumed : public ::testing::TestWithParam<const char*> {};

TEST_P(Resumed, RunsMakeTheSameMesh) {
  for (const bool closed : {true, false}) {
    for (const double error : {0.0, 0.4}) {
      SurfaceCase surface{{GetParam(), {20, 24, 33}, SampleType::kUint8, {1, 1, 1.5}, 3}, closed, error};
      MeshOptions options = mesh_options(surface);
      options.normals = error == 0 ? Normals::kGradient : closed ? Normals::kQuadric : Normals::kAbsent;
      options.max_distance = {closed ? 0.3 : 0, true};
      const MeshReport whole = run_whole(surface, options);
      InterruptedRun run(surface, options);
      const MeshReport resumed = run.finish_in_steps(1);
      EXPECT_GE(run.interruptions, 5);
      expect_same_result(resumed, whole);
      const TriangleMesh mesh = read_mesh(run.mesh_path());
      EXPECT_EQ(mesh.triangles.size(), whole.triangles);
      EXPECT_EQ(check_mesh(mesh).digest, whole.digest);
      EXPECT_TRUE(std::filesystem::is_empty(run.state_folder())) << "a finished run leaves nothing";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Resumed, ::testing::Values("noise", "gyroid", "box", "specks", "white"));

// What is smoothed is read again where the run goes on, and some slices below.
TEST(Checkpoints, ASmoothedMaskGoesOnToTheSameMesh) {
  for (const int passes : {1, 6}) {
    const SurfaceCase surface{{"noise", {20, 20, 40}, SampleType::kUint8}, true, 0.3};
    MeshOptions options = mesh_options(surface);
    options.smooth = passes;
    InterruptedRun run(surface, options);
    const MeshReport resumed = run.finish_in_steps(1);
    EXPECT_GE(run.interruptions, 5);
    expect_same_result(resumed, run_whole(surface, options));
    options.smooth = 0;
    EXPECT_NE(resumed.digest, run_whole(surface, options).digest);
  }
}

TEST(Checkpoints, DroppedComponentsStayDropped) {
  for (const double error : {0.0, 0.4}) {
    const SurfaceCase surface{{"noise", {20, 24, 33}, SampleType::kUint8, {1, 1, 1.5}, 3}, false, error};
    MeshOptions options = mesh_options(surface);
    const ComponentChoice choice = choose_components(*generate_volume(surface.volume), options, {12, false});
    EXPECT_GT(choice.components, 1U);
    EXPECT_GT(choice.components_dropped, 1U);
    options.components = &choice;
    const MeshReport whole = run_whole(surface, options);
    InterruptedRun run(surface, options);
    const MeshReport resumed = run.finish_in_steps(1);
    EXPECT_GE(run.interruptions, 5);
    expect_same_result(resumed, whole);
    EXPECT_EQ(resumed.triangles_dropped, whole.triangles_dropped);
    EXPECT_EQ(check_mesh(read_mesh(run.mesh_path())).digest, whole.digest);
  }
}

TEST(Checkpoints, EveryFormatGoesOnToTheSameMesh) {
  const SurfaceCase surface{{"noise", {20, 20, 40}, SampleType::kUint8}, true, 0.3};
  MeshOptions options = mesh_options(surface);
  options.normals = Normals::kGradient;
  const MeshReport whole = run_whole(surface, options);
  for (const char* name : meshes::kFileNames) {
    InterruptedRun run(surface, options, name);
    run.finish_in_steps(1);
    EXPECT_GE(run.interruptions, 5) << name;
    EXPECT_TRUE(std::filesystem::is_empty(run.state_folder())) << name;
    EXPECT_EQ(check_mesh(read_mesh(run.mesh_path())).digest, whole.digest) << name;
  }
}

TEST(Checkpoints, WhatRidesOnVerticesGoesOn) {
  const SurfaceCase surface{{"noise", {20, 20, 40}, SampleType::kUint8}, true, 0.5};
  for (const Normals normals : {Normals::kGradient, Normals::kQuadric}) {
    MeshOptions options = mesh_options(surface);
    options.normals = normals;
    const auto values = generate_volume(values_beside(surface));
    options.values = values.get();
    testing::MemorySink whole;
    mesh_volume(*generate_volume(surface.volume), whole, options);
    InterruptedRun run(surface, options);
    run.with_values = true;
    run.finish_in_steps(1);
    EXPECT_GE(run.interruptions, 5);
    const TriangleMesh mesh = read_mesh(run.mesh_path());
    ASSERT_EQ(mesh.values.size(), mesh.vertices.size());
    EXPECT_EQ(testing::riders_digest(mesh), testing::riders_digest(whole.mesh));
  }
}

// Fails at a slice, as a disk does, until it is told to work.
class FailingVolume final : public SliceSource {
 public:
  FailingVolume(std::unique_ptr<SliceSource> volume, std::int64_t bad_slice)
      : volume_(std::move(volume)), bad_slice_(bad_slice) {}

  const VolumeInfo& info() const override { return volume_->info(); }
  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    if (first <= bad_slice_ && bad_slice_ < first + count) throw BadInput("memory: cannot be read: slice of bad luck");
    volume_->read(first, count, out);
  }

 private:
  std::unique_ptr<SliceSource> volume_;
  std::int64_t bad_slice_;
};

TEST(Checkpoints, LevelsGoOnToTheSameMeshes) {
  const SurfaceCase surface{{"noise", {24, 24, 40}, SampleType::kUint8}, true, 0.6};
  MeshOptions options = mesh_options(surface);
  options.levels = {{0.1, true}, {0.3, true}};
  std::vector<testing::MemorySink> whole_sinks(3);
  MeshSink* const pointers[] = {&whole_sinks[0], &whole_sinks[1], &whole_sinks[2]};
  const MeshReport whole = mesh_volume(*generate_volume(surface.volume), pointers, options);

  const files::Folder folder;
  options.slab = 5;
  MeshReport resumed;
  int interruptions = 0;
  for (bool done = false; !done;) {
    std::atomic<bool> stop = false;
    RunControl control;
    control.stop = &stop;
    control.progress = [&](const Progress&) { stop = true; };
    control.checkpoint.folder = folder.path();
    Checkpoint checkpoint;
    if (interruptions > 0) checkpoint = read_checkpoint(folder.path());
    if (interruptions > 0) control.resume = &checkpoint;
    std::vector<std::unique_ptr<MeshSink>> sinks;
    std::vector<MeshSink*> opened;
    for (std::size_t level = 0; level < 3; ++level) {
      const std::string parts = folder / ("parts" + std::to_string(level));
      std::filesystem::create_directory(parts);
      const std::string mark = interruptions > 0 ? checkpoint.marks.at(level) : "";
      sinks.push_back(open_mesh_file(folder / (std::to_string(level) + ".ply"), {false, {}, parts, mark}));
      opened.push_back(sinks.back().get());
    }
    try {
      resumed = mesh_volume(*generate_volume(surface.volume), opened, options, control);
      done = true;
    } catch (const Interrupted&) {
      ++interruptions;
    }
  }
  EXPECT_GE(interruptions, 5);
  expect_same_result(resumed, whole);
  for (std::size_t level = 0; level < 3; ++level) {
    const TriangleMesh mesh = read_mesh(folder / (std::to_string(level) + ".ply"));
    EXPECT_EQ(check_mesh(mesh).digest, check_mesh(whole_sinks[level].mesh).digest) << level;
    if (level < 2) {
      EXPECT_EQ(resumed.levels[level].digest, whole.levels[level].digest);
      EXPECT_EQ(resumed.levels[level].components, whole.levels[level].components);
    }
  }
}

TEST(Checkpoints, AVolumeThatFailsInTheMiddleCanBeResumed) {
  const SurfaceCase surface{{"noise", {24, 24, 40}, SampleType::kUint8}, true, 0.3};
  MeshOptions options = mesh_options(surface);
  options.slab = 3;
  const MeshReport whole = run_whole(surface, options);
  for (const std::int64_t bad_slice : {0, 1, 17, 39}) {
    const files::Folder folder;
    RunControl control;
    control.checkpoint.folder = folder.path();
    control.checkpoint.note = "a note";
    {
      FailingVolume failing(generate_volume(surface.volume), bad_slice);
      const auto sink = open_mesh_file(folder / "a.stl", {false, {}, folder.path()});
      EXPECT_THROW(mesh_volume(failing, *sink, options, control), BadInput);
    }
    const Checkpoint checkpoint = read_checkpoint(folder.path());
    EXPECT_EQ(checkpoint.note, "a note");
    EXPECT_EQ(checkpoint.layers, 41);
    EXPECT_LE(checkpoint.layer, bad_slice + 1);
    EXPECT_GT(checkpoint.layer, bad_slice - 8) << "as far as the slices before the bad one go";
    control.resume = &checkpoint;
    const auto sink = open_mesh_file(folder / "a.stl", {false, {}, folder.path(), checkpoint.marks.at(0)});
    const MeshReport resumed = mesh_volume(*generate_volume(surface.volume), *sink, options, control);
    expect_same_result(resumed, whole);
    EXPECT_EQ(resumed.resumed_at, checkpoint.layer);
    EXPECT_EQ(check_mesh(read_mesh(folder / "a.stl")).digest, whole.digest);
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"a.stl"});
  }
}

// A state in a folder, and how it is refused.
class SavedState : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.slab = 4;
    RunControl control = saving();
    std::atomic<bool> stop = false;
    int slabs = 3;
    control.stop = &stop;
    control.progress = [&](const Progress&) { stop = --slabs == 0; };
    const auto sink = open_mesh_file(folder_ / "a.obj", {false, {}, folder_.path()});
    ASSERT_THROW(mesh_volume(*generate_volume(surface_.volume), *sink, options_, control), Interrupted);
    whole_ = run_whole(surface_, options_).digest;
  }

  RunControl saving() const {
    RunControl control;
    control.checkpoint.folder = folder_.path();
    control.checkpoint.layers = 1;
    return control;
  }

  MeshReport resume(SliceSource& volume, const MeshOptions& options) {
    const Checkpoint checkpoint = read_checkpoint(folder_.path());
    RunControl control = saving();
    control.resume = &checkpoint;
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
           [](MeshOptions& o) { o.error.value = 0.31; }, [](MeshOptions& o) { o.error.voxels = false; },
           [](MeshOptions& o) { o.quality = Quality::kFine; }, [&](MeshOptions& o) { o.components = &choice; },
           [](MeshOptions& o) { o.inside_above = false; }, [](MeshOptions& o) { o.space = OutputSpace::kIndex; }}) {
    MeshOptions options = options_;
    change(options);
    expect_refused<BadInput>([&] { resume(*generate_volume(surface_.volume), options); }, "the task has changed");
  }
  EXPECT_EQ(resume().digest, whole_);
}

TEST_F(SavedState, OfAnotherVersionIsRefused) {
  StateWriter writer(folder_ / "state-0");
  writer.list(std::string("isoweave state 8\n"));
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
  writer.list(std::string("isoweave state 8\n"));
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

TEST(Checkpoints, ASinkInMemoryCannotBeContinued) {
  const SurfaceCase surface{{"sphere", {8, 8, 8}, SampleType::kUint8}};
  const files::Folder folder;
  RunControl control;
  control.checkpoint.folder = folder.path();
  testing::MemorySink sink;
  EXPECT_THROW(mesh_volume(*generate_volume(surface.volume), sink, mesh_options(surface), control), std::logic_error);
}

TEST(Sweep, AFileThatIsWrittenWhileItIsReadIsAnError) {
  const files::Folder folder;
  const std::string path = folder / "cube_8x8x16_uint8.raw";
  files::write_bytes(path, std::string(8 * 8 * 16, '\x01'));
  for (const bool disturbed : {false, true}) {
    MeshOptions options;
    options.iso = 0.5;
    options.slab = 2;
    RunControl control;
    control.progress = [&](const Progress& progress) {
      if (disturbed && progress.layer == 2) std::ofstream(path, std::ios::app | std::ios::binary) << 'x';
    };
    testing::MemorySink sink;
    const auto volume = open_volume(path);
    if (disturbed) {
      EXPECT_THROW(mesh_volume(*volume, sink, options, control), BadInput);
    } else {
      mesh_volume(*volume, sink, options, control);
    }
    EXPECT_NE(sink.finished, disturbed);
  }
}

}  // namespace
}  // namespace isoweave
