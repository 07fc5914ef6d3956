// What a device runs, run on processors: the same mesh, counts and order of output as the host's own path.
#include <gtest/gtest.h>

#include "device/bulk_engine.hpp"
#include "device/host_device.hpp"
#include "surfaces.hpp"

namespace isoweave::testing {
namespace {

using Engine = BulkEngine<HostDevice>;

struct DeviceRun {
  TriangleMesh mesh;
  SlabCounts counts;
  DecisionCounts decisions;
  std::uint64_t open_edges = 0;
};

DeviceRun run_on_device(const SurfaceCase& surface, std::int64_t slab, bool normals) {
  const Executor executor(3);
  const auto source = generate_volume(surface.volume);
  Engine engine(HostDevice(executor), {source->info(), surface.rule(), normals, surface.zone(), surface.quality});
  SliceWindow window(*source, engine.slices_for(1).first);
  DeviceRun run;
  FinalPiece piece;
  while (engine.layers_left() > 0) {
    const std::int64_t layers = std::min(slab, engine.layers_left());
    const auto [first, end] = engine.slices_for(layers);
    window.advance(first, end);
    const SlabCounts counts = engine.extract(window, layers, 1 << 30);
    run.counts.cells_crossed += counts.cells_crossed;
    run.counts.triangles += counts.triangles;
    engine.append();
    engine.decide();
    engine.name_final();
    const std::uint64_t written = run.mesh.vertices.size();
    engine.take_final(written, 0, piece);
    for (std::size_t n = 0; n < piece.new_vertices; ++n) {
      const Vec3 p = piece.vertices[n].position;
      run.mesh.vertices.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    }
    run.mesh.normals.insert(run.mesh.normals.end(), piece.normals.begin(), piece.normals.end());
    for (const auto& triangle : piece.triangles) {
      std::array<std::uint32_t, 3> numbers;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint64_t number =
            triangle[c] < piece.new_vertices ? written + triangle[c] : piece.vertices[triangle[c]].output;
        numbers[c] = static_cast<std::uint32_t>(number);
      }
      run.mesh.triangles.push_back(numbers);
    }
  }
  run.decisions = engine.decisions();
  run.open_edges = engine.open_edges();
  EXPECT_EQ(engine.defects().nonmanifold_edges, 0u);
  EXPECT_EQ(engine.defects().nonmanifold_vertices, 0u);
  EXPECT_EQ(engine.live_triangles(), 0u);
  return run;
}

class Device : public ::testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(Device, GivesTheHostsMeshInTheHostsOrder) {
  SurfaceCase surface;
  surface.volume.kind = std::get<0>(GetParam());
  surface.volume.dims = {70, 15, 20};
  surface.volume.spacing = {0.7, 0.8, 1.9};
  surface.volume.seed = 7;
  surface.closed = std::get<1>(GetParam());
  for (const double error : {0.0, 0.05, 0.4}) {
    surface.error = error;
    for (const std::int64_t slab : {std::int64_t{1}, std::int64_t{5}, kWholeVolume}) {
      const SurfaceRun host = sweep(surface, Schedule::kRounds, 1, slab);
      const DeviceRun device = run_on_device(surface, slab, false);
      EXPECT_EQ(device.mesh.vertices, host.mesh.vertices) << "error " << error << ", slab " << slab;
      EXPECT_EQ(device.mesh.triangles, host.mesh.triangles) << "error " << error << ", slab " << slab;
      EXPECT_EQ(device.counts.triangles, host.report.triangles_extracted);
      EXPECT_EQ(device.decisions.collapses, host.report.collapses);
      EXPECT_EQ(device.decisions.postponed, host.report.postponed);
      EXPECT_EQ(device.decisions.rekeyed, host.report.rekeyed);
      EXPECT_EQ(device.open_edges, host.report.open_edges);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Device,
                         ::testing::Combine(::testing::Values("gyroid", "sphere", "white", "box", "noise", "specks"),
                                            ::testing::Bool()),
                         [](const auto& test) {
                           return std::get<0>(test.param) + (std::get<1>(test.param) ? "Closed" : "Open");
                         });

}  // namespace
}  // namespace isoweave::testing
