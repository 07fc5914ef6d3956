// Small surfaces with all that a run in blocks can do, and the comparison with the sweep.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "isoweave/blocks.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "sanitized.hpp"
#include "surfaces.hpp"

namespace isoweave::testing {

struct BlockScene {
  std::string name;
  VolumeOpener open{};
  MeshOptions options{};
};

inline void PrintTo(const BlockScene& scene, std::ostream* out) { *out << scene.name; }

inline BlockScene scene_of(const std::string& name, const std::string& kind, const MeshOptions& options) {
  GenerateOptions volume;
  volume.kind = kind;
  volume.dims = {30, 26, 41};
  volume.spacing = {0.7, 0.9, 1.6};
  volume.seed = 3;
  BlockScene scene{name, [volume] { return generate_volume(volume); }, options};
  scene.options.iso = suggested_iso(kind, volume.type);
  return scene;
}

// More triangles become final at once than are handed over together, in both levels.
inline BlockScene large_scene() {
  const GenerateOptions volume{"smooth", {128, 128, 128}, SampleType::kUint8};
  BlockScene scene{"large", [volume] { return generate_volume(volume); }, {}};
  scene.options.iso = 127.5;
  scene.options.levels = {Length::voxels(0.01)};
  scene.options.error = Length::voxels(0.02);
  return scene;
}

// Oblique planes: what an edge costs there is rounding alone, so the last bit of every sum decides the order.
inline BlockScene oblique_planes(const std::string& name, bool closed) {
  constexpr std::int64_t kSide = 26;
  const auto samples = std::make_shared<std::vector<double>>();
  for (std::int64_t n = 0; n < kSide * kSide * kSide; ++n) {
    const auto i = static_cast<double>(n % kSide), j = static_cast<double>(n / kSide % kSide);
    const auto k = static_cast<double>(n / kSide / kSide);
    samples->push_back(
        std::min({20.3 - 0.61 * i - 0.27 * j - 0.43 * k, 0.83 * i - 0.37 * j - 0.5, 0.71 * k + 0.53 * j - 10.1}));
  }
  VolumeInfo info;
  info.path = name;
  info.dims = {kSide, kSide, kSide};
  info.type = SampleType::kFloat64;
  BlockScene scene;
  scene.name = name;
  scene.open = [samples, info] { return volume_in_memory(info, std::as_bytes(std::span(*samples))); };
  scene.options.error = Length::voxels(0.4);
  scene.options.closed = closed;
  return scene;
}

inline std::vector<BlockScene> block_scenes() {
  std::vector<BlockScene> all;
  const auto add = [&](const std::string& kind, const std::string& how, const auto& set) {
    MeshOptions options;
    options.error = Length::voxels(0.4);
    set(options);
    all.push_back(scene_of(kind + how, kind, options));
  };
  for (const char* const kind : {"noise", "gyroid", "box", "white", "specks"}) {
    add(kind, "", [](MeshOptions&) {});
    add(kind, "Open", [](MeshOptions& options) { options.closed = false; });
  }
  add("noise", "Full", [](MeshOptions& options) { options.error = Length::units(0); });
  add("noise", "Fine", [](MeshOptions& options) { options.quality = Quality::kFine; });
  add("noise", "Fast", [](MeshOptions& options) { options.quality = Quality::kFast; });
  add("noise", "Below", [](MeshOptions& options) { options.inside_above = false; });
  add("gyroid", "Normals", [](MeshOptions& options) { options.normals = Normals::kGradient; });
  add("gyroid", "Quadric", [](MeshOptions& options) { options.normals = Normals::kQuadric; });
  add("smooth", "Smooth", [](MeshOptions& options) { options.smooth = 2; });
  add("specks", "Dropped", [](MeshOptions& options) { options.drop_specks = true; });
  add("white", "Trilinear", [](MeshOptions& options) { options.extractor = ExtractorKind::kTrilinear; });
  add("noise", "Tetrahedra", [](MeshOptions& options) { options.extractor = ExtractorKind::kTetrahedra; });
  add("noise", "OpenTetrahedra", [](MeshOptions& options) {
    options.closed = false;
    options.extractor = ExtractorKind::kTetrahedra;
  });
  add("white", "OpenTrilinear", [](MeshOptions& options) {
    options.closed = false;
    options.extractor = ExtractorKind::kTrilinear;
  });
  add("noise", "Levels", [](MeshOptions& options) { options.levels = {Length::units(0), Length::voxels(0.1)}; });
  all.push_back(oblique_planes("planes", true));
  all.push_back(oblique_planes("planesOpen", false));
  return all;
}

// All scenes, or under sanitizers a few.
inline std::vector<BlockScene> some_scenes() {
  std::vector<BlockScene> some;
  for (const BlockScene& scene : block_scenes()) {
    if (!kSanitized || scene.name == "noise" || scene.name == "gyroidQuadric" || scene.name == "noiseLevels") {
      some.push_back(scene);
    }
  }
  return some;
}

inline BlockScene noise_scene() { return block_scenes().front(); }

// The scenes that go with a number of triangles.
inline std::vector<BlockScene> number_scenes() {
  std::vector<BlockScene> some = some_scenes();
  std::erase_if(some, [](const BlockScene& scene) { return !scene.options.levels.empty(); });
  return some;
}

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

inline BlockScene to_number(BlockScene scene, std::uint64_t triangles, double error = kNoLimit) {
  scene.options.triangles = triangles;
  scene.options.error = Length::units(error);
  return scene;
}

// The scene with a share of all triangles in place of a number.
inline BlockScene to_share(BlockScene scene, double share) {
  scene.options.triangles = 0;
  scene.options.share = share;
  return scene;
}

inline std::uint64_t all_triangles(const BlockScene& scene) {
  MeshOptions full = scene.options;
  full.error = Length::units(0);
  MemorySink sink;
  return mesh_volume(*scene.open(), sink, full).triangles_extracted;
}

struct BlockRun {
  std::vector<TriangleMesh> meshes;
  MeshReport report;
};

// mesh(sinks): makes the meshes of all levels.
template <class Mesh>
BlockRun run_into_memory(const BlockScene& scene, const Mesh& mesh) {
  std::vector<MemorySink> sinks(scene.options.levels.size() + 1);
  std::vector<MeshSink*> pointers;
  for (MemorySink& sink : sinks) pointers.push_back(&sink);
  BlockRun run;
  run.report = mesh(std::span<MeshSink* const>(pointers));
  for (MemorySink& sink : sinks) {
    EXPECT_TRUE(sink.finished);
    run.meshes.push_back(std::move(sink.mesh));
  }
  return run;
}

inline BlockRun run_sweep(const BlockScene& scene) {
  return run_into_memory(
      scene, [&](std::span<MeshSink* const> sinks) { return mesh_volume(*scene.open(), sinks, scene.options); });
}

inline void expect_same(const BlockRun& found, const BlockRun& expected) {
  const MeshReport& a = found.report;
  const MeshReport& b = expected.report;
  expect_same_surface(a, b);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t level = 0; level < a.levels.size(); ++level) expect_same_surface(a.levels[level], b.levels[level]);
  EXPECT_EQ(a.cells_crossed, b.cells_crossed);
  EXPECT_EQ(a.triangles_extracted, b.triangles_extracted);
  EXPECT_EQ(a.vertices_extracted, b.vertices_extracted);
  EXPECT_EQ(a.collapses, b.collapses);
  EXPECT_EQ(a.postponed, b.postponed);
  EXPECT_EQ(a.rekeyed, b.rekeyed);
  EXPECT_EQ(a.specks, b.specks);
  EXPECT_EQ(a.min, b.min);
  EXPECT_EQ(a.max, b.max);
  EXPECT_EQ(a.nan, b.nan);
  EXPECT_EQ(a.warnings, b.warnings);
  // The sinks have each vertex once, at its number.
  for (std::size_t n = 0; n < found.meshes.size(); ++n) {
    const MeshCheck check = check_mesh(found.meshes[n]);
    EXPECT_EQ(digest_text(check.digest), digest_text(check_mesh(expected.meshes[n]).digest));
    EXPECT_EQ(found.meshes[n].vertices.size(), expected.meshes[n].vertices.size());
    EXPECT_EQ(riders_digest(found.meshes[n]), riders_digest(expected.meshes[n]));
  }
}

inline void expect_same_by_number(const BlockRun& found, const BlockRun& expected) {
  expect_same(found, expected);
  EXPECT_EQ(found.report.error, expected.report.error);
  EXPECT_EQ(found.report.target, expected.report.target);
}

}  // namespace isoweave::testing
