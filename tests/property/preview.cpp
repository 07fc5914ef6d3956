// Previews: vertex clustering written a second time gives the same, and slabs, threads and pieces change no bit.
// Threads: Preview.*
#include "isoweave/preview.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "grids.hpp"
#include "isoweave/error.hpp"
#include "meshes.hpp"
#include "plain_rules/clusters.hpp"

namespace isoweave::testing::preview_test {
namespace {

struct Preview {
  TriangleMesh mesh;
  MeshReport report;
};

Preview preview(SliceSource& volume, const PreviewOptions& options, const RunControl& control = {}) {
  MemorySink sink;
  Preview made;
  made.report = preview_volume(volume, sink, options, control);
  EXPECT_TRUE(sink.finished);
  made.mesh = std::move(sink.mesh);
  return made;
}

Preview preview(const TriangleMesh& mesh, const Length& cell, const RunControl& control = {}) {
  MemorySink sink;
  Preview made;
  made.report = preview_mesh(mesh, sink, cell, control);
  EXPECT_TRUE(sink.finished);
  made.mesh = std::move(sink.mesh);
  return made;
}

GenerateOptions generated(const char* kind, const std::array<double, 3>& spacing = {1, 1, 1},
                          SampleType type = SampleType::kFloat32) {
  GenerateOptions options;
  options.kind = kind;
  options.dims = {23, 19, 27};
  options.type = type;
  options.spacing = spacing;
  return options;
}

PreviewOptions options_for(const GenerateOptions& volume, double cell, bool closed = true) {
  PreviewOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  options.closed = closed;
  options.cell = Length::units(cell);
  return options;
}

TriangleMesh full_mesh(SliceSource& volume, const PreviewOptions& options) {
  MemorySink sink;
  mesh_volume(volume, sink, full_surface(options));
  return std::move(sink.mesh);
}

// Compares with the rules that were written a second time. close: how far places may differ, by rounding.
void expect_clustered(const Preview& found, const TriangleMesh& full, const std::array<double, 3>& low, double side,
                      double close) {
  const plain::Clustered expected = plain::cluster(full, low, side);
  ASSERT_TRUE(found.report.preview.has_value());
  EXPECT_EQ(found.report.preview->cells, expected.cells);
  EXPECT_EQ(found.report.preview->collapsed, expected.collapsed);
  EXPECT_EQ(found.report.preview->repeated, expected.repeated);
  EXPECT_NEAR(found.report.preview->plane_rms, expected.plane_rms, close);
  EXPECT_DOUBLE_EQ(found.report.preview->cell, side);
  ASSERT_EQ(found.mesh.vertices.size(), expected.vertices.size());
  std::vector<plain::Cell> cells;
  for (const Point& point : found.mesh.vertices) {
    cells.push_back(plain::cell_of(point, low, side));
    const auto vertex = expected.vertices.find(cells.back());
    ASSERT_NE(vertex, expected.vertices.end());
    for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(point[n], vertex->second[n], close);
  }
  ASSERT_EQ(found.mesh.triangles.size(), expected.triangles.size());
  for (const auto& t : found.mesh.triangles) {
    std::array<plain::Cell, 3> triangle{cells[t[0]], cells[t[1]], cells[t[2]]};
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
    EXPECT_TRUE(expected.triangles.contains(triangle));
  }
}

// Sides of cells by which no vertex lies on the side of a cell, but for rounding.
constexpr double kCell = 2.3713;

TEST(Preview, OfVolumesIsThatOfTheRulesWrittenASecondTime) {
  for (const char* kind : {"smooth", "noise", "gyroid", "box", "specks"}) {
    for (const std::array<double, 3>& spacing : {std::array{1.0, 1.0, 1.0}, std::array{0.7, 1.3, 2.1}}) {
      for (const bool closed : {true, false}) {
        SCOPED_TRACE(std::string(kind) + (closed ? " closed" : " open"));
        const GenerateOptions volume = generated(kind, spacing);
        const PreviewOptions options = options_for(volume, kCell, closed);
        const TriangleMesh full = full_mesh(*generate_volume(volume), options);
        const Preview found = preview(*generate_volume(volume), options);
        EXPECT_EQ(found.report.triangles_extracted, full.triangles.size());
        expect_clustered(found, full, {0, 0, 0}, kCell, 2e-4);
      }
    }
  }
}

// A soup of small triangles, some without area, some with a corner twice.
TriangleMesh soup(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-20, 30);
  std::uniform_real_distribution<float> near(-3, 3);
  TriangleMesh mesh;
  for (std::uint32_t n = 0; n < 900; ++n) {
    const Point p{place(random), place(random), place(random)};
    const bool flat = n % 50 == 0;
    for (int c = 0; c < 3; ++c) {
      mesh.vertices.push_back({p[0] + (flat ? 0.5F * static_cast<float>(c) : near(random)),
                               p[1] + (flat ? 0 : near(random)), p[2] + (flat ? 0 : near(random))});
    }
    mesh.triangles.push_back({3 * n, 3 * n + 1, 3 * n + 2});
  }
  return mesh;
}

TEST(Preview, OfMeshesIsThatOfTheRulesWrittenASecondTime) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    for (const double side : {0.9, 2.7, 11.3}) {
      const TriangleMesh mesh = soup(seed);
      std::array<double, 3> low{1e9, 1e9, 1e9};
      for (const Point& p : mesh.vertices) {
        for (std::size_t n = 0; n < 3; ++n) low[n] = std::min(low[n], double{p[n]});
      }
      expect_clustered(preview(mesh, Length::units(side)), mesh, low, side, 1e-4);
    }
  }
}

