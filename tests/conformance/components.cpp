// Runs that drop components make the mesh of a surface that never had them.
#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "oracle.hpp"
#include "pipeline/world.hpp"

namespace isoweave::testing {
namespace {

using Dims = std::array<std::int64_t, 3>;

// A volume of zeros and ones, and how it is meshed.
struct Scene {
  explicit Scene(const Dims& volume_dims) : surface{} {
    surface.volume.dims = volume_dims;
    surface.volume.spacing = {0.8, 1.1, 1.5};
    samples.assign(static_cast<std::size_t>(volume_dims[0] * volume_dims[1] * volume_dims[2]), 0);
  }

  void fill(const Dims& first, const Dims& end) {
    const Dims& n = surface.volume.dims;
    for (std::int64_t k = first[2]; k < end[2]; ++k) {
      for (std::int64_t j = first[1]; j < end[1]; ++j) {
        for (std::int64_t i = first[0]; i < end[0]; ++i) {
          samples[static_cast<std::size_t>((k * n[1] + j) * n[0] + i)] = 1;
        }
      }
    }
  }

  std::unique_ptr<MemoryVolume> volume() const {
    auto memory = std::make_unique<MemoryVolume>(surface.volume.dims, samples);
    memory->info().geometry.spacing = surface.volume.spacing;
    return memory;
  }

  MeshOptions options() const {
    MeshOptions options;
    options.iso = 0.5;
    options.closed = surface.closed;
    options.error = {surface.error, true};
    options.quality = surface.quality;
    options.drop_specks = surface.drop_specks;
    options.max_distance = {surface.max_distance, true};
    return options;
  }

  SurfaceCase surface;  // the kind of its volume means nothing
  std::vector<float> samples;
};

Scene generated(const std::string& kind, const Dims& dims) {
  Scene scene(dims);
  GenerateOptions volume = scene.surface.volume;
  volume.kind = kind;
  volume.type = SampleType::kFloat32;
  volume.seed = 7;
  const auto source = generate_volume(volume);
  source->read(0, dims[2], std::as_writable_bytes(std::span(scene.samples)));
  const auto iso = static_cast<float>(suggested_iso(volume.kind, volume.type));
  for (float& sample : scene.samples) sample += 0.5F - iso;
  return scene;
}

// Legs that begin in several slices and are one only in the last ones; a small box between them.
Scene arches() {
  Scene scene({21, 9, 18});
  scene.fill({1, 1, 0}, {3, 3, 16});
  scene.fill({5, 1, 4}, {7, 3, 16});
  scene.fill({9, 1, 1}, {11, 3, 16});
  scene.fill({1, 1, 15}, {11, 3, 17});
  scene.fill({5, 1, 1}, {7, 3, 2});
  scene.fill({13, 1, 2}, {14, 8, 5});
  scene.fill({13, 1, 5}, {14, 2, 17});
  scene.fill({13, 7, 5}, {14, 8, 12});
  scene.fill({16, 4, 0}, {20, 8, 3});
  return scene;
}

// One sample each, and a box in the middle of them.
Scene grains() {
  Scene scene({18, 15, 16});
  for (std::int64_t k = 0; k < 16; k += 2) {
    for (std::int64_t j = 0; j < 15; j += 2) {
      for (std::int64_t i = k / 2 % 2; i < 18; i += 3) scene.fill({i, j, k}, {i + 1, j + 1, k + 1});
    }
  }
  scene.fill({6, 5, 5}, {12, 10, 10});
  return scene;
}

// Boxes of one size.
Scene twins() {
  Scene scene({16, 12, 12});
  for (std::int64_t n = 0; n < 8; ++n) {
    const Dims first{10 - 8 * (n & 1), 7 - 6 * (n >> 1 & 1), 7 - 6 * (n >> 2 & 1)};
    scene.fill(first, {first[0] + 3, first[1] + 3, first[2] + 3});
  }
  return scene;
}

// The complete surface in one piece.
SurfacePiece extract_all(const Scene& scene, bool normals = false) {
  const Executor executor(1);
  const auto volume = scene.volume();
  MarchingCubes extractor(volume->info(), {{0.5, true, scene.surface.closed}, normals}, executor);
  SliceWindow window(*volume);
  window.advance(0, volume->info().dims[2]);
  SurfacePiece piece;
  extractor.extract(window, extractor.layers_left(), piece);
  return piece;
}

// The first vertex of the component of each.
std::vector<std::uint32_t> component_of_vertices(const SurfacePiece& piece) {
  std::vector<std::uint32_t> first(piece.positions.size());
  std::iota(first.begin(), first.end(), 0U);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& triangle : piece.triangles) {
      const std::uint32_t least = std::min({first[triangle[0]], first[triangle[1]], first[triangle[2]]});
      for (const std::uint32_t v : triangle) {
        if (first[v] != least) changed = true;
        first[v] = least;
      }
    }
  }
  return first;
}

