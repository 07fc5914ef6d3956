// A run that is cut off and resumed makes the mesh of a run that is not.
// Threads: Sweep.*
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "checkpoint_runs.hpp"
#include "files.hpp"
#include "meshes.hpp"
#include "pipeline/checkpoint.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::checkpoints_test {
namespace {

using testing::mesh_options;
using testing::run_whole;
using testing::SurfaceCase;

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
      control.slab = static_cast<std::int64_t>(2 + part % 4);
      try {
        return run_part(control, part > 0, slabs_each);
      } catch (const Interrupted&) {
        ++interruptions;
      }
    }
  }

  int interruptions = 0;
  bool with_values = false;
  double head_start = 0;  // where a number of triangles is asked for
  bool count_first = false;
  int opens_until = 1000;  // interruptions: the volume cannot be opened again then

 private:
  MeshReport run_part(RunControl control, bool resume, int slabs) {
    std::atomic<bool> stop = false;
    control.stop = borrow(stop);
    control.progress = [&](const Progress&) { stop = --slabs == 0; };
    control.checkpoint.folder = state_folder();
    Checkpoint checkpoint;
    if (resume) checkpoint = read_checkpoint(state_folder());
    if (resume) control.resume = checkpoint;
    const std::string mark = resume ? checkpoint.marks.at(0) : "";
    MeshFileOptions file{options_.normals != Normals::kAbsent, {"a test"}, state_folder(), mark};
    file.values = with_values;
    control.head_start = head_start;
    control.count_first = count_first;
    if (interruptions < opens_until) control.reopen = [this] { return generate_volume(surface_.volume); };
    const auto sink = open_mesh_file(mesh_path(), file);
    options_.values = with_values ? generate_volume(values_beside(surface_)) : nullptr;
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
  EXPECT_EQ(a.cap_cells, b.cap_cells);
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
      options.max_distance = Length::voxels(closed ? 0.3 : 0);
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

class ResumedExtractors : public ::testing::TestWithParam<ExtractorKind> {};

TEST_P(ResumedExtractors, MakeTheSameMesh) {
  for (const bool closed : {true, false}) {
    SurfaceCase surface{{"white", {12, 14, 17}, SampleType::kFloat32, {1, 1, 1.5}, 3}, closed, 0.3};
    MeshOptions options = mesh_options(surface);
    options.extractor = GetParam();
    const MeshReport whole = run_whole(surface, options);
    InterruptedRun run(surface, options);
    const MeshReport resumed = run.finish_in_steps(1);
    EXPECT_GE(run.interruptions, 3);
    expect_same_result(resumed, whole);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, ResumedExtractors,
                         ::testing::Values(ExtractorKind::kTrilinear, ExtractorKind::kTetrahedra,
                                           ExtractorKind::kDual));

INSTANTIATE_TEST_SUITE_P(Volumes, Resumed, ::testing::Values("noise", "gyroid", "box", "specks", "white"));

// One head start is too low, one leaves too few triangles: the run begins again, and is interrupted there as well.
TEST(Checkpoints, AHeadStartGoesOn) {
  const SurfaceCase surface{{"noise", {20, 24, 33}, SampleType::kUint8, {1, 1, 1.5}, 3}, true, 0.8};
  MeshOptions options = mesh_options(surface);
  options.triangles = 6000;
  const MeshReport whole = run_whole(surface, options);
  ASSERT_EQ(whole.triangles, 6000U);
  for (const double head_start : {whole.error / 3, 3 * whole.error}) {
    InterruptedRun run(surface, options);
    run.head_start = head_start;
    const MeshReport resumed = run.finish_in_steps(1);
    EXPECT_GE(run.interruptions, head_start > whole.error ? 10 : 5);
    expect_same_result(resumed, whole);
    EXPECT_EQ(check_mesh(read_mesh(run.mesh_path())).digest, whole.digest);
    EXPECT_TRUE(std::filesystem::is_empty(run.state_folder()));
  }
  InterruptedRun counted(surface, options);
  counted.head_start = whole.error / 9;
  counted.count_first = true;
  expect_same_result(counted.finish_in_steps(1), whole);
  EXPECT_GE(counted.interruptions, 20) << "counted twice";
  EXPECT_EQ(check_mesh(read_mesh(counted.mesh_path())).digest, whole.digest);
  // The same number as a share, which is known in the end only, and one without a head start, which is counted before.
  options.triangles = 0;
  options.share = 6000 / static_cast<double>(whole.triangles_extracted);
  for (const double head_start : {0.0, whole.error / 3, 3 * whole.error}) {
    InterruptedRun share(surface, options);
    share.head_start = head_start;
    expect_same_result(share.finish_in_steps(1), whole);
    EXPECT_GE(share.interruptions, 5);
    EXPECT_EQ(check_mesh(read_mesh(share.mesh_path())).digest, whole.digest);
  }
  InterruptedRun run(surface, options);
  run.head_start = 3 * whole.error;
  run.opens_until = 2;
  EXPECT_THROW(run.finish_in_steps(1), std::invalid_argument) << "a volume that cannot be read again";
}

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
    options.components = borrow(choice);
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
    options.values = borrow(*values);
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
  MeshReport resumed;
  int interruptions = 0;
  for (bool done = false; !done;) {
    std::atomic<bool> stop = false;
    RunControl control;
    control.stop = borrow(stop);
    control.progress = [&](const Progress&) { stop = true; };
    control.slab = 5;
    control.checkpoint.folder = folder.path();
    Checkpoint checkpoint;
    if (interruptions > 0) checkpoint = read_checkpoint(folder.path());
    if (interruptions > 0) control.resume = checkpoint;
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
  const MeshReport whole = run_whole(surface, options);
  for (const std::int64_t bad_slice : {0, 1, 17, 39}) {
    const files::Folder folder;
    RunControl control;
    control.checkpoint.folder = folder.path();
    control.checkpoint.note = "a note";
    control.slab = 3;
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
    control.resume = checkpoint;
    const auto sink = open_mesh_file(folder / "a.stl", {false, {}, folder.path(), checkpoint.marks.at(0)});
    const MeshReport resumed = mesh_volume(*generate_volume(surface.volume), *sink, options, control);
    expect_same_result(resumed, whole);
    EXPECT_EQ(resumed.resumed_at, checkpoint.layer);
    EXPECT_EQ(check_mesh(read_mesh(folder / "a.stl")).digest, whole.digest);
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"a.stl"});
  }
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
    RunControl control;
    control.slab = 2;
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
}  // namespace isoweave::testing::checkpoints_test
