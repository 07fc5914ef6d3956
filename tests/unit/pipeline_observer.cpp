// What an observer of the sweep sees: the mesh, and between two slabs a surface without seams that ends at the front.
// Threads: none, the sweep calls its observer by one thread, and schedules.cpp has its loops
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <utility>
#include <vector>

#include "surfaces.hpp"

namespace isoweave::testing::pipeline_observer_test {
namespace {

class Recorder final : public SweepObserver {
 public:
  void add_final(std::span<const TriangleCorners> triangles) override {
    final.insert(final.end(), triangles.begin(), triangles.end());
  }

  void end_slab(const Progress& progress, const SlabRecord& slab,
                const std::function<void(const Visitor&)>& visit_undecided) override {
    EXPECT_EQ(progress.layer, slab.layer);
    EXPECT_EQ(final.size(), slab.final_triangles);
    std::vector<TriangleCorners> undecided;
    visit_undecided(
        [&](std::span<const TriangleCorners> block) { undecided.insert(undecided.end(), block.begin(), block.end()); });
    EXPECT_EQ(undecided.size(), slab.undecided_triangles);
    slabs.push_back({slab.layer, final.size(), std::move(undecided)});
  }

  struct Slab {
    std::int64_t layer;
    std::size_t final;
    std::vector<TriangleCorners> undecided;
  };
  std::vector<TriangleCorners> final;
  std::vector<Slab> slabs;
};

struct Watched {
  Recorder seen;
  MemorySink sink;
  MeshReport report;
};

void run(Watched& watched, const GenerateOptions& volume, MeshOptions options, bool watch = true) {
  options.iso = suggested_iso(volume.kind, volume.type);
  const auto source = generate_volume(volume);
  RunControl control;
  control.threads = 2;
  control.slab = 7;
  if (watch) control.observer = borrow(watched.seen);
  watched.report = mesh_volume(*source, watched.sink, options, control);
}

GenerateOptions gyroid() {
  GenerateOptions volume;
  volume.kind = "gyroid";
  volume.dims = {40, 36, 48};
  volume.spacing = {0.5, 0.5, 0.75};
  return volume;
}

std::vector<TriangleCorners> corners_of(const TriangleMesh& mesh) {
  std::vector<TriangleCorners> triangles;
  for (const auto& t : mesh.triangles)
    triangles.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  return triangles;
}

// Edges that have a triangle on one side only.
std::vector<std::pair<Point, Point>> open_edges(std::span<const TriangleCorners> first,
                                                std::span<const TriangleCorners> second) {
  std::map<std::pair<Point, Point>, int> sides;
  for (const auto part : {first, second}) {
    for (const TriangleCorners& t : part) {
      for (std::size_t c = 0; c < 3; ++c) ++sides[{t[c], t[(c + 1) % 3]}];
    }
  }
  std::vector<std::pair<Point, Point>> open;
  for (const auto& [edge, count] : sides) {
    const auto twin = sides.find({edge.second, edge.first});
    if (count != (twin == sides.end() ? 0 : twin->second)) open.push_back(edge);
  }
  return open;
}

TEST(SweepObserver, SeesTheMeshInTheOrderOfTheOutput) {
  for (const double error : {0.0, 0.3}) {
    MeshOptions options;
    options.error = Length::voxels(error);
    Watched watched;
    run(watched, gyroid(), options);
    EXPECT_EQ(watched.seen.final, corners_of(watched.sink.mesh)) << error;
    EXPECT_GT(watched.seen.final.size(), 1000U);
    EXPECT_EQ(watched.seen.slabs.size(), watched.report.sweep.size());
    EXPECT_TRUE(watched.seen.slabs.back().undecided.empty());
    Watched alone;
    run(alone, gyroid(), options, false);
    EXPECT_EQ(watched.report.digest, alone.report.digest);
    EXPECT_TRUE(alone.seen.slabs.empty());
  }
}

TEST(SweepObserver, FinalAndUndecidedAreOneSurfaceUpToTheFront) {
  MeshOptions options;
  options.error = Length::voxels(0.3);
  Watched watched;
  run(watched, gyroid(), options);
  std::size_t held = 0;
  for (const auto& slab : watched.seen.slabs) {
    held += slab.undecided.size();
    const float front =
        0.75F * static_cast<float>(slab.layer - 1);  // a closed surface begins a layer before the samples
    const auto open = open_edges({watched.seen.final.data(), slab.final}, slab.undecided);
    EXPECT_EQ(open.empty(), slab.undecided.empty());
    for (const auto& [from, to] : open) {
      ASSERT_EQ(from[2], front);
      ASSERT_EQ(to[2], front);
    }
  }
  EXPECT_GT(held, 1000U);
}

TEST(SweepObserver, SeesCoordinatesAndOrientationOfTheOutput) {
  GenerateOptions volume = gyroid();
  const auto source = generate_volume(volume);
  std::vector<std::byte> bytes(source->info().slice_bytes() * 48);
  source->read(0, 48, bytes);
  std::vector<float> samples(bytes.size() / sizeof(float));
  std::memcpy(samples.data(), bytes.data(), bytes.size());
  MemoryVolume mirrored(volume.dims, samples);
  mirrored.info().geometry.direction = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
  mirrored.info().geometry.origin = {10, 20, 30};
  Watched watched;
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  RunControl control;
  control.slab = 9;
  control.observer = borrow(watched.seen);
  mesh_volume(mirrored, watched.sink, options, control);
  EXPECT_EQ(watched.seen.final, corners_of(watched.sink.mesh));
  const auto& slab = watched.seen.slabs[2];
  ASSERT_FALSE(slab.undecided.empty());
  // Edges between final and undecided triangles close only where both are turned the same way.
  for (const auto& [from, to] : open_edges({watched.seen.final.data(), slab.final}, slab.undecided)) {
    ASSERT_EQ(from[2], to[2]);
  }
}

TEST(SweepObserver, IsNotCalledByACount) {
  const auto source = generate_volume(gyroid());
  Recorder seen;
  RunControl control;
  control.observer = borrow(seen);
  MeshOptions options;
  EXPECT_GT(count_triangles(*source, options, control), 1000U);
  EXPECT_TRUE(seen.final.empty());
  EXPECT_TRUE(seen.slabs.empty());
}

TEST(SweepObserver, WhatItThrowsEndsTheRun) {
  class Full final : public SweepObserver {
   public:
    void add_final(std::span<const TriangleCorners>) override {}
    void end_slab(const Progress&, const SlabRecord&, const std::function<void(const Visitor&)>&) override {
      throw std::runtime_error("seen enough");
    }
  };
  const auto source = generate_volume(gyroid());
  Full seen;
  MemorySink sink;
  RunControl control;
  control.observer = borrow(seen);
  EXPECT_THROW(mesh_volume(*source, sink, MeshOptions{}, control), std::runtime_error);
  EXPECT_FALSE(sink.finished);
}

}  // namespace
}  // namespace isoweave::testing::pipeline_observer_test