struct Kept {
  SurfacePiece piece;
  std::uint64_t components = 0, components_dropped = 0, triangles_dropped = 0;
};

// What the rule keeps, vertex by vertex.
Kept keep(const SurfacePiece& all, const ComponentRule& rule) {
  const std::vector<std::uint32_t> component = component_of_vertices(all);
  std::map<std::uint32_t, std::uint64_t> sizes;
  for (const auto& triangle : all.triangles) ++sizes[component[triangle[0]]];
  std::uint32_t largest = 0;
  for (const auto& [first, size] : sizes) {
    if (sizes.count(largest) == 0 || size > sizes[largest]) largest = first;
  }
  Kept kept;
  std::map<std::uint32_t, bool> stays;
  for (const auto& [first, size] : sizes) {
    stays[first] = size >= rule.min_triangles && (!rule.largest || first == largest);
    ++(stays[first] ? kept.components : kept.components_dropped);
    kept.triangles_dropped += stays[first] ? 0 : size;
  }
  std::vector<std::uint32_t> number(component.size());
  for (std::uint32_t v = 0; v < component.size(); ++v) {
    if (!stays[component[v]]) continue;
    const std::size_t n = kept.piece.positions.size();
    number[v] = static_cast<std::uint32_t>(n);
    kept.piece.positions.resize(n + 1);
    kept.piece.ids.resize(n + 1);
    kept.piece.positions[n] = all.positions[v];
    kept.piece.ids[n] = all.ids[v];
    if (all.normals.empty()) continue;
    kept.piece.normals.resize(n + 1);
    kept.piece.normals[n] = all.normals[v];
  }
  for (const auto& [a, b, c] : all.triangles) {
    if (!stays[component[a]]) continue;
    const std::size_t n = kept.piece.triangles.size();
    kept.piece.triangles.resize(n + 1);
    kept.piece.triangles[n] = {number[a], number[b], number[c]};
  }
  return kept;
}

// The plain queue on what is kept, down to so many triangles.
SurfaceRun reference(const Scene& scene, const Kept& kept, std::uint64_t triangles = 0) {
  const Executor executor(1);
  ZoneOptions zone = scene.surface.zone();
  if (triangles > 0) zone.retire = kRetiredCost - 1;
  Simplifier simplifier({zone, Schedule::kQueue}, executor, nullptr);
  MemorySink sink;
  const World world;
  FinalOutput output(world, sink, executor);
  simplifier.append(kept.piece);
  const std::uint64_t most = triangles > 0 ? kept.piece.triangles.size() - triangles : ~std::uint64_t{0};
  SurfaceRun run;
  run.report.collapses = decide_in_order(simplifier.zone(), most).collapses;
  simplifier.zone().retire_all();
  output.take(simplifier);
  output.wait();
  output.report(run.report);
  run.mesh = std::move(sink.mesh);
  return run;
}

