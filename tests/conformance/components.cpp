// Runs that drop components make the mesh of a surface that never had them.
// Threads: *DroppedOnesHaveNeverBeen/noise*
#include <gtest/gtest.h>

#include "component_scenes.hpp"

namespace isoweave::testing::components_test {
namespace {

void expect_dropped(const MeshReport& report, const Kept& kept) {
  EXPECT_EQ(report.components_dropped, kept.components_dropped);
  EXPECT_EQ(report.triangles_dropped, kept.triangles_dropped);
  EXPECT_EQ(report.triangles_extracted, kept.piece.triangles.size() + kept.triangles_dropped);
}

void expect_same(const SurfaceReport& found, const SurfaceReport& expected) {
  EXPECT_EQ(digest_text(found.digest), digest_text(expected.digest));
  EXPECT_EQ(found.triangles, expected.triangles);
  EXPECT_EQ(found.vertices, expected.vertices);
  EXPECT_EQ(found.open_edges, expected.open_edges);
  EXPECT_EQ(found.components, expected.components);
  EXPECT_EQ(found.euler, expected.euler);
}

// Every slab, schedule and number of threads, simplified and in full.
void expect_kept(Scene scene, const ComponentRule& rule, const std::vector<int>& many_threads = {1, 4}) {
  SCOPED_TRACE(::testing::Message() << "fewer than " << rule.min_triangles << (rule.largest ? ", largest" : ""));
  const Kept kept = keep(extract_all(scene), rule);
  scene.surface.error = 0.6;
  const SurfaceRun simplified = reference(scene, kept);
  const ComponentChoice choice = choose(scene, rule);
  EXPECT_EQ(choice.components, kept.components);
  EXPECT_EQ(choice.triangles, kept.piece.triangles.size());
  const auto whole = scene.surface.volume.dims[2] + 2;
  for (const std::int64_t slab : {std::int64_t{1}, std::int64_t{2}, std::int64_t{5}, whole}) {
    const auto same = [&](Schedule schedule, int threads) {
      SCOPED_TRACE(::testing::Message() << "slab " << slab << ", schedule " << static_cast<int>(schedule)
                                        << ", threads " << threads);
      EXPECT_EQ(choose(scene, rule, slab, threads).seeds, choice.seeds);
      MeshOptions options = scene.options();
      options.components = borrow(choice);
      RunControl control;
      control.slab = slab;
      control.schedule = schedule;
      control.threads = threads;
      MemorySink sink;
      const MeshReport report = mesh_volume(*scene.volume(), sink, options, control);
      expect_same(report, simplified.report);
      EXPECT_EQ(report.collapses, simplified.report.collapses);
      expect_dropped(report, kept);
      EXPECT_EQ(report.warnings.size(), kept.components == 0 ? 1U : 0U);

      options.error = Length::voxels(0);
      MemorySink full;
      const MeshReport full_report = mesh_volume(*scene.volume(), full, options, control);
      expect_dropped(full_report, kept);
      EXPECT_EQ(full_report.components, kept.components);
      EXPECT_EQ(full_report.open_edges, check_mesh(full.mesh).open_edges);
      EXPECT_EQ(full_report.euler, check_mesh(full.mesh).euler);
      ASSERT_EQ(full.mesh.vertices.size(), kept.piece.positions.size());
      ASSERT_TRUE(std::ranges::equal(full.mesh.triangles, kept.piece.triangles)) << "in their order";
      const World world;
      for (std::size_t v = 0; v < full.mesh.vertices.size(); ++v) {
        ASSERT_EQ(full.mesh.vertices[v], world.point(kept.piece.positions[v])) << v;
      }
    };
    for (const int threads : many_threads) same(Schedule::kLocal, threads);
    if (slab == 2) same(Schedule::kQueue, 1);
    if (slab == 5 && !kSanitized) same(Schedule::kRounds, 3);
  }
}

class Components : public ::testing::TestWithParam<std::tuple<std::string, bool>> {
 protected:
  static Scene make(const std::string& name) {
    if (name == "arches") return arches();
    if (name == "grains") return grains();
    if (name == "twins") return twins();
    return generated(name, name == "white" ? Dims{9, 10, 13} : Dims{14, 12, 18});
  }

