// One digest per surface: every schedule, slab thickness and number of threads gives the mesh of the reference queue.
// Threads: *EverySchedule*ClosedAnisotropic*:*Topology*ClosedAnisotropic*
#include <gtest/gtest.h>

#include <bit>

#include "oracle.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::schedules_test {
namespace {

SurfaceCase make_case(const std::string& kind, bool closed, bool anisotropic) {
  SurfaceCase surface;
  surface.volume.kind = kind;
  surface.volume.dims = {18, 15, 20};
  if (anisotropic) surface.volume.spacing = {0.7, 0.7, 1.9};
  surface.volume.seed = 7;
  surface.closed = closed;
  return surface;
}

class Conformance : public ::testing::TestWithParam<std::tuple<std::string, bool, bool, ExtractorKind>> {
 protected:
  SurfaceCase surface() const {
    SurfaceCase surface = make_case(std::get<0>(GetParam()), std::get<1>(GetParam()), std::get<2>(GetParam()));
    surface.extractor = std::get<3>(GetParam());
    return surface;
  }
};

TEST_P(Conformance, EveryScheduleGivesTheMeshOfTheReferenceQueue) {
  for (const Quality quality : {Quality::kFast, Quality::kNormal, Quality::kFine}) {
    for (const double error : {0.05, 0.4}) {
      SurfaceCase surface = this->surface();
      surface.quality = quality;
      surface.error = error;
      const SurfaceRun expected = reference_run(surface);
      if (error > 0.1) {
        ASSERT_LT(expected.report.triangles, expected.report.triangles_extracted);
      }
      const std::vector<std::int64_t> slabs = kSanitized ? std::vector<std::int64_t>{5, kWholeVolume}
                                                         : std::vector<std::int64_t>{1, 2, 5, 12, kWholeVolume};
      for (const std::int64_t slab : slabs) {
        const auto same = [&](Schedule schedule, int threads) {
          const SurfaceRun run = sweep(surface, schedule, threads, slab);
          EXPECT_EQ(digest_text(run.report.digest), digest_text(expected.report.digest))
              << "slab " << slab << ", threads " << threads << ", error " << error << ", quality "
              << static_cast<int>(quality) << ", schedule " << static_cast<int>(schedule);
          EXPECT_EQ(run.report.collapses, expected.report.collapses);
          EXPECT_EQ(run.report.postponed, expected.report.postponed);
          EXPECT_EQ(run.report.rekeyed, expected.report.rekeyed);
        };
        same(Schedule::kQueue, 1);
        for (const int threads : kSanitized ? std::vector{4} : std::vector{1, 2, 4}) {
          same(Schedule::kLocal, threads);
          same(Schedule::kRounds, threads);
        }
      }
    }
  }
}

TEST_P(Conformance, RandomSafeSubsetsInRandomOrderGiveTheSameMesh) {
  for (const Quality quality : {Quality::kFast, Quality::kFine}) {
    SurfaceCase surface = this->surface();
    surface.volume.dims = {16, 14, 15};
    surface.quality = quality;
    surface.error = 0.3;
    const SurfaceRun expected = reference_run(surface);
    for (const std::int64_t slab : {std::int64_t{4}, kWholeVolume}) {
      std::mt19937 random(static_cast<unsigned>(slab));
      const Executor executor(1);
      Simplifier simplifier({surface.zone(), Schedule::kQueue}, executor, nullptr);
      const SurfaceRun run =
          sweep(surface, slab, executor, simplifier, [&] { decide_at_random(simplifier.zone(), random); });
      EXPECT_EQ(digest_text(run.report.digest), digest_text(expected.report.digest)) << "slab " << slab;
    }
  }
}

TEST_P(Conformance, TopologyIsThatOfTheFullSurface) {
  SurfaceCase surface = this->surface();
  surface.error = 0;
  const SurfaceRun full = sweep(surface, Schedule::kQueue, 1, 5);
  surface.error = 0.4;
  const SurfaceRun reduced = sweep(surface, Schedule::kLocal, 4, 5);
  ASSERT_EQ(full.report.triangles, full.report.triangles_extracted);
  ASSERT_EQ(full.report.vertices, full.report.vertices_extracted);
  const MeshCheck before = check_mesh(full.mesh);
  for (const SurfaceRun* run : {&full, &reduced}) {
    const MeshCheck check = check_mesh(run->mesh);
    EXPECT_EQ(check.nonmanifold_edges, 0u);
    EXPECT_EQ(check.nonmanifold_vertices, 0u);
    EXPECT_EQ(check.misoriented_edges, 0u);
    EXPECT_EQ(check.unused_vertices, 0u);
    EXPECT_EQ(check.euler, before.euler);
    EXPECT_EQ(check.components, before.components);
    if (surface.closed) {
      EXPECT_EQ(check.open_edges, 0u);
      EXPECT_GT(check.volume, 0);
    }
    // What the sweep says of itself is what the checker finds.
    EXPECT_EQ(run->report.open_edges, check.open_edges);
    EXPECT_EQ(run->report.euler, check.euler);
    EXPECT_EQ(run->report.components, check.components);
    EXPECT_EQ(run->report.digest, check.digest);
    EXPECT_EQ(run->report.vertices, check.vertices);
  }
}

// Leaves only the lower halves of the ties to tell edges of equal cost apart, as a collision of the upper halves does.
// All edges have to have their keys for that, and all turns follow from those that they have afterwards.
void drop_upper_ties(Zone& zone, const Executor& executor) {
  zone.settle_edges(executor);
  for (Index h = 0; h < 4 * zone.triangle_count(); ++h) {
    if ((h & 3) == 3 || !zone.represents_edge(h)) continue;
    const auto tie = static_cast<std::uint32_t>(mix_bits(zone.tie(h)));
    for (const Index side : {h, zone.twin(h)}) {
      if (exists(side)) zone.triangles[side >> 2].tie_low[side & 3] = tie;
    }
    zone.set_key(h, make_key(zone.cost(h), 0));
  }
  zone.settle_all();
}

TEST(Ties, EqualUpperHalvesLeaveTheOrderToTheLower) {
  for (const char* kind : {"box", "specks", "noise"}) {
    SurfaceCase surface = make_case(kind, true, false);
    surface.error = 0.3;
    const auto run = [&](Schedule schedule, int threads, bool reference) {
      const Executor executor(threads);
      Simplifier simplifier({surface.zone(), schedule}, executor, nullptr);
      return sweep(surface, kWholeVolume, executor, simplifier, [&] {
        drop_upper_ties(simplifier.zone(), executor);
        if (reference) {
          decide_in_order(simplifier.zone());
        } else {
          simplifier.decide();
        }
      });
    };
    const std::string expected = digest_text(run(Schedule::kQueue, 1, true).report.digest);
    EXPECT_EQ(digest_text(run(Schedule::kQueue, 1, false).report.digest), expected) << kind;
    EXPECT_EQ(digest_text(run(Schedule::kLocal, 1, false).report.digest), expected) << kind;
    EXPECT_EQ(digest_text(run(Schedule::kLocal, 4, false).report.digest), expected) << kind;
    EXPECT_EQ(digest_text(run(Schedule::kRounds, 4, false).report.digest), expected) << kind;
  }
}

// Where the walk around a vertex starts is chance: no sum may depend on it.
void turn_starts(Zone& zone, std::mt19937& random) {
  for (Index v = 0; v < zone.vertices.size(); ++v) {
    Index& start = zone.vertices[v].half_edge;
    if (!zone.walkable(v) || zone.states[v] == VertexState::kFinal || zone.twin(start) == kNone) continue;
    for (auto turns = random() % 6; turns > 0; --turns) start = zone.rotate(start);
  }
}

// Every bit of the positions in a zone; the order of its vertices does not matter.
std::uint64_t position_bits(const Zone& zone) {
  std::uint64_t sum = 0;
  for (const Vertex& vertex : zone.vertices) {
    if (!exists(vertex.half_edge)) continue;
    std::uint64_t bits = vertex.id;
    for (const double x : {vertex.position.x, vertex.position.y, vertex.position.z}) {
      bits = mix_bits(bits + std::bit_cast<std::uint64_t>(x));
    }
    sum += bits;
  }
  return sum;
}

// Sums in another order differ in the last bits of doubles, which a digest of floats hardly ever shows.
TEST(Starts, OfWalksDoNotMatter) {
  SurfaceCase surface = make_case("noise", true, true);
  surface.quality = Quality::kFine;
  std::uint64_t expected = 0;
  for (const bool turned : {false, true}) {
    std::mt19937 random(5);
    const Executor executor(1);
    Simplifier simplifier({surface.zone(), Schedule::kQueue}, executor, nullptr);
    const SurfaceRun run = sweep(surface, kWholeVolume, executor, simplifier, [&] {
      if (turned) turn_starts(simplifier.zone(), random);
      simplifier.decide();
      const std::uint64_t bits = position_bits(simplifier.zone());
      if (!turned) expected = bits;
      EXPECT_EQ(bits, expected);
    });
    EXPECT_GT(run.report.collapses, 100u);
  }
}

std::string case_name(const ::testing::TestParamInfo<Conformance::ParamType>& info) {
  constexpr std::array<const char*, 4> kExtractors{"", "Trilinear", "Tetrahedra", "Dual"};
  return std::get<0>(info.param) + (std::get<1>(info.param) ? "Closed" : "Open") +
         (std::get<2>(info.param) ? "Anisotropic" : "Isotropic") +
         kExtractors.at(static_cast<std::size_t>(std::get<3>(info.param)));
}

INSTANTIATE_TEST_SUITE_P(Volumes, Conformance,
                         ::testing::Combine(::testing::Values("sphere", "torus", "gyroid", "box", "shells", "smooth",
                                                              "noise", "white", "specks"),
                                            ::testing::Bool(), ::testing::Bool(),
                                            ::testing::Values(ExtractorKind::kCubes)),
                         case_name);

const std::vector<std::string> kVolumesOfExtractors =
    kSanitized ? std::vector<std::string>{"white"} : std::vector<std::string>{"box", "noise", "white"};

INSTANTIATE_TEST_SUITE_P(
    Extractors, Conformance,
    ::testing::Combine(::testing::ValuesIn(kVolumesOfExtractors), ::testing::Bool(), ::testing::Values(true),
                       ::testing::Values(ExtractorKind::kTrilinear, ExtractorKind::kTetrahedra, ExtractorKind::kDual)),
    case_name);

}  // namespace
}  // namespace isoweave::testing::schedules_test
