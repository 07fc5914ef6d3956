// The options of a run with every extractor: values, normals, caps, distances, components, and what is refused.
// Threads: none, they are shown by the conformance of extractors
#include <cmath>

#include "grids.hpp"
#include "pipeline/task.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::extractor_options_test {
namespace {

TEST(Extractors, GiveVerticesTheValuesOfAnotherVolume) {
  std::mt19937 random(9);
  const Grid grid = random_grid({8, 7, 6}, random);
  Grid ramp{grid.dims};
  ramp.fill([](std::int64_t i, std::int64_t j, std::int64_t k) {
    return static_cast<float>(i) + 10 * static_cast<float>(j) - 3 * static_cast<float>(k);
  });
  for (const ExtractorKind extractor : kAllExtractors) {
    MeshOptions options = full();
    options.values = std::make_shared<MemoryVolume>(ramp.dims, ramp.samples);
    const Made made = make(grid, extractor, false, {1, 1, 1}, options);
    ASSERT_EQ(made.mesh.values.size(), made.mesh.vertices.size());
    for (std::size_t v = 0; v < made.mesh.vertices.size(); ++v) {
      const Point& p = made.mesh.vertices[v];
      ASSERT_NEAR(made.mesh.values[v], p[0] + 10 * p[1] - 3 * p[2], 1e-4) << static_cast<int>(extractor);
    }
  }
}

TEST(Extractors, GiveNormalsThatPointOutwards) {
  GenerateOptions sphere;
  sphere.dims = {24, 24, 24};
  for (const ExtractorKind extractor : kAllExtractors) {
    MeshOptions options = full();
    options.extractor = extractor;
    options.normals = Normals::kGradient;
    MemorySink sink;
    mesh_volume(*generate_volume(sphere), sink, options);
    ASSERT_EQ(sink.mesh.normals.size(), sink.mesh.vertices.size());
    for (std::size_t v = 0; v < sink.mesh.vertices.size(); ++v) {
      double along = 0, squared = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double from_centre = double{sink.mesh.vertices[v][axis]} - 11.5;
        along += from_centre * double{sink.mesh.normals[v][axis]};
        squared += from_centre * from_centre;
      }
      ASSERT_GT(along / std::sqrt(squared), 0.98) << static_cast<int>(extractor);
    }
  }
}

TEST(Extractors, HaveFlatCaps) {
  Grid grid{{6, 5, 4}, std::vector<float>(6 * 5 * 4, 1.0F)};
  const std::array<double, 3> sides{5 + 2.0 / 256, 4 + 2.0 / 256, 3 + 2.0 / 256};
  for (const ExtractorKind extractor : kAllExtractors) {
    SCOPED_TRACE(static_cast<int>(extractor));
    MeshOptions options = full();
    options.normals = Normals::kGradient;
    const Made made = make(grid, extractor, true, {1, 1, 1}, options);
    expect_manifold(made, true);
    EXPECT_EQ(made.check.euler, 2);
    for (std::size_t v = 0; v < made.mesh.vertices.size(); ++v) {
      int on_sides = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double p = double{made.mesh.vertices[v][axis]} + 1.0 / 256;
        if (std::abs(p) > 1e-5 && std::abs(p - sides[axis]) > 1e-5) continue;
        ++on_sides;
        ASSERT_GT((p > 1 ? 1 : -1) * made.mesh.normals[v][axis], 0.4);
      }
      ASSERT_GE(on_sides, 1);
    }
  }
}

TEST(Extractors, KeepTheDistanceThatIsGuaranteed) {
  GenerateOptions noise;
  noise.kind = "noise";
  noise.dims = {16, 15, 14};
  DistanceOptions distances;
  if (testing::kSanitized) distances.samples /= 10;
  for (const ExtractorKind extractor : kAllExtractors) {
    const auto run = [&](double error, double distance) {
      MeshOptions options;
      options.iso = 0.5;
      options.extractor = extractor;
      options.error = Length::voxels(error);
      options.max_distance = Length::voxels(distance);
      MemorySink sink;
      mesh_volume(*generate_volume(noise), sink, options);
      return std::move(sink.mesh);
    };
    const TriangleMesh fine = run(0, 0);
    const TriangleMesh coarse = run(2, 0.3);
    EXPECT_LT(coarse.triangles.size(), fine.triangles.size() / 2);
    EXPECT_LE(compare_meshes(coarse, fine, distances).a_to_b.max, 0.3001) << static_cast<int>(extractor);
  }
}

// Also where the mask is smoothed, which changes the connections of a trilinear surface.
TEST(Extractors, CountTheBorderOfTheComponentsThatAreKept) {
  GenerateOptions white;
  white.kind = "white";
  white.dims = {12, 11, 10};
  for (const ExtractorKind extractor : kAllExtractors) {
    for (const int smooth : {0, 3}) {
      SCOPED_TRACE(::testing::Message() << static_cast<int>(extractor) << ", smooth " << smooth);
      MeshOptions options = full();
      options.iso = 0.5;
      options.closed = false;
      options.extractor = extractor;
      options.smooth = smooth;
      const ComponentChoice choice = choose_components(*generate_volume(white), options, {.min_triangles = 20});
      options.components = borrow(choice);
      MemorySink sink;
      const MeshReport report = mesh_volume(*generate_volume(white), sink, options);
      EXPECT_GT(report.components_dropped, 0U);
      EXPECT_EQ(check_mesh(sink.mesh).open_edges, report.open_edges);
      EXPECT_EQ(count_triangles(*generate_volume(white), options), report.triangles);
    }
  }
}

TEST(Extractors, OtherThanCubesAreRefusedOnADevice) {
  MeshOptions options;
  RunControl control;
  control.device = Device::kCuda;
  EXPECT_NO_THROW(require_possible(RunKind::kMesh, options, control));
  options.extractor = ExtractorKind::kDual;
  EXPECT_THROW(require_possible(RunKind::kMesh, options, control), ImpossibleRun);
  EXPECT_NO_THROW(require_possible(RunKind::kLabels, options, {}));
}

TEST(Extractors, RefuseMoreSamplesThanTheyCanNumber) {
  VolumeInfo volume;
  volume.dims = {1 << 26, 1 << 12, 1 << 12};  // 2^50
  const auto resolved = [&](ExtractorKind extractor) {
    MeshOptions options;
    options.extractor = extractor;
    resolve(volume, options, {});
  };
  EXPECT_NO_THROW(resolved(ExtractorKind::kCubes));
  EXPECT_NO_THROW(resolved(ExtractorKind::kTetrahedra));
  EXPECT_THROW(resolved(ExtractorKind::kDual), BadInput);
}

}  // namespace
}  // namespace isoweave::testing::extractor_options_test