  Scene scene() const {
    Scene scene = make(std::get<0>(GetParam()));
    scene.surface.closed = std::get<1>(GetParam());
    return scene;
  }
};

TEST_P(Components, DroppedOnesHaveNeverBeen) {
  const Scene scene = this->scene();
  ASSERT_GT(keep(extract_all(scene), {}).components, 1U);
  expect_kept(scene, {60, false});
  expect_kept(scene, {0, true});
  if (kSanitized) return;
  expect_kept(scene, {9, false});
  expect_kept(scene, {1000000, true});
}

INSTANTIATE_TEST_SUITE_P(Volumes, Components,
                         ::testing::Combine(::testing::Values("arches", "grains", "twins", "noise", "white", "specks"),
                                            ::testing::Bool()),
                         [](const auto& test) {
                           return std::get<0>(test.param) + (std::get<1>(test.param) ? "Closed" : "Open");
                         });

TEST(ComponentsOfThinVolumes, AreDropped) {
  for (const Dims& dims : {Dims{1, 9, 11}, Dims{9, 1, 11}, Dims{9, 11, 1}, Dims{1, 1, 12}, Dims{2, 9, 11},
                           Dims{9, 11, 2}, Dims{70, 9, 3}}) {
    for (const bool closed : {true, false}) {
      SCOPED_TRACE(::testing::Message() << dims[0] << " x " << dims[1] << " x " << dims[2] << (closed ? "" : ", open"));
      Scene scene = generated("white", dims);
      scene.surface.closed = closed;
      expect_kept(scene, {12, false}, {1});
      expect_kept(scene, {0, true}, {1});
    }
  }
}

// Of equal ones the first that is extracted stays.
TEST(ComponentsOfOneSize, TheFirstIsTheLargest) {
  const Scene scene = twins();
  const ComponentChoice choice = choose(scene, {0, true});
  MeshOptions options = scene.options();
  options.components = borrow(choice);
  MemorySink sink;
  mesh_volume(*scene.volume(), sink, options);
  for (const Point& vertex : sink.mesh.vertices) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_LT(vertex[axis], static_cast<float>(scene.surface.volume.spacing[axis] * 6));
    }
  }
}

// The options that something else has to know of what is kept.
class ComponentsAnd : public ::testing::Test {
 protected:
  MeshReport run(const Scene& scene, MeshOptions options, TriangleMesh* mesh = nullptr) const {
    const ComponentChoice choice = choose(scene, rule_);
    options.components = borrow(choice);
    MemorySink sink;
    MeshReport report = mesh_volume(*scene.volume(), sink, options, {.slab = 4});
    if (mesh != nullptr) *mesh = std::move(sink.mesh);
    return report;
  }

  const ComponentRule rule_{40, false};
  Scene scene_ = generated("noise", {16, 14, 20});
};

TEST_F(ComponentsAnd, GuaranteedDistancesAreFromWhatIsKept) {
  scene_.surface.error = 1;
  scene_.surface.max_distance = 0.3;
  expect_same(run(scene_, scene_.options()), reference(scene_, keep(extract_all(scene_), rule_)).report);
}

TEST_F(ComponentsAnd, SpecksAreOthers) {
  scene_.surface.error = 2;
  scene_.surface.drop_specks = true;
  const MeshReport report = run(scene_, scene_.options());
  expect_same(report, reference(scene_, keep(extract_all(scene_), rule_)).report);
}

