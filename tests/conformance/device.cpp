// A device gives the host's mesh: triangles, normals and every count. Its order is its own.
//
// The passes that a device runs are run on processors here, always; on a CUDA device where there is one.
#include <gtest/gtest.h>

#include <algorithm>

#include "device/bulk_engine.hpp"
#include "device/cuda_engine.hpp"
#include "device/simulated_device.hpp"
#include "extract/marching_cubes.hpp"
#include "pipeline/device_back_end.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::device_test {
namespace {

// The pipeline's way through an engine, slab by slab.
SurfaceRun sweep_on(std::unique_ptr<DeviceEngine> engine, SliceSource& source, std::int64_t slab) {
  const Executor executor(2);
  const World world;
  MemorySink sink;
  DeviceExtractor extractor(*engine);
  DeviceBackEnd back_end(*engine, SimplifyTask(), world, sink, executor, true);
  SliceWindow window(source, extractor.slices_for(1).first);
  SurfacePiece piece;
  SurfaceRun run;
  while (extractor.layers_left() > 0) {
    const std::int64_t layers = std::min(slab, extractor.layers_left());
    const auto [first, end] = extractor.slices_for(layers);
    window.advance(first, end);
    add_extracted(extractor.extract(window, layers, 1 << 30, piece), run.report);
    SlabRecord record;
    back_end.simplify(piece, extractor.layers_left() == 0, record);
    back_end.write(piece, record, run.report);
    run.report.sweep.push_back(record);
  }
  back_end.wait_for_sinks();
  back_end.finish(run.report);
  run.mesh = std::move(sink.mesh);
  return run;
}

BulkOptions bulk_options(const SurfaceCase& surface, const VolumeInfo& volume, bool normals) {
  return {volume, surface.rule(), normals, surface.zone()};
}

SurfaceRun run_on_processors(const SurfaceCase& surface, std::int64_t slab) {
  const Executor executor(3);
  const auto source = generate_volume(surface.volume);
  return sweep_on(
      std::make_unique<BulkEngine<HostDevice>>(HostDevice(executor), bulk_options(surface, source->info(), false)),
      *source, slab);
}

using Corner = std::array<Point, 2>;  // position, and normal where there are any

// From the least corner on, in an order that does not depend on that in the mesh.
std::vector<std::array<Corner, 3>> sorted_triangles(const TriangleMesh& mesh) {
  std::vector<std::array<Corner, 3>> sorted;
  for (const auto& triangle : mesh.triangles) {
    std::array<Corner, 3> corners{};
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c][0] = mesh.vertices[triangle[c]];
      if (!mesh.normals.empty()) corners[c][1] = mesh.normals[triangle[c]];
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    sorted.push_back(corners);
  }
  std::sort(sorted.begin(), sorted.end());
  return sorted;
}

void expect_same(const SurfaceRun& device, const SurfaceRun& host) {
  EXPECT_EQ(device.mesh.vertices.size(), host.mesh.vertices.size());
  EXPECT_TRUE(sorted_triangles(device.mesh) == sorted_triangles(host.mesh));
  EXPECT_EQ(digest_text(device.report.digest), digest_text(host.report.digest));
  EXPECT_EQ(device.report.triangles_extracted, host.report.triangles_extracted);
  EXPECT_EQ(device.report.vertices_extracted, host.report.vertices_extracted);
  EXPECT_EQ(device.report.collapses, host.report.collapses);
  EXPECT_EQ(device.report.postponed, host.report.postponed);
  EXPECT_EQ(device.report.rekeyed, host.report.rekeyed);
  EXPECT_EQ(device.report.specks, host.report.specks);
  EXPECT_EQ(device.report.open_edges, host.report.open_edges);
  EXPECT_EQ(device.report.components, host.report.components);
  EXPECT_EQ(device.report.euler, host.report.euler);
  EXPECT_EQ(device.report.nonmanifold_edges, 0u);
  EXPECT_EQ(device.report.nonmanifold_vertices, 0u);
}

class Device : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  SurfaceCase surface(double error, Quality quality) const {
    SurfaceCase surface;
    surface.volume.kind = std::get<0>(GetParam());
    surface.volume.dims = {70, 15, 20};
    surface.volume.spacing = {0.7, 0.8, 1.9};
    surface.volume.seed = 7;
    surface.closed = std::get<1>(GetParam());
    surface.error = error;
    surface.quality = quality;
    surface.drop_specks = quality == Quality::kFast;
    return surface;
  }

  // run(surface, slab): on the device.
  template <class Run>
  void expect_host_results(const Run& run) const {
    for (const Quality quality : {Quality::kFast, Quality::kNormal, Quality::kFine}) {
      for (const double error : {0.0, 0.05, 0.4}) {
        if (quality != Quality::kNormal && error != 0.4) continue;
        const SurfaceCase surface = this->surface(error, quality);
        for (const std::int64_t slab : {std::int64_t{1}, std::int64_t{5}, kWholeVolume}) {
          SCOPED_TRACE("error " + std::to_string(error) + ", slab " + std::to_string(slab));
          expect_same(run(surface, slab), sweep(surface, Schedule::kRounds, 1, slab));
        }
      }
    }
  }
};

