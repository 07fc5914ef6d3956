// A guaranteed distance holds, and changes nothing about who decides what: every schedule, slab and number of threads
// gives the mesh of the reference queue.
// Threads: Volumes/Distances.EverySchedule*/noiseClosed
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "measure/triangle_tree.hpp"
#include "oracle.hpp"

namespace isoweave::testing::distances_test {
namespace {

SurfaceCase make_case(const std::string& kind, bool closed) {
  SurfaceCase surface;
  surface.volume.kind = kind;
  surface.volume.dims = kSanitized ? std::array<std::int64_t, 3>{10, 9, 14} : std::array<std::int64_t, 3>{15, 13, 22};
  surface.volume.spacing = {0.7, 0.9, 1.4};
  surface.volume.seed = 9;
  surface.closed = closed;
  surface.error = 0.8;
  return surface;
}

class Distances : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  SurfaceCase surface() const { return make_case(std::get<0>(GetParam()), std::get<1>(GetParam())); }
};

TEST_P(Distances, EveryScheduleGivesTheMeshOfTheReferenceQueue) {
  for (const double distance : {0.04, 0.15, 0.6}) {
    if (kSanitized && distance != 0.15) continue;
    SurfaceCase surface = this->surface();
    surface.max_distance = distance;
    const SurfaceRun expected = reference_run(surface);
    ASSERT_LT(expected.report.triangles, expected.report.triangles_extracted);
    for (const std::int64_t slab : {std::int64_t{1}, std::int64_t{3}, kWholeVolume}) {
      if (kSanitized && slab != 3) continue;
      const auto same = [&](const SurfaceRun& run, const std::string& what) {
        EXPECT_EQ(digest_text(run.report.digest), digest_text(expected.report.digest))
            << what << ", slab " << slab << ", distance " << distance;
        EXPECT_EQ(run.report.collapses, expected.report.collapses) << what;
        EXPECT_EQ(run.report.postponed, expected.report.postponed) << what;
        EXPECT_EQ(run.report.rekeyed, expected.report.rekeyed) << what;
      };
      same(sweep(surface, Schedule::kQueue, 1, slab), "queue");
      same(sweep(surface, Schedule::kLocal, 1, slab), "local");
      same(sweep(surface, Schedule::kLocal, 4, slab), "local, 4 threads");
      same(sweep(surface, Schedule::kRounds, 2, slab), "rounds");
    }
  }
}

TEST_P(Distances, RandomSafeSubsetsInRandomOrderGiveTheSameMesh) {
  SurfaceCase surface = this->surface();
  if (!kSanitized) surface.volume.dims = {14, 12, 15};
  surface.max_distance = 0.3;
  const SurfaceRun expected = reference_run(surface);
  for (const std::int64_t slab : {std::int64_t{2}, std::int64_t{5}}) {
    std::mt19937 random(static_cast<unsigned>(slab));
    const Executor executor(1);
    Simplifier simplifier({surface.zone(), Schedule::kQueue}, executor, nullptr);
    const SurfaceRun run =
        sweep(surface, slab, executor, simplifier, [&] { decide_at_random(simplifier.zone(), random); });
    EXPECT_EQ(digest_text(run.report.digest), digest_text(expected.report.digest)) << "slab " << slab;
  }
}

TEST_P(Distances, NoPointIsFartherThanWasGuaranteed) {
  SurfaceCase surface = this->surface();
  surface.error = 0;
  const SurfaceRun full = sweep(surface, Schedule::kLocal, 2, 6);
  surface.error = 1.5;
  double unbounded = 0;
  for (const double distance : {0.0, 0.1, 0.5}) {
    surface.max_distance = distance;
    const SurfaceRun run = sweep(surface, Schedule::kLocal, 2, 6);
    const double largest = compare_meshes(run.mesh, full.mesh, {.samples = 30000}).a_to_b.max / surface.voxel();
    if (distance == 0) {
      unbounded = largest;
      continue;
    }
    EXPECT_LE(largest, distance * (1 + 1e-5));
    EXPECT_LT(run.report.triangles, full.report.triangles);
    const MeshCheck check = check_mesh(run.mesh);
    EXPECT_EQ(check.nonmanifold_edges + check.nonmanifold_vertices + check.misoriented_edges, 0U);
    EXPECT_EQ(check.euler, check_mesh(full.mesh).euler);
  }
  EXPECT_GT(unbounded, 0.1) << "nothing to guarantee";
}

// A point of a face, and what the face's bounds say of it: a length.
struct BoundedPoint {
  measure::Vector point{};
  double bound = 0;
};

BoundedPoint random_point(const Zone& zone, const Triangle& triangle, std::mt19937& random) {
  std::uniform_real_distribution<double> number(0, 1);
  const double a = std::sqrt(number(random));
  const double b = a * number(random);
  const double weights[3] = {1 - a, a - b, b};
  BoundedPoint found;
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3 p = weights[c] * zone.vertices[triangle.sides[c].vertex].position;
    found.point = {found.point[0] + p.x, found.point[1] + p.y, found.point[2] + p.z};
    found.bound += weights[c] * triangle.bounds[c] / kBoundUnits * zone.options.most_distance;
  }
  return found;
}