TEST_F(ComponentsAnd, NumbersOfTrianglesAreOfWhatIsKept) {
  const Kept kept = keep(extract_all(scene_), rule_);
  MeshOptions options = scene_.options();
  options.triangles = kept.piece.triangles.size() / 3;
  options.error = Length::units(std::numeric_limits<double>::infinity());
  expect_same(run(scene_, options), reference(scene_, kept, options.triangles).report);
  const ComponentChoice choice = choose(scene_, rule_);
  options.components = borrow(choice);
  EXPECT_EQ(count_triangles(*scene_.volume(), options), kept.piece.triangles.size());
}

TEST_F(ComponentsAnd, NormalsStayWithTheirVertices) {
  const Kept kept = keep(extract_all(scene_, true), rule_);
  MeshOptions options = scene_.options();
  options.normals = Normals::kGradient;
  options.error = Length::voxels(0);
  TriangleMesh mesh;
  run(scene_, options, &mesh);
  ASSERT_EQ(mesh.normals.size(), kept.piece.normals.size());
  const World world;
  for (std::size_t v = 0; v < mesh.normals.size(); ++v) {
    ASSERT_EQ(mesh.normals[v], world.normal(kept.piece.normals[v])) << v;
  }
}

TEST_F(ComponentsAnd, ValuesStayWithTheirVertices) {
  const Scene other = generated("white", scene_.surface.volume.dims);
  MeshOptions options = scene_.options();
  options.error = Length::voxels(0);
  const auto run_with = [&](std::shared_ptr<const ComponentChoice> components) {
    options.values = other.volume();
    options.components = std::move(components);
    MemorySink sink;
    mesh_volume(*scene_.volume(), sink, options);
    return std::move(sink.mesh);
  };
  const TriangleMesh all = run_with(nullptr);
  const ComponentChoice choice = choose(scene_, rule_);
  const TriangleMesh kept = run_with(borrow(choice));
  ASSERT_EQ(kept.values.size(), kept.vertices.size());
  std::map<Point, float> value_at;
  for (std::size_t v = 0; v < all.vertices.size(); ++v) value_at[all.vertices[v]] = all.values[v];
  for (std::size_t v = 0; v < kept.vertices.size(); ++v) ASSERT_EQ(kept.values[v], value_at.at(kept.vertices[v]));
}

TEST_F(ComponentsAnd, LevelsAreOfWhatIsKept) {
  const ComponentChoice choice = choose(scene_, rule_);
  MeshOptions options = scene_.options();
  options.components = borrow(choice);
  options.error = Length::voxels(0.8);
  options.levels = {{0, true}, {0.3, true}};
  MemorySink sinks[3];
  MeshSink* const pointers[] = {&sinks[0], &sinks[1], &sinks[2]};
  const MeshReport report = mesh_volume(*scene_.volume(), pointers, options, {.slab = 4});
  const Kept kept = keep(extract_all(scene_), rule_);
  scene_.surface.error = 0.3;
  expect_same(report.levels[1], reference(scene_, kept).report);
  scene_.surface.error = 0.8;
  expect_same(report, reference(scene_, kept).report);
  EXPECT_EQ(report.levels[0].triangles, kept.piece.triangles.size());
  EXPECT_EQ(report.levels[0].components, kept.components);
}

TEST_F(ComponentsAnd, ObserversSeeWhatIsKept) {
  class Watcher final : public SweepObserver {
   public:
    void add_final(std::span<const TriangleCorners> triangles) override { seen += triangles.size(); }
    void end_slab(const Progress&, const SlabRecord& slab,
                  const std::function<void(const Visitor&)>& visit_undecided) override {
      std::uint64_t undecided = 0;
      visit_undecided([&](std::span<const TriangleCorners> block) { undecided += block.size(); });
      EXPECT_EQ(undecided, slab.undecided_triangles);
    }
    std::uint64_t seen = 0;
  } watcher;
  const ComponentChoice choice = choose(scene_, rule_);
  MeshOptions options = scene_.options();
  options.components = borrow(choice);
  RunControl control;
  control.observer = borrow(watcher);
  MemorySink sink;
  EXPECT_EQ(mesh_volume(*scene_.volume(), sink, options, control).triangles, watcher.seen);
}