TEST(Preview, DoesNotDependOnSlabsAndThreads) {
  for (const ExtractorKind extractor : kAllExtractors) {
    for (const char* kind : {"noise", "smooth"}) {
      const GenerateOptions volume = generated(kind, {0.7, 1.3, 2.1});
      PreviewOptions options = options_for(volume, 3.1);
      options.extractor = extractor;
      RunControl whole;
      whole.slab = kWholeVolume;
      whole.threads = 1;
      const Preview expected = preview(*generate_volume(volume), options, whole);
      EXPECT_GT(expected.report.triangles, 500U);
      for (const std::int64_t slab : {1, 5, 0}) {
        for (const int threads : {1, 3}) {
          RunControl control;
          control.slab = slab;
          control.threads = threads;
          const Preview found = preview(*generate_volume(volume), options, control);
          expect_same_surface(found.report, expected.report);
          EXPECT_EQ(found.mesh.vertices, expected.mesh.vertices);
          EXPECT_EQ(found.mesh.triangles, expected.mesh.triangles);
          EXPECT_EQ(found.report.preview->plane_rms, expected.report.preview->plane_rms);
        }
      }
    }
  }
}

TEST(Preview, IsInTheOrderOfItsVertices) {
  const GenerateOptions volume = generated("noise");
  const auto triangles = preview(*generate_volume(volume), options_for(volume, kCell)).mesh.triangles;
  EXPECT_TRUE(std::is_sorted(triangles.begin(), triangles.end()));
  for (const auto& t : triangles) EXPECT_TRUE(t[0] < t[1] && t[0] < t[2]);
}

TEST(Preview, DoesNotDependOnPiecesOfAMesh) {
  const TriangleMesh mesh = soup(7);
  const Preview expected = preview(mesh, Length::voxels(1.5));
  for (const std::uint64_t piece : {1U, 7U, 400U, 5000U}) {
    for (const int threads : {1, 3}) {
      RunControl control;
      control.piece = piece;
      control.threads = threads;
      const Preview found = preview(mesh, Length::voxels(1.5), control);
      EXPECT_EQ(found.mesh.vertices, expected.mesh.vertices);
      EXPECT_EQ(found.mesh.triangles, expected.mesh.triangles);
    }
  }
}

TEST(Preview, ReportsWhatACheckFinds) {
  const GenerateOptions volume = generated("noise");
  const Preview found = preview(*generate_volume(volume), options_for(volume, kCell));
  const MeshCheck check = check_mesh(found.mesh);
  const MeshReport& report = found.report;
  EXPECT_EQ(report.triangles, check.triangles);
  EXPECT_EQ(report.vertices, check.vertices);
  EXPECT_EQ(check.unused_vertices, 0U);
  EXPECT_EQ(check.degenerate_triangles, 0U);
  EXPECT_EQ(check.coincident_triangles, 0U);
  EXPECT_GT(check.nonmanifold_edges, 0U);
  EXPECT_EQ(report.nonmanifold_edges, check.nonmanifold_edges);
  EXPECT_EQ(report.nonmanifold_vertices, check.nonmanifold_vertices);
  EXPECT_EQ(report.open_edges, check.open_edges);
  EXPECT_EQ(report.components, check.components);
  EXPECT_EQ(report.euler, check.euler);
  EXPECT_EQ(report.digest, check.digest);
  EXPECT_EQ(report.triangles_extracted, report.triangles + report.preview->collapsed + report.preview->repeated);
}