// Of the whole surface at once, before any of it is handed over. Bounds spare looks, so a wrong one would let a face
// pass.
TEST_P(Distances, NoPointOfAFaceIsFartherThanItsBounds) {
  SurfaceCase surface = this->surface();
  surface.error = 0;
  const SurfaceRun full = sweep(surface, Schedule::kLocal, 2, 6);
  const Executor executor(1);
  const measure::TriangleTree tree(full.mesh, executor);
  surface.error = 0.8;
  std::mt19937 random(7);
  for (const double distance : {0.2, 0.6}) {
    surface.max_distance = distance;
    Simplifier simplifier({surface.zone(), Schedule::kLocal}, executor, nullptr);
    int bounded = 0;
    int held = 0;
    sweep(surface, kWholeVolume, executor, simplifier, [&] {
      simplifier.decide();
      for (const Triangle& triangle : simplifier.zone().triangles) {
        if (triangle.sides[0].vertex == kNone) continue;
        ++held;
        bounded += static_cast<int>(std::ranges::max(triangle.bounds) < kBoundUnits);
        for (int n = 0; n < 20; ++n) {
          const auto [point, bound] = random_point(simplifier.zone(), triangle, random);
          std::size_t hint = measure::TriangleTree::kNoHint;
          ASSERT_LE(std::sqrt(tree.squared_distance_from(point, hint)), bound + 1e-5) << distance;
        }
      }
    });
    EXPECT_GT(bounded, held / 4);
  }
}

INSTANTIATE_TEST_SUITE_P(Volumes, Distances,
                         ::testing::Combine(::testing::Values("gyroid", "noise", "white", "box", "sphere"),
                                            ::testing::Bool()),
                         [](const auto& instance) {
                           return std::get<0>(instance.param) + (std::get<1>(instance.param) ? "Closed" : "Open");
                         });

MeshOptions mesh_options(const SurfaceCase& surface) {
  MeshOptions options;
  options.iso = surface.rule().iso;
  options.error = Length::voxels(0.6);
  options.max_distance = Length::voxels(0.25);
  return options;
}

std::uint64_t digest_of(const SurfaceCase& surface, const MeshOptions& options, const RunControl& control = {}) {
  MemorySink sink;
  return mesh_volume(*generate_volume(surface.volume), sink, options, control).digest;
}

TEST(DistancesBeside, LevelsAndNumbersOfTrianglesHold) {
  const SurfaceCase surface = make_case("noise", true);
  MeshOptions options = mesh_options(surface);
  const std::uint64_t expected = digest_of(surface, options, {.slab = 1000});
  options.error = Length::voxels(0.2);
  const std::uint64_t finer = digest_of(surface, options, {.slab = 1000});
  options.error = Length::voxels(0.6);
  options.levels = {{0.2, true}};
  MemorySink sinks[2];
  MeshSink* const pointers[] = {&sinks[0], &sinks[1]};
  const MeshReport report = mesh_volume(*generate_volume(surface.volume), pointers, options, {.slab = 2});
  EXPECT_EQ(digest_text(report.digest), digest_text(expected));
  EXPECT_EQ(digest_text(report.levels[0].digest), digest_text(finer));

  options = mesh_options(surface);
  options.triangles = report.levels[0].triangles;
  RunControl queue;
  queue.slab = 1000;
  queue.schedule = Schedule::kQueue;
  const std::uint64_t counted = digest_of(surface, options, queue);
  EXPECT_EQ(digest_text(digest_of(surface, options, {.slab = 3})), digest_text(counted));
}

// A face of a large flat has more parts than a look takes: its bound has to be known.
TEST(DistancesBeside, LargeFlatsAreLeftAsWithoutADistance) {
  GenerateOptions plate;
  plate.kind = "box";
  plate.dims = kSanitized ? std::array<std::int64_t, 3>{60, 60, 6} : std::array<std::int64_t, 3>{480, 480, 6};
  MeshOptions options;
  options.iso = suggested_iso(plate.kind, plate.type);
  options.closed = true;
  options.error = Length::voxels(0.2);
  const auto triangles = [&] {
    MemorySink sink;
    return mesh_volume(*generate_volume(plate), sink, options).triangles;
  };
  const std::uint64_t free = triangles();
  EXPECT_GT(free, 50U);
  options.max_distance = Length::voxels(0.5);
  EXPECT_EQ(triangles(), free);
}

TEST(DistancesBeside, MeshesKeepTheirDistanceToo) {
  SurfaceCase surface = make_case("noise", true);
  surface.error = 0;
  const TriangleMesh full = sweep(surface, Schedule::kLocal, 2, 6).mesh;
  MemorySink sink;
  SimplifyOptions options;
  options.error = Length::voxels(1);
  options.max_distance = Length::units(0.2);
  const MeshReport report = simplify_mesh(full, sink, options);
  EXPECT_LT(report.triangles, full.triangles.size() * 3 / 4);
  EXPECT_LE(compare_meshes(sink.mesh, full).a_to_b.max, 0.2 * (1 + 1e-5));
}

}  // namespace
}  // namespace isoweave::testing::distances_test