TEST_F(ComponentsAnd, AChoiceIsForOneSurface) {
  const ComponentChoice choice = choose(scene_, rule_);
  MeshOptions options = scene_.options();
  options.components = borrow(choice);
  MemorySink sink;
  options.iso = 0.6;
  EXPECT_THROW(mesh_volume(*scene_.volume(), sink, options), std::invalid_argument);
  options.iso = 0.5;
  options.closed = false;
  EXPECT_THROW(mesh_volume(*scene_.volume(), sink, options), std::invalid_argument);
  options.closed = true;
  Scene other = scene_;
  for (const Dims& first : {Dims{2, 2, 2}, Dims{0, 0, 17}, Dims{3, 6, 0}, Dims{5, 5, 8}}) {
    other.fill(first, {first[0] + 3, first[1] + 3, first[2] + 3});
    for (const std::int64_t slab : {1, 4, 50}) {
      EXPECT_THROW(mesh_volume(*other.volume(), sink, options, {.slab = slab}), BadInput)
          << first[2] << ", slab " << slab;
    }
  }
  // Another leg of an arch, which a kept part and a dropped one turn out to share.
  Scene legs({9, 5, 8});
  legs.fill({1, 1, 1}, {3, 3, 7});
  legs.fill({5, 1, 1}, {6, 2, 4});
  const ComponentChoice apart = choose(legs, {0, true});
  options = legs.options();
  options.components = borrow(apart);
  legs.fill({3, 1, 3}, {5, 2, 4});
  for (const std::int64_t slab : {1, 2, 50}) {
    EXPECT_THROW(mesh_volume(*legs.volume(), sink, options, {.slab = slab}), BadInput) << "slab " << slab;
  }
  EXPECT_FALSE(sink.finished);
  RunControl control;
  control.device = Device::kCuda;
  EXPECT_THROW(choose_components(*scene_.volume(), options, rule_, control), std::invalid_argument);
}

TEST_F(ComponentsAnd, TheFirstPassCanBeStopped) {
  const std::atomic<bool> stop = true;
  RunControl control;
  control.stop = borrow(stop);
  EXPECT_THROW(choose_components(*scene_.volume(), scene_.options(), rule_, control), Interrupted);
}

TEST(ComponentsOfMeshes, AreKeptInTheirOrder) {
  const Scene scene = grains();
  const SurfacePiece all = extract_all(scene, true);
  const World world;
  const auto mesh_of = [&](const SurfacePiece& piece) {
    TriangleMesh mesh;
    for (const Vec3& position : piece.positions) mesh.vertices.push_back(world.point(position));
    mesh.normals.assign(piece.normals.begin(), piece.normals.end());
    mesh.triangles.assign(piece.triangles.begin(), piece.triangles.end());
    return mesh;
  };
  for (const ComponentRule& rule :
       {ComponentRule{}, ComponentRule{9, false}, ComponentRule{0, true}, ComponentRule{100000, false}}) {
    const Kept kept = keep(all, rule);
    const TriangleMesh expected = mesh_of(kept.piece);
    TriangleMesh mesh = mesh_of(all);
    mesh.vertices.push_back({1, 2, 3});
    mesh.normals.push_back({0, 0, 1});
    const DroppedComponents dropped = keep_components(mesh, rule);
    EXPECT_EQ(mesh.vertices, expected.vertices);
    EXPECT_EQ(mesh.normals, expected.normals);
    EXPECT_EQ(mesh.triangles, expected.triangles);
    EXPECT_EQ(dropped.components, kept.components_dropped);
    EXPECT_EQ(dropped.triangles, kept.triangles_dropped);
    EXPECT_EQ(dropped.vertices, all.positions.size() + 1 - expected.vertices.size());
  }
}

}  // namespace
}  // namespace isoweave::testing::components_test