TEST_P(Device, GivesTheHostsMesh) { expect_host_results(run_on_processors); }

TEST_P(Device, GivesTheHostsMeshByCuda) {
  try {
    expect_host_results([](const SurfaceCase& surface, std::int64_t slab) {
      const auto source = generate_volume(surface.volume);
      return sweep_on(make_cuda_engine(bulk_options(surface, source->info(), false)), *source, slab);
    });
  } catch (const DeviceError& error) {
    GTEST_SKIP() << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Device,
                         ::testing::Combine(::testing::Values("gyroid", "sphere", "white", "box", "noise", "specks"),
                                            ::testing::Bool()),
                         [](const auto& test) {
                           return std::get<0>(test.param) + (std::get<1>(test.param) ? "Closed" : "Open");
                         });

// Every type of sample, with normals, through engine and host: what is read, and what is left out.
class DeviceSamples : public ::testing::TestWithParam<SampleType> {};

TEST_P(DeviceSamples, AreReadAsTheHostReadsThem) {
  GenerateOptions volume;
  volume.kind = "noise";
  volume.dims = {67, 9, 11};
  volume.type = GetParam();
  volume.seed = 3;
  for (const bool above : {true, false}) {
    MeshOptions options;
    options.iso = suggested_iso(volume.kind, volume.type);
    options.inside_above = above;
    options.normals = Normals::kGradient;
    options.error = Length::voxels(0.1);
    RunControl control;
    control.slab = 4;
    control.schedule = Schedule::kRounds;
    MemorySink expected;
    mesh_volume(*generate_volume(volume), expected, options, control);

    const Executor executor(2);
    const auto source = generate_volume(volume);
    const BulkOptions bulk{source->info(),
                           stored_rule(source->info(), options),
                           true,
                           {VertexNumbering::of_cube_edges(volume.dims), 1, retire_cost(0.1, 1)}};
    const SurfaceRun run = sweep_on(std::make_unique<BulkEngine<HostDevice>>(HostDevice(executor), bulk), *source, 4);
    EXPECT_GT(expected.mesh.triangles.size(), 100u);
    EXPECT_EQ(run.mesh.vertices.size(), expected.mesh.vertices.size());
    EXPECT_EQ(run.mesh.normals.size(), run.mesh.vertices.size());
    EXPECT_TRUE(sorted_triangles(run.mesh) == sorted_triangles(expected.mesh));
  }
}

INSTANTIATE_TEST_SUITE_P(Types, DeviceSamples,
                         ::testing::Values(SampleType::kUint8, SampleType::kInt8, SampleType::kUint16,
                                           SampleType::kInt16, SampleType::kUint32, SampleType::kInt32,
                                           SampleType::kFloat32, SampleType::kFloat64),
                         [](const auto& test) { return std::string(sample_type_name(test.param)); });

// A slab that turns out too full is cut where the host would cut it.
TEST(DeviceEngine, CutsSlabsAtTheLayerThatIsTooMuch) {
  SurfaceCase surface;
  surface.volume.kind = "gyroid";
  surface.volume.dims = {40, 40, 24};
  const Executor executor(2);
  const auto host_source = generate_volume(surface.volume);
  MarchingCubes host(host_source->info(), {surface.rule(), false}, executor);
  SliceWindow host_window(*host_source);
  const auto source = generate_volume(surface.volume);
  BulkEngine<HostDevice> engine(HostDevice(executor), bulk_options(surface, source->info(), false));
  SliceWindow window(*source);
  SurfacePiece piece;
  while (engine.layers_left() > 0) {
    ASSERT_EQ(engine.layers_left(), host.layers_left());
    const std::int64_t layers = std::min<std::int64_t>(8, engine.layers_left());
    host_window.advance(host.slices_for(layers).first, host.slices_for(layers).second);
    window.advance(engine.slices_for(layers).first, engine.slices_for(layers).second);
    engine.upload(window, layers);
    const SlabCounts counts = engine.extract(layers, 3000);
    EXPECT_EQ(counts.layers, host.extract(host_window, layers, 3000, piece).layers);
    EXPECT_EQ(counts.vertices, piece.positions.size());
    EXPECT_EQ(counts.triangles, piece.triangles.size());
    EXPECT_EQ(counts.cells_crossed, piece.cells_crossed);
    engine.append();
  }
}

TEST(DeviceEngine, IsRefusedWhatItCannotDo) {
  GenerateOptions volume;
  volume.dims = {8, 8, 8};
  RunControl control;
  control.device = isoweave::Device::kCuda;
  MemorySink sink;
  MeshOptions options;
  options.triangles = 100;
  EXPECT_THROW(mesh_volume(*generate_volume(volume), sink, options, control), std::invalid_argument);
  options.triangles = 0;
  control.schedule = Schedule::kQueue;
  EXPECT_THROW(mesh_volume(*generate_volume(volume), sink, options, control), std::invalid_argument);
  control.schedule = Schedule::kAutomatic;
  options.max_distance = Length::voxels(1);
  EXPECT_THROW(mesh_volume(*generate_volume(volume), sink, options, control), std::invalid_argument);
}

}  // namespace
}  // namespace isoweave::testing::device_test
