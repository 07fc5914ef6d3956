// Runs of the pipeline's pieces, as tests need them: small volumes, any schedule, the mesh in memory.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "extract/make_extractor.hpp"
#include "isoweave/error.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "output/final_output.hpp"
#include "pipeline/run_report.hpp"
#include "sanitized.hpp"
#include "simplify/simplifier.hpp"
#include "volume/axes.hpp"

namespace isoweave::testing {

// A volume in memory.
class MemoryVolume final : public SliceSource {
 public:
  MemoryVolume(std::array<std::int64_t, 3> dims, std::vector<float> samples) : samples_(std::move(samples)) {
    info_.path = "memory";
    info_.format = "memory";
    info_.dims = dims;
    info_.type = SampleType::kFloat32;
  }

  const VolumeInfo& info() const override { return info_; }
  VolumeInfo& info() { return info_; }

  void read(std::int64_t first, std::int64_t count, std::span<std::byte> out) override {
    std::memcpy(out.data(), samples_.data() + first * info_.slice_samples(),
                static_cast<std::size_t>(count) * info_.slice_bytes());
  }

 private:
  VolumeInfo info_;
  std::vector<float> samples_;
};

class MemorySink final : public MeshSink {
 public:
  void append(const MeshPiece& piece) override {
    mesh.vertices.insert(mesh.vertices.end(), piece.vertices.begin(), piece.vertices.end());
    mesh.normals.insert(mesh.normals.end(), piece.normals.begin(), piece.normals.end());
    mesh.values.insert(mesh.values.end(), piece.values.begin(), piece.values.end());
    for (const auto& t : piece.triangles) {
      mesh.triangles.push_back(
          {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]), static_cast<std::uint32_t>(t[2])});
    }
  }
  void finish() override { finished = true; }

  TriangleMesh mesh;
  bool finished = false;
};

// Two reports of the same surface have the same counts.
inline void expect_same_surface(const SurfaceReport& found, const SurfaceReport& expected) {
  EXPECT_EQ(found.error, expected.error);
  EXPECT_EQ(found.triangles, expected.triangles);
  EXPECT_EQ(found.vertices, expected.vertices);
  EXPECT_EQ(found.open_edges, expected.open_edges);
  EXPECT_EQ(found.nonmanifold_edges, expected.nonmanifold_edges);
  EXPECT_EQ(found.nonmanifold_vertices, expected.nonmanifold_vertices);
  EXPECT_EQ(found.components, expected.components);
  EXPECT_EQ(found.euler, expected.euler);
  EXPECT_EQ(digest_text(found.digest), digest_text(expected.digest));
}

// Of what rides on the vertices, in any order of vertices.
inline std::uint64_t riders_digest(const TriangleMesh& mesh) {
  std::uint64_t sum = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    std::uint64_t bits = 0;
    const auto add = [&](float number) { bits = mix_bits(bits + std::bit_cast<std::uint32_t>(number)); };
    for (const float number : mesh.vertices[v]) add(number);
    if (!mesh.normals.empty()) {
      for (const float number : mesh.normals[v]) add(number);
    }
    if (!mesh.values.empty()) add(mesh.values[v]);
    sum += bits;
  }
  return sum;
}

struct SurfaceCase {
  GenerateOptions volume;
  bool closed = true;
  double error = 0.2;  // mean voxels
  Quality quality = Quality::kNormal;
  bool drop_specks = false;
  double max_distance = 0;  // mean voxels
  bool normals_count = false;
  ExtractorKind extractor = ExtractorKind::kCubes;

  IsoRule rule() const { return {suggested_iso(volume.kind, volume.type), true, closed}; }
  double voxel() const { return cube_root(volume.spacing[0] * volume.spacing[1] * volume.spacing[2]); }

  ZoneOptions zone() const {
    const double a0 = voxel() * voxel();
    const auto& [x, y, z] = volume.spacing;
    const double reach = cells_of_triangle(extractor);
    return {numbering_of(extractor, volume.dims),
            a0,
            retire_cost(error * voxel(), a0),
            drop_specks,
            max_distance * voxel(),
            {x, y, z},
            {reach * x, reach * y, reach * z},
            normals_count,
            quality};
  }
};

struct SurfaceRun {
  TriangleMesh mesh;
  MeshReport report;
};

// Sweeps slab by slab; `decide` settles what it can after each slab.
template <class Decide>
SurfaceRun sweep(const SurfaceCase& surface, std::int64_t slab, const Executor& executor, Simplifier& simplifier,
                 Decide&& decide) {
  const auto source = generate_volume(surface.volume);
  const std::unique_ptr<Extractor> extractor =
      make_extractor(surface.extractor, source->info(), {surface.rule(), surface.normals_count}, executor);
  SliceWindow window(*source);
  MemorySink sink;
  const World world;
  FinalOutput output(world, sink, executor);
  SurfacePiece piece;
  SurfaceRun run;
  while (extractor->layers_left() > 0) {
    const std::int64_t layers = std::min(slab, extractor->layers_left());
    const auto [first, end] = extractor->slices_for(layers);
    window.advance(first, end);
    extractor->extract(window, layers, ~std::uint64_t{0}, piece);
    run.report.triangles_extracted += piece.triangles.size();
    run.report.vertices_extracted += piece.positions.size();
    simplifier.append(piece);
    decide();
    output.take(simplifier.final_source());
  }
  output.wait();
  output.report(run.report);
  report_simplifier(simplifier, run.report);
  run.mesh = std::move(sink.mesh);
  return run;
}

inline SurfaceRun sweep(const SurfaceCase& surface, Schedule schedule, int threads, std::int64_t slab) {
  const Executor executor(threads);
  Simplifier simplifier({surface.zone(), schedule}, executor, nullptr);
  return sweep(surface, slab, executor, simplifier, [&] { simplifier.decide(); });
}

inline constexpr std::int64_t kWholeVolume = 1 << 20;

}  // namespace isoweave::testing
