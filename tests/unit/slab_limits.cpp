// The limits of a slab: the triangles that 32 bits can count, and the layers that an extractor takes.
// Threads: none, limits do not depend on them
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device/bulk_engine.hpp"
#include "device/simulated_device.hpp"
#include "extract/marching_cubes.hpp"
#include "extract/row_counts.hpp"
#include "isoweave/error.hpp"
#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "output/world.hpp"
#include "pipeline/device_back_end.hpp"
#include "pipeline/slab_planner.hpp"
#include "pipeline/volume_sweep.hpp"

namespace isoweave::testing::slab_limits_test {
namespace {

constexpr std::uint32_t kHalf = std::uint32_t{1} << 31;

std::string refusal_of(std::vector<RowCounts> rows, std::uint32_t inherited) {
  try {
    place_rows(rows, 2, inherited);
  } catch (const OverMemory& error) {
    return error.what();
  }
  return "";
}

TEST(SlabLimits, PlacesOfRowsAreSumsOfThoseBefore) {
  std::vector<RowCounts> rows{{3, kHalf, 2, 0}, {4, kHalf - 1, 1, 5}, {}};
  const RowSums sums = place_rows(rows, 1, 7);
  EXPECT_EQ(sums.vertices, 7U);
  EXPECT_EQ(sums.triangles, 0xffffffffU);
  EXPECT_EQ(sums.cells, 3U);
  EXPECT_EQ(sums.on_border, 5U);
  EXPECT_EQ(rows[0].triangles, 0U);
  EXPECT_EQ(rows[1].vertices, 3U);
  EXPECT_EQ(rows[1].triangles, kHalf);
  EXPECT_EQ(rows[2].vertices, 7U);
  EXPECT_EQ(rows[2].triangles, 0xffffffffU);
}

TEST(SlabLimits, TrianglesBeyond32BitsAreRefused) {
  EXPECT_EQ(refusal_of({{1, kHalf}, {1, kHalf - 1}, {}}, 0), "");
  EXPECT_EQ(refusal_of({{1, kHalf}, {1, kHalf}, {}}, 0),
            "a slab of 2 layers holds 4294967296 triangles, expected fewer than 2^32: choose thinner slabs");
  EXPECT_NE(refusal_of({{1, 0xffffffffU}, {1, 0xffffffffU}, {1, 0xffffffffU}}, 0), "");
}

TEST(SlabLimits, VerticesBeyond32BitsAreRefusedWithTheInheritedOnes) {
  EXPECT_EQ(refusal_of({{kHalf, 1}, {kHalf - 10, 1}, {}}, 9), "");
  EXPECT_EQ(refusal_of({{kHalf, 1}, {kHalf - 10, 1}, {}}, 10),
            "a slab of 2 layers holds 4294967296 vertices, expected fewer than 2^32: choose thinner slabs");
}

TEST(SlabLimits, ARowWhoseTrianglesCannotBeCountedIsRefused) {
  VolumeInfo volume;
  volume.dims = {kMostRowSamples + 1, 1, 1};
  const Executor executor(1);
  const auto extract = [&] { MarchingCubes(volume, {{0.5, true, true}, false}, executor); };
  EXPECT_THROW(extract(), OverMemory);
}

VolumeInfo square_slices(std::int64_t side) {
  VolumeInfo volume;
  volume.dims = {side, side, 500};
  volume.type = SampleType::kUint8;
  return volume;
}

BulkOptions bulk_options(const Task& task) { return {task.volume, task.rule, false, task.simplify.zone}; }

TEST(SlabLimits, ASliceThatADeviceCannotCountIsRefused) {
  const Task task = resolve(square_slices(23170), {}, {});  // 2^29 and a few with the layer of points around it
  const Executor executor(1);
  const auto begin = [&] { BulkEngine<HostDevice>(HostDevice(executor), bulk_options(task)); };
  EXPECT_THROW(begin(), OverMemory);
}

TEST(SlabLimits, SlabsAreNotThickerThanADeviceCanCount) {
  RunControl control;
  control.slab = 100;
  const Task task = resolve(square_slices(4158), {}, control);
  const Executor executor(1);
  BulkEngine<HostDevice> engine(HostDevice(executor), bulk_options(task));
  const DeviceExtractor extractor(engine);
  const SlabPlanner planner(task, control, task.volume, extractor, 1, 0);
  EXPECT_EQ(planner.next({}, 0).layers, (1 << 29) / (4160 * 4160));
}

// Marching cubes that take at most three layers at a time, and note how many they were asked for.
class FewLayers final : public Extractor {
 public:
  explicit FewLayers(std::unique_ptr<Extractor> cubes) : cubes_(std::move(cubes)) {}

