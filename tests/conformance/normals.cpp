// Normals that count: costs and places depend on them, and every schedule, slab and number of threads still gives the
// mesh of the reference queue.
// Threads: none, schedules.cpp has the same loops
#include <gtest/gtest.h>

#include "oracle.hpp"

namespace isoweave::testing::normals_test {
namespace {

class NormalsThatCount : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  SurfaceCase surface() const {
    SurfaceCase surface;
    surface.volume.kind = std::get<0>(GetParam());
    surface.volume.dims = kSanitized ? std::array<std::int64_t, 3>{9, 8, 14} : std::array<std::int64_t, 3>{15, 13, 22};
    surface.volume.spacing = {0.7, 0.9, 1.4};
    surface.volume.seed = 9;
    surface.closed = std::get<1>(GetParam());
    surface.error = 0.8;
    surface.normals_count = true;
    return surface;
  }
};

TEST_P(NormalsThatCount, EveryScheduleGivesTheMeshOfTheReferenceQueue) {
  for (const Quality quality : {Quality::kFast, Quality::kNormal, Quality::kFine}) {
    SurfaceCase surface = this->surface();
    surface.quality = quality;
    const SurfaceRun expected = reference_run(surface);
    ASSERT_LT(expected.report.triangles, expected.report.triangles_extracted);
    ASSERT_EQ(expected.mesh.normals.size(), expected.mesh.vertices.size());
    for (const std::int64_t slab : {std::int64_t{1}, std::int64_t{4}, kWholeVolume}) {
      const auto same = [&](const SurfaceRun& run, const std::string& what) {
        EXPECT_EQ(digest_text(run.report.digest), digest_text(expected.report.digest)) << what << ", slab " << slab;
        EXPECT_EQ(riders_digest(run.mesh), riders_digest(expected.mesh)) << what << ", slab " << slab;
        EXPECT_EQ(run.report.collapses, expected.report.collapses) << what;
        EXPECT_EQ(run.report.postponed, expected.report.postponed) << what;
        EXPECT_EQ(run.report.rekeyed, expected.report.rekeyed) << what;
      };
      same(sweep(surface, Schedule::kQueue, 1, slab), "queue");
      same(sweep(surface, Schedule::kLocal, 4, slab), "local, 4 threads");
      same(sweep(surface, Schedule::kRounds, 2, slab), "rounds");
    }
  }
}

// Before anything is decided.
TEST_P(NormalsThatCount, KeysAreCostsOfPlaceAndNormal) {
  const SurfaceCase surface = this->surface();
  const Executor executor(1);
  Simplifier simplifier({surface.zone(), Schedule::kQueue}, executor, nullptr);
  std::size_t keys = 0;
  sweep(surface, kWholeVolume, executor, simplifier, [&] {
    const Zone& zone = simplifier.zone();
    for (Index h = 0; h < 4 * zone.triangle_count(); ++h) {
      if ((h & 3) == 3 || !zone.represents_edge(h)) continue;
      const auto [first, second] = ends_in_order(zone, zone.origin(h), zone.destination(h));
      const auto normal_of = [&](const Vertex* v) {
        return zone.normal_quadrics[static_cast<std::size_t>(v - zone.vertices.data())];
      };
      const double cost = collapse_cost(first->quadric, normal_of(first), second->quadric, normal_of(second),
                                        second->position - first->position);
      ASSERT_EQ(zone.cost(h), scaled(to_cost(cost), key_factors(surface.quality).first));
      ++keys;
    }
  });
  EXPECT_GT(keys, 100U);
}

TEST_P(NormalsThatCount, RandomSafeSubsetsInRandomOrderGiveTheSameMesh) {
  SurfaceCase surface = this->surface();
  surface.volume.dims = {10, 12, 11};
  const SurfaceRun expected = reference_run(surface);
  std::mt19937 random(3);
  const Executor executor(1);
  Simplifier simplifier({surface.zone(), Schedule::kQueue}, executor, nullptr);
  const SurfaceRun run = sweep(surface, 3, executor, simplifier, [&] { decide_at_random(simplifier.zone(), random); });
  EXPECT_EQ(digest_text(run.report.digest), digest_text(expected.report.digest));
  EXPECT_EQ(riders_digest(run.mesh), riders_digest(expected.mesh));
}

TEST_P(NormalsThatCount, KeepTheSurfaceWhatItIs) {
  SurfaceCase surface = this->surface();
  const SurfaceRun run = sweep(surface, Schedule::kLocal, 2, 5);
  surface.normals_count = false;
  EXPECT_NE(run.report.digest, sweep(surface, Schedule::kLocal, 2, 5).report.digest) << "they count";
  surface.error = 0;
  const SurfaceRun full = sweep(surface, Schedule::kLocal, 2, 5);
  const MeshCheck check = check_mesh(run.mesh);
  EXPECT_EQ(check.nonmanifold_edges + check.nonmanifold_vertices + check.misoriented_edges, 0U);
  EXPECT_EQ(check.euler, check_mesh(full.mesh).euler);
  for (const Point& n : run.mesh.normals) {
    const double length = std::hypot(n[0], n[1], n[2]);
    EXPECT_TRUE(length == 0 || std::abs(length - 1) < 1e-5) << length;
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, NormalsThatCount,
                         ::testing::Combine(::testing::Values("gyroid", "noise", "white", "box", "sphere"),
                                            ::testing::Bool()),
                         [](const auto& instance) {
                           return std::get<0>(instance.param) + (std::get<1>(instance.param) ? "Closed" : "Open");
                         });

// Degrees by which normals are off those of a sphere around the middle of its volume, root of the mean square.
double off_sphere(const TriangleMesh& mesh, double middle) {
  double sum = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto& [x, y, z] = mesh.vertices[v];
    const auto& [nx, ny, nz] = mesh.normals[v];
    const Vec3 radius{x - middle, y - middle, z - middle};
    const double cosine = dot(radius, Vec3{nx, ny, nz}) / std::sqrt(dot(radius, radius));
    const double angle = std::acos(std::min(cosine, 1.0)) * 57.29577951308232;
    sum += angle * angle;
  }
  return std::sqrt(sum / static_cast<double>(mesh.vertices.size()));
}

TEST(NormalsBeside, AreCloserToTheTruthAtTheSameNumberOfTriangles) {
  GenerateOptions volume;
  volume.kind = "sphere";
  volume.dims = {32, 32, 32};
  MeshOptions options;
  options.iso = suggested_iso("sphere", volume.type);
  options.error = Length::voxels(100);
  options.triangles = 300;
  const auto off = [&](Normals normals) {
    options.normals = normals;
    MemorySink sink;
    mesh_volume(*generate_volume(volume), sink, options);
    EXPECT_EQ(sink.mesh.triangles.size(), 300U);
    return off_sphere(sink.mesh, 15.5);
  };
  EXPECT_LT(off(Normals::kQuadric), 0.8 * off(Normals::kGradient));
}

// One level from a run with others, and a run of its own.
TEST(NormalsBeside, LevelsNest) {
  GenerateOptions volume;
  volume.kind = "noise";
  volume.dims = {16, 18, 20};
  MeshOptions options;
  options.iso = suggested_iso("noise", volume.type);
  options.normals = Normals::kQuadric;
  options.error = Length::voxels(0.2);
  MemorySink alone;
  const MeshReport finer = mesh_volume(*generate_volume(volume), alone, options);
  options.levels = {{0.2, true}};
  options.error = Length::voxels(0.9);
  MemorySink sinks[2];
  MeshSink* const pointers[] = {&sinks[0], &sinks[1]};
  const MeshReport both = mesh_volume(*generate_volume(volume), pointers, options, {.slab = 3});
  EXPECT_EQ(digest_text(both.levels[0].digest), digest_text(finer.digest));
  EXPECT_EQ(riders_digest(sinks[0].mesh), riders_digest(alone.mesh));
}

}  // namespace
}  // namespace isoweave::testing::normals_test
