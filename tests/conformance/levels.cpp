// Levels out of one sweep are the meshes of runs with their errors.
// Threads: none, mesh_pieces.cpp has levels
#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace isoweave::testing::levels_test {
namespace {

const std::vector<double> kErrors{0, 0.1, 0.25, 0.7};

GenerateOptions make_volume(const std::string& kind) {
  GenerateOptions volume;
  volume.kind = kind;
  volume.dims = {18, 15, 24};
  volume.spacing = {0.7, 0.9, 1.6};
  volume.seed = 3;
  return volume;
}

struct LevelRun {
  std::vector<TriangleMesh> meshes;
  std::vector<SurfaceReport> reports;
};

LevelRun run_levels(const GenerateOptions& volume, MeshOptions options, const RunControl& control) {
  options.levels.clear();
  for (const double error : kErrors) options.levels.push_back({error, true});
  options.error = options.levels.back();
  options.levels.pop_back();
  std::vector<MemorySink> sinks(kErrors.size());
  std::vector<MeshSink*> pointers;
  for (MemorySink& sink : sinks) pointers.push_back(&sink);
  const MeshReport report = mesh_volume(*generate_volume(volume), pointers, options, control);
  LevelRun run;
  run.reports = report.levels;
  run.reports.push_back(report);
  for (MemorySink& sink : sinks) {
    EXPECT_TRUE(sink.finished);
    run.meshes.push_back(std::move(sink.mesh));
  }
  return run;
}

// One run for each level.
LevelRun run_each(const GenerateOptions& volume, MeshOptions options) {
  LevelRun run;
  for (const double error : kErrors) {
    options.error = Length::voxels(error);
    MemorySink sink;
    run.reports.push_back(mesh_volume(*generate_volume(volume), sink, options));
    run.meshes.push_back(std::move(sink.mesh));
  }
  return run;
}

void expect_same(const LevelRun& found, const LevelRun& expected) {
  for (std::size_t n = 0; n < kErrors.size(); ++n) {
    SCOPED_TRACE(::testing::Message() << "error " << kErrors[n]);
    const SurfaceReport& a = found.reports[n];
    const SurfaceReport& b = expected.reports[n];
    expect_same_surface(a, b);
    const MeshCheck check = check_mesh(found.meshes[n]);
    EXPECT_EQ(check.digest, b.digest);
    EXPECT_EQ(check.vertices, b.vertices);
    EXPECT_EQ(check.unused_vertices, 0U);
  }
}

class Levels : public ::testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(Levels, AreTheMeshesOfRunsWithTheirErrors) {
  const GenerateOptions volume = make_volume(std::get<0>(GetParam()));
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  options.closed = std::get<1>(GetParam());
  for (const Quality quality : {Quality::kNormal, Quality::kFine}) {
    options.quality = quality;
    options.drop_specks = quality == Quality::kFine;
    const LevelRun expected = run_each(volume, options);
    ASSERT_LT(expected.reports[3].triangles, expected.reports[1].triangles);
    for (const std::int64_t slab : {1, 4, 9, 1000}) {
      if (kSanitized && slab != 4) continue;
      const auto same = [&](Schedule schedule, int threads) {
        SCOPED_TRACE(::testing::Message() << "slab " << slab << ", schedule " << static_cast<int>(schedule)
                                          << ", threads " << threads << ", quality " << static_cast<int>(quality));
        RunControl control;
        control.slab = slab;
        control.schedule = schedule;
        control.threads = threads;
        expect_same(run_levels(volume, options, control), expected);
      };
      same(Schedule::kLocal, 1);
      same(Schedule::kLocal, 4);
      same(Schedule::kQueue, 1);
      same(Schedule::kRounds, 2);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Levels,
                         ::testing::Combine(::testing::Values("gyroid", "noise", "white", "box", "specks"),
                                            ::testing::Bool()),
                         [](const auto& instance) {
                           return std::get<0>(instance.param) + (std::get<1>(instance.param) ? "Closed" : "Open");
                         });

TEST(LevelOptions, AscendBelowTheLastError) {
  const GenerateOptions volume = make_volume("gyroid");
  MemorySink sinks[3];
  MeshSink* const pointers[] = {&sinks[0], &sinks[1], &sinks[2]};
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  options.error = Length::voxels(0.5);
  const auto refused = [&](std::span<MeshSink* const> given) {
    EXPECT_THROW(mesh_volume(*generate_volume(volume), given, options), std::invalid_argument);
  };
  options.levels = {{0.2, true}, {0.2, true}};
  refused(pointers);
  options.levels = {{0.2, true}, {0.5, true}};
  refused(pointers);
  options.levels = {{-1, true}, {0.3, true}};
  refused(pointers);
  options.levels = {{0.2, true}, {0.3, true}};
  refused(std::span(pointers).first(2));
  options.triangles = 100;
  refused(pointers);
  options.triangles = 0;
  EXPECT_EQ(mesh_volume(*generate_volume(volume), pointers, options).levels.size(), 2U);
}

// Of a mesh with vertices that stay where they are, too.
TEST(LevelsOfMeshes, AreTheMeshesOfRunsWithTheirErrors) {
  const GenerateOptions volume = make_volume("noise");
  MeshOptions full;
  full.iso = suggested_iso(volume.kind, volume.type);
  full.error = Length::voxels(0);
  MemorySink sink;
  mesh_volume(*generate_volume(volume), sink, full);
  for (const bool locked : {false, true}) {
    TriangleMesh mesh = sink.mesh;
    if (locked) mesh.triangles.push_back(mesh.triangles[100]);
    SimplifyOptions options;
    LevelRun expected;
    for (const double error : kErrors) {
      options.error = Length::voxels(error);
      MemorySink direct;
      expected.reports.push_back(simplify_mesh(mesh, direct, options));
      expected.meshes.push_back(std::move(direct.mesh));
    }
    options.levels = {{0, true}, {0.1, true}, {0.25, true}};
    MemorySink sinks[4];
    MeshSink* const pointers[] = {&sinks[0], &sinks[1], &sinks[2], &sinks[3]};
    const MeshReport report = simplify_mesh(mesh, pointers, options);
    EXPECT_EQ(report.locked_vertices > 0, locked);
    LevelRun found;
    found.reports = report.levels;
    found.reports.push_back(report);
    for (MemorySink& level : sinks) found.meshes.push_back(std::move(level.mesh));
    expect_same(found, expected);
  }
}

}  // namespace
}  // namespace isoweave::testing::levels_test