ComponentChoice choose(const Scene& scene, const ComponentRule& rule, std::int64_t slab = 3, int threads = 2) {
  MeshOptions options = scene.options();
  options.slab = slab;
  RunControl control;
  control.threads = threads;
  return choose_components(*scene.volume(), options, rule, control);
}

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
      options.slab = slab;
      options.components = &choice;
      RunControl control;
      control.schedule = schedule;
      control.threads = threads;
      MemorySink sink;
      const MeshReport report = mesh_volume(*scene.volume(), sink, options, control);
      expect_same(report, simplified.report);
      EXPECT_EQ(report.collapses, simplified.report.collapses);
      expect_dropped(report, kept);
      EXPECT_EQ(report.warnings.size(), kept.components == 0 ? 1U : 0U);

      options.error = {0, true};
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
  options.components = &choice;
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
    options.components = &choice;
    options.slab = 4;
    MemorySink sink;
    const MeshReport report = mesh_volume(*scene.volume(), sink, options);
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
  options.error = {std::numeric_limits<double>::infinity(), false};
  expect_same(run(scene_, options), reference(scene_, kept, options.triangles).report);
  const ComponentChoice choice = choose(scene_, rule_);
  options.components = &choice;
  EXPECT_EQ(count_triangles(*scene_.volume(), options), kept.piece.triangles.size());
}

TEST_F(ComponentsAnd, NormalsStayWithTheirVertices) {
  const Kept kept = keep(extract_all(scene_, true), rule_);
  MeshOptions options = scene_.options();
  options.normals = Normals::kGradient;
  options.error = {0, true};
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
  options.error = {0, true};
  const auto run_with = [&](const ComponentChoice* components) {
    const auto values = other.volume();
    options.values = values.get();
    options.components = components;
    MemorySink sink;
    mesh_volume(*scene_.volume(), sink, options);
    return std::move(sink.mesh);
  };
  const TriangleMesh all = run_with(nullptr);
  const ComponentChoice choice = choose(scene_, rule_);
  const TriangleMesh kept = run_with(&choice);
  ASSERT_EQ(kept.values.size(), kept.vertices.size());
  std::map<Point, float> value_at;
  for (std::size_t v = 0; v < all.vertices.size(); ++v) value_at[all.vertices[v]] = all.values[v];
  for (std::size_t v = 0; v < kept.vertices.size(); ++v) ASSERT_EQ(kept.values[v], value_at.at(kept.vertices[v]));
}

TEST_F(ComponentsAnd, LevelsAreOfWhatIsKept) {
  const ComponentChoice choice = choose(scene_, rule_);
  MeshOptions options = scene_.options();
  options.components = &choice;
  options.slab = 4;
  options.error = {0.8, true};
  options.levels = {{0, true}, {0.3, true}};
  MemorySink sinks[3];
  MeshSink* const pointers[] = {&sinks[0], &sinks[1], &sinks[2]};
  const MeshReport report = mesh_volume(*scene_.volume(), pointers, options);
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
  options.components = &choice;
  RunControl control;
  control.observer = &watcher;
  MemorySink sink;
  EXPECT_EQ(mesh_volume(*scene_.volume(), sink, options, control).triangles, watcher.seen);
}

TEST_F(ComponentsAnd, AChoiceIsForOneSurface) {
  const ComponentChoice choice = choose(scene_, rule_);
  MeshOptions options = scene_.options();
  options.components = &choice;
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
      options.slab = slab;
      EXPECT_THROW(mesh_volume(*other.volume(), sink, options), BadInput) << first[2] << ", slab " << slab;
    }
  }
  // Another leg of an arch, which a kept part and a dropped one turn out to share.
  Scene legs({9, 5, 8});
  legs.fill({1, 1, 1}, {3, 3, 7});
  legs.fill({5, 1, 1}, {6, 2, 4});
  const ComponentChoice apart = choose(legs, {0, true});
  options = legs.options();
  options.components = &apart;
  legs.fill({3, 1, 3}, {5, 2, 4});
  for (const std::int64_t slab : {1, 2, 50}) {
    options.slab = slab;
    EXPECT_THROW(mesh_volume(*legs.volume(), sink, options), BadInput) << "slab " << slab;
  }
  EXPECT_FALSE(sink.finished);
  RunControl control;
  control.device = Device::kCuda;
  EXPECT_THROW(choose_components(*scene_.volume(), options, rule_, control), std::invalid_argument);
}

TEST_F(ComponentsAnd, TheFirstPassCanBeStopped) {
  const std::atomic<bool> stop = true;
  RunControl control;
  control.stop = &stop;
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
}  // namespace isoweave::testing