TEST(Preview, LiesWithinADiagonalOfACellFromTheSurface) {
  for (const char* kind : {"noise", "smooth", "gyroid"}) {
    const GenerateOptions volume = generated(kind);
    const PreviewOptions options = options_for(volume, 3.3);
    const TriangleMesh full = full_mesh(*generate_volume(volume), options);
    const MeshDistance distance = compare_meshes(preview(*generate_volume(volume), options).mesh, full, {20000});
    EXPECT_LE(distance.a_to_b.max, 3.3 * std::sqrt(3.0));
  }
}

TEST(Preview, InCellsSmallerThanTrianglesIsTheFullSurface) {
  for (const bool closed : {true, false}) {
    const GenerateOptions volume = generated("gyroid");
    const PreviewOptions options = options_for(volume, 1e-4, closed);
    const TriangleMesh full = full_mesh(*generate_volume(volume), options);
    const Preview found = preview(*generate_volume(volume), options);
    const MeshCheck expected = check_mesh(full);
    EXPECT_EQ(found.report.triangles, expected.triangles);
    EXPECT_EQ(found.report.vertices, expected.vertices);
    EXPECT_EQ(found.report.open_edges, expected.open_edges);
    EXPECT_EQ(found.report.euler, expected.euler);
    EXPECT_EQ(found.report.nonmanifold_edges, 0U);
    EXPECT_LT(compare_meshes(found.mesh, full, {20000}).max, 1e-4);
  }
}

TEST(Preview, IsTheSameForSamplesOfEveryType) {
  const Grid grid = [] {
    Grid values{{14, 13, 12}};
    values.fill([](std::int64_t i, std::int64_t j, std::int64_t k) {
      return static_cast<float>((i * i + 3 * j * j + 2 * k * k + 5 * i * j) % 97);
    });
    return values;
  }();
  PreviewOptions options;
  options.iso = 40.25;
  MemoryVolume floats(grid.dims, grid.samples);
  const std::uint64_t expected = preview(floats, options).report.digest;
  const auto digest_of = [&]<class T>(T, SampleType type) {
    std::vector<T> samples;
    for (const float sample : grid.samples) samples.push_back(static_cast<T>(sample));
    VolumeInfo info;
    info.dims = grid.dims;
    info.type = type;
    return preview(*volume_in_memory(info, std::as_bytes(std::span(samples))), options).report.digest;
  };
  EXPECT_EQ(digest_of(std::uint8_t{}, SampleType::kUint8), expected);
  EXPECT_EQ(digest_of(std::int16_t{}, SampleType::kInt16), expected);
  EXPECT_EQ(digest_of(std::uint64_t{}, SampleType::kUint64), expected);
  EXPECT_EQ(digest_of(double{}, SampleType::kFloat64), expected);
}

TEST(Preview, KeepsBothSidesOfASheetThinnerThanACell) {
  Grid grid{{24, 24, 16}};
  PreviewOptions options;
  options.cell = Length::units(5);
  const auto with_plates = [&](std::int64_t first, std::int64_t second) {
    grid.fill([&](std::int64_t i, std::int64_t j, std::int64_t k) {
      const bool within = i > 1 && j > 1 && i < 22 && j < 22;
      return within && (k == first || k == second) ? 1.0F : -1.0F;
    });
    MemoryVolume volume(grid.dims, grid.samples);
    return preview(volume, options);
  };
  const Preview one = with_plates(5, 5);
  const MeshCheck check = check_mesh(one.mesh);
  EXPECT_NEAR(check.volume, 0, 1e-3) << "a sheet has no inside";
  EXPECT_GT(check.area, 2 * 15 * 15) << "and two sides";
  // Two plates in one layer of cells are one sheet.
  const Preview two = with_plates(4, 6);
  EXPECT_EQ(two.mesh.triangles, one.mesh.triangles);
  EXPECT_EQ(two.report.preview->repeated, one.report.preview->repeated + one.report.triangles);
}

TEST(Preview, HasCellsOfTwoVoxelsOrA256thOfTheLongestSide) {
  GenerateOptions volume = generated("box", {0.5, 0.5, 0.5});
  PreviewOptions options;
  options.iso = suggested_iso("box", volume.type);
  EXPECT_DOUBLE_EQ(preview(*generate_volume(volume), options).report.preview->cell, 1);
  volume.dims = {1024, 4, 4};
  EXPECT_DOUBLE_EQ(preview(*generate_volume(volume), options).report.preview->cell, 2);
  options.cell = Length::voxels(3);
  EXPECT_DOUBLE_EQ(preview(*generate_volume(volume), options).report.preview->cell, 1.5);
  EXPECT_DOUBLE_EQ(preview(meshes::grid(4), {}).report.preview->cell, 2);
}