  VertexNumbering numbering() const override { return cubes_->numbering(); }
  std::int64_t layers_left() const override { return cubes_->layers_left(); }
  std::pair<std::int64_t, std::int64_t> slices_for(std::int64_t layers) const override {
    return cubes_->slices_for(layers);
  }
  SlabCounts extract(const SliceWindow& window, std::int64_t layers, std::uint64_t most_vertices,
                     SurfacePiece& piece) override {
    asked.push_back(layers);
    return cubes_->extract(window, layers, most_vertices, piece);
  }
  std::int64_t most_layers() const override { return 3; }
  std::uint64_t inherited() const override { return cubes_->inherited(); }
  void serialize(StateWriter& state) const override { cubes_->serialize(state); }
  void serialize(StateReader& state) override { cubes_->serialize(state); }

  std::vector<std::int64_t> asked;

 private:
  std::unique_ptr<Extractor> cubes_;
};

// A run over 22 layers that asks for slabs of so many.
struct SmallRun {
  explicit SmallRun(std::int64_t slab) {
    GenerateOptions volume;
    volume.kind = "gyroid";
    volume.dims = {12, 11, 21};
    options.iso = suggested_iso(volume.kind, volume.type);
    control.slab = slab;
    source = generate_volume(volume);
    task = resolve(source->info(), options, control);
  }

  // As many steps as there are layers must be enough.
  void step_through(VolumeSweep& sweep) const {
    sweep.open();
    for (std::int64_t n = 0; n < sweep.layers() && !sweep.complete(); ++n) sweep.step();
    EXPECT_TRUE(sweep.complete());
    EXPECT_EQ(sweep.layers_done(), 22);
  }

  MeshOptions options;
  RunControl control;
  std::unique_ptr<SliceSource> source;
  Task task;
  MeshReport report;
};

TEST(SlabLimits, ASweepAsksForNoMoreLayersThanAnExtractorTakes) {
  SmallRun run(10);
  VolumeSweep sweep(*run.source, run.task, run.control, run.report);
  FewLayers extractor(sweep.make_extractor());
  sweep.begin(extractor, {}, nullptr);
  run.step_through(sweep);
  EXPECT_EQ(extractor.asked, (std::vector<std::int64_t>{3, 3, 3, 3, 3, 3, 3, 1}));
}

// A device could count more layers than the volume has.
TEST(SlabLimits, SlabsOfADeviceEndWithTheVolume) {
  SmallRun run(8);
  MeshInMemory expected;
  mesh_volume(*run.source, expected, run.options, run.control);
  run.source = SmallRun(8).source;
  VolumeSweep sweep(*run.source, run.task, run.control, run.report);
  BulkEngine<HostDevice> engine(HostDevice(sweep.executor()), bulk_options(run.task));
  DeviceExtractor extractor(engine);
  const World world(run.task.volume.geometry, run.task.space, run.task.offset);
  MeshInMemory mesh;
  DeviceBackEnd back_end(engine, run.task.simplify, world, mesh, sweep.executor(), true);
  sweep.begin(extractor, {}, &back_end);
  run.step_through(sweep);
  back_end.wait_for_sinks();
  EXPECT_EQ(check_mesh(mesh.copy()).digest, check_mesh(expected.copy()).digest);
}

}  // namespace
}  // namespace isoweave::testing::slab_limits_test