TEST(Preview, SaysWhyNothingIsLeft) {
  const GenerateOptions volume = generated("box");
  PreviewOptions options = options_for(volume, 1000);
  const Preview one = preview(*generate_volume(volume), options);
  EXPECT_EQ(one.report.triangles, 0U);
  EXPECT_EQ(one.report.preview->cells, 1U);
  ASSERT_EQ(one.report.warnings.size(), 1U);
  EXPECT_NE(one.report.warnings[0].find("in three cells of 1000"), std::string::npos);
  RunControl strict;
  strict.allow_empty = false;
  MemorySink sink;
  EXPECT_THROW(preview_volume(*generate_volume(volume), sink, options, strict), EmptySurface);
  EXPECT_FALSE(sink.finished);
  EXPECT_THROW(preview_mesh(meshes::grid(2), sink, Length::units(1000), strict), EmptySurface);
  EXPECT_THROW(preview_mesh({}, sink, {}, strict), EmptySurface);
  options.iso = 1e9;
  EXPECT_NE(preview(*generate_volume(volume), options).report.warnings[0].find("the surface is empty"),
            std::string::npos);
  EXPECT_EQ(preview(TriangleMesh{}, Length{}).report.warnings[0], "the mesh has no triangles");
}

TEST(Preview, TakesNaNForOutside) {
  Grid grid{{9, 9, 9}};
  grid.fill([](std::int64_t i, std::int64_t j, std::int64_t k) {
    const bool inside = i > 1 && j > 1 && k > 1 && i < 7 && j < 7 && k < 7;
    return inside ? 1.0F : std::numeric_limits<float>::quiet_NaN();
  });
  MemoryVolume volume(grid.dims, grid.samples);
  PreviewOptions options;
  options.iso = 0.5;
  const Preview found = preview(volume, options);
  EXPECT_EQ(found.report.open_edges, 0U);
  EXPECT_EQ(found.report.nan, 9U * 9 * 9 - 125);
}

TEST(Preview, RefusesCellsAndMeshesOutOfRange) {
  const GenerateOptions volume = generated("box");
  MemorySink sink;
  for (const double cell : {-1.0, 1e-9, std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_THROW(preview_volume(*generate_volume(volume), sink, options_for(volume, cell)), std::invalid_argument);
    EXPECT_THROW(preview_mesh(meshes::grid(3), sink, Length::voxels(cell)), std::invalid_argument);
  }
  TriangleMesh mesh = meshes::grid(3);
  for (const float wrong : {std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    mesh.vertices[2][1] = wrong;
    EXPECT_THROW(preview_mesh(mesh, sink), std::invalid_argument);
  }
  mesh = meshes::grid(3);
  mesh.triangles[0][0] = 1000;
  EXPECT_THROW(preview_mesh(mesh, sink), std::invalid_argument);
}

TEST(Preview, RefusesWhatOnlyTheSimplifierHas) {
  const GenerateOptions volume = generated("box");
  MemorySink sink;
  const auto refuses = [&](const RunControl& control) {
    EXPECT_THROW(preview_volume(*generate_volume(volume), sink, options_for(volume, 3), control), ImpossibleRun);
    EXPECT_THROW(preview_mesh(meshes::grid(3), sink, {}, control), ImpossibleRun);
  };
  RunControl control;
  control.memory = 1 << 30;
  refuses(control);
  control = {};
  control.checkpoint.folder = "states";
  refuses(control);
  control = {};
  control.device = Device::kCuda;
  refuses(control);
  PreviewOptions options = options_for(volume, 3);
  options.components = std::make_shared<ComponentChoice>();
  EXPECT_THROW(preview_volume(*generate_volume(volume), sink, options), ImpossibleRun);
}

TEST(Preview, StopsWhenItIsAskedTo) {
  RunControl control;
  control.stop = std::make_shared<std::atomic<bool>>(true);
  MemorySink sink;
  const GenerateOptions volume = generated("box");
  EXPECT_THROW(preview_volume(*generate_volume(volume), sink, options_for(volume, 3), control), Interrupted);
  EXPECT_THROW(preview_mesh(meshes::grid(3), sink, {}, control), Interrupted);
  EXPECT_FALSE(sink.finished);
}

}  // namespace
}  // namespace isoweave::testing::preview_test
