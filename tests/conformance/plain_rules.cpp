// Whole meshes of the library, compared bit for bit with those of rules that were written a second time.
// Threads: none, the loops are those of schedules.cpp
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <map>
#include <numeric>
#include <random>

#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "meshes.hpp"
#include "plain_rules/riders.hpp"
#include "plain_rules/volume_surface.hpp"
#include "sanitized.hpp"

namespace isoweave::testing {
namespace {

// A volume in memory, and how it is meshed: lengths in mean voxels.
struct Scene {
  std::string name;
  VolumeInfo info{};
  std::vector<std::byte> samples{};
  std::vector<float> values{};  // of another volume, or none
  MeshOptions options{};
  std::int64_t slab = 4;

  std::unique_ptr<SliceSource> open() const { return volume_in_memory(info, samples); }

  std::unique_ptr<SliceSource> open_values() const {
    if (values.empty()) return nullptr;
    VolumeInfo other;
    other.dims = info.dims;
    other.type = SampleType::kFloat32;
    return volume_in_memory(other, std::as_bytes(std::span(values)));
  }
};

Scene make_scene(const std::string& name) {
  Scene scene{name};
  scene.options.error = Length::voxels(0.4);
  scene.options.space = OutputSpace::kIndex;
  return scene;
}

Scene generated(const GenerateOptions& volume) {
  Scene scene = make_scene(volume.kind);
  const auto source = generate_volume(volume);
  scene.info = source->info();
  scene.samples.resize(static_cast<std::size_t>(scene.info.dims[2]) * scene.info.slice_bytes());
  source->read(0, scene.info.dims[2], scene.samples);
  scene.options.iso = suggested_iso(volume.kind, volume.type);
  return scene;
}

Scene generated(const std::string& kind) {
  GenerateOptions volume;
  volume.kind = kind;
  volume.dims = {11, 9, 12};
  volume.seed = 5;
  return generated(volume);
}

// A volume of doubles, which field(i, j, k) gives; its surface is where that is 0.
template <class Field>
Scene made_of(const std::string& name, const std::array<std::int64_t, 3>& dims, const Field& field) {
  Scene scene = make_scene(name);
  std::vector<double> numbers;
  for (std::int64_t k = 0; k < dims[2]; ++k) {
    for (std::int64_t j = 0; j < dims[1]; ++j) {
      for (std::int64_t i = 0; i < dims[0]; ++i) {
        numbers.push_back(field(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)));
      }
    }
  }
  scene.info.dims = dims;
  scene.info.type = SampleType::kFloat64;
  const auto bytes = std::as_bytes(std::span(numbers));
  scene.samples.assign(bytes.begin(), bytes.end());
  return scene;
}

// Oblique planes: what an edge costs there is rounding alone, so the last bit of every sum decides the order.
Scene planes(bool closed, std::int64_t size) {
  const auto n = static_cast<double>(size);
  Scene scene = made_of("planes", {size, size + 1, size - 1}, [n](double i, double j, double k) {
    return std::min(
        {0.78 * n - 0.61 * i - 0.27 * j - 0.43 * k, 0.83 * i - 0.37 * j - 0.02 * n, 0.71 * k + 0.53 * j - 0.39 * n});
  });
  scene.options.closed = closed;
  return scene;
}

// A triangle by the bits of all that its corners have, the least corner first.
using Bits = std::vector<std::uint32_t>;

template <class CornerBits>
Bits triangle_bits(const CornerBits& corner) {
  std::array<Bits, 3> corners{corner(0), corner(1), corner(2)};
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  Bits bits;
  for (const Bits& c : corners) bits.insert(bits.end(), c.begin(), c.end());
  return bits;
}

// -0 counts as 0.
void add_bits(const Point& point, Bits& bits) {
  for (const float number : point) bits.push_back(std::bit_cast<std::uint32_t>(number + 0.0F));
}

std::vector<Bits> mesh_bits(const TriangleMesh& mesh) {
  std::vector<Bits> list;
  for (const auto& triangle : mesh.triangles) {
    list.push_back(triangle_bits([&](std::size_t c) {
      const std::uint32_t v = triangle[c];
      Bits bits;
      add_bits(mesh.vertices[v], bits);
      if (!mesh.normals.empty()) add_bits(mesh.normals[v], bits);
      if (!mesh.values.empty()) bits.push_back(std::bit_cast<std::uint32_t>(mesh.values[v]));
      return bits;
    }));
  }
  std::ranges::sort(list);
  return list;
}

Point rounded(const plain::Vector& place) {
  return {static_cast<float>(place[0]), static_cast<float>(place[1]), static_cast<float>(place[2])};
}

// Normals leave the library with unit length.
Point of_unit_length(const Point& normal) {
  const plain::Vector n{normal[0], normal[1], normal[2]};
  const double size = plain::length(n);
  if (!(size > 0)) return {0, 0, 0};
  return {static_cast<float>(n[0] / size), static_cast<float>(n[1] / size), static_cast<float>(n[2] / size)};
}

std::vector<Bits> mesh_bits(const plain::Surface& surface, bool normals, bool values) {
  std::vector<Bits> list;
  for (const auto& triangle : surface.triangles) {
    list.push_back(triangle_bits([&](std::size_t c) {
      const plain::Corner& corner = surface.corners[triangle[c]];
      Bits bits;
      add_bits(rounded(corner.place), bits);
      if (normals) add_bits(of_unit_length(corner.normal), bits);
      if (values) bits.push_back(std::bit_cast<std::uint32_t>(corner.value));
      return bits;
    }));
  }
  std::ranges::sort(list);
  return list;
}

struct Result {
  TriangleMesh mesh;
  MeshReport report;
};

RunControl one_thread(const Scene& scene) {
  RunControl control;
  control.threads = 1;
  control.slab = scene.slab;
  return control;
}

Result mesh_of(const Scene& scene, MeshOptions options) {
  options.values = scene.open_values();
  MeshInMemory sink;
  Result result;
  result.report = mesh_volume(*scene.open(), sink, options, one_thread(scene));
  result.mesh = sink.copy();
  return result;
}

plain::Options plain_options(const MeshOptions& options, double unit) {
  plain::Options plain;
  plain.quality = options.quality;
  plain.error = options.error.value * unit;
  plain.most_distance = options.max_distance.value * unit;
  plain.triangles = options.triangles;
  plain.drop_specks = options.drop_specks;
  plain.normals_count = options.normals == Normals::kQuadric;
  return plain;
}

// The counters of the library and of the plain rules, and every bit of their meshes, are equal.
void expect_same(const TriangleMesh& mesh, const MeshReport& report, const plain::Outcome& plain,
                 const std::string& what) {
  EXPECT_EQ(mesh.triangles.size(), plain.surface.triangles.size()) << what;
  EXPECT_TRUE(mesh_bits(mesh) == mesh_bits(plain.surface, !mesh.normals.empty(), !mesh.values.empty())) << what;
  EXPECT_EQ(report.collapses, plain.collapses) << what;
  EXPECT_EQ(report.postponed, plain.postponed) << what;
  EXPECT_EQ(report.rekeyed, plain.rekeyed) << what;
  EXPECT_EQ(report.specks, plain.specks) << what;
  EXPECT_EQ(report.locked_vertices, plain.locked) << what;
}

plain::Surface extracted_surface(const Scene& scene) {
  MeshOptions options = scene.options;
  options.error = {};
  options.max_distance = {};
  options.triangles = 0;
  options.components = nullptr;
  const TriangleMesh mesh = mesh_of(scene, options).mesh;
  if (options.smooth == 0) return plain::surface_of(plain::read_samples(*scene.open()), mesh, options);
  const auto smoothed = smooth_mask(scene.open(), {options.iso, options.inside_above, options.smooth});
  options.iso = 0;
  options.inside_above = true;
  return plain::surface_of(plain::read_samples(*smoothed), mesh, options);
}

plain::Outcome plain_run(const Scene& scene, const plain::Surface& surface) {
  return plain::simplify(surface, plain_options(scene.options, std::sqrt(surface.face)));
}

std::string name_of(const Scene& scene) {
  const MeshOptions& options = scene.options;
  const auto& [x, y, z] = scene.info.geometry.spacing;
  return scene.name + (options.closed ? " closed" : " open") + ", spacing " + std::to_string(x) + " " +
         std::to_string(y) + " " + std::to_string(z) + ", error " + std::to_string(options.error.value) + ", quality " +
         std::to_string(static_cast<int>(options.quality)) + ", triangles " + std::to_string(options.triangles) +
         ", distance " + std::to_string(options.max_distance.value) + ", normals " +
         std::to_string(static_cast<int>(options.normals));
}

plain::Outcome compare(const Scene& scene) {
  plain::Outcome plain = plain_run(scene, extracted_surface(scene));
  const Result library = mesh_of(scene, scene.options);
  expect_same(library.mesh, library.report, plain, name_of(scene));
  return plain;
}

constexpr std::array kQualities{Quality::kFast, Quality::kNormal, Quality::kFine};

void compare_qualities(Scene scene) {
  for (const Quality quality : kQualities) {
    scene.options.quality = quality;
    const plain::Outcome plain = compare(scene);
    EXPECT_GT(plain.collapses, 0U) << name_of(scene);
  }
}

// A hub with spokes, flat but for a wave; a double one has two hubs, one above the other, and no border.
TriangleMesh wheel(std::uint32_t spokes, bool twice) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0.4F}, {0, 0, -0.5F}};
  for (std::uint32_t n = 0; n < spokes; ++n) {
    const std::uint32_t next = 2 + (n + 1) % spokes;
    const double angle = 6.283185307179586 * n / spokes;
    mesh.vertices.push_back(
        {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), n % 2 == 0 ? 0.01F : 0.0F});
    mesh.triangles.push_back({0, 2 + n, next});
    if (twice) mesh.triangles.push_back({1, next, 2 + n});
  }
  return mesh;
}

// A flat grid whose vertices have moved within it, some of them to others: all costs are equal, many places turn a
// face over, and there are edges without length and faces without area.
TriangleMesh crumpled_grid(std::uint32_t n) {
  TriangleMesh mesh = meshes::grid(n);
  std::mt19937 random(7);
  for (Point& p : mesh.vertices) {
    for (std::size_t axis = 0; axis < 2; ++axis) p[axis] += static_cast<float>(random() % 129) / 128 - 0.5F;
    mesh.values.push_back(static_cast<float>(random() % 100));
  }
  for (std::size_t v = 0; v + 1 < mesh.vertices.size(); v += 7) mesh.vertices[v] = mesh.vertices[v + 1];
  return mesh;
}

// Cuts each triangle into four.
TriangleMesh refined(const TriangleMesh& mesh) {
  TriangleMesh out;
  out.vertices = mesh.vertices;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [found, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(out.vertices.size()));
    if (is_new) {
      const Point& p = mesh.vertices[a];
      const Point& q = mesh.vertices[b];
      out.vertices.push_back({(p[0] + q[0]) / 2, (p[1] + q[1]) / 2, (p[2] + q[2]) / 2});
    }
    return found->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b);
    const std::uint32_t bc = middle(b, c);
    const std::uint32_t ca = middle(c, a);
    out.triangles.insert(out.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return out;
}

// A cube that has been sheared: beside its corners large errors cancel but for rounding.
TriangleMesh skewed_cube() {
  TriangleMesh mesh = refined(refined(refined(meshes::cube())));
  for (auto& [x, y, z] : mesh.vertices) {
    x += 0.37F * y + 0.11F * z;
    y += 0.23F * z - 0.41F * x;
    z += 0.31F * x;
  }
  return mesh;
}

// Under a sanitizer the first of them.
std::vector<std::string> some(std::vector<std::string> kinds) {
  if (kSanitized) kinds.resize(1);
  return kinds;
}

std::vector<std::string> kinds() { return kSanitized ? std::vector<std::string>{"noise", "box"} : generator_kinds(); }

TEST(PlainRules, EveryKindAndQuality) {
  for (const std::string& kind : kinds()) {
    for (const bool closed : {true, false}) {
      for (const double error : {0.05, 0.4, 3.0}) {
        Scene scene = generated(kind);
        scene.options.closed = closed;
        scene.options.error.value = error;
        for (const Quality quality : kQualities) {
          scene.options.quality = quality;
          compare(scene);
        }
      }
    }
  }
}

TEST(PlainRules, ObliquePlanesWhereRoundingAloneDecides) {
  for (const bool closed : {true, false}) {
    for (const std::int64_t size : {10, 17}) {
      Scene scene = planes(closed, size);
      for (const double error : {1e-6, 0.3, 2.0}) {
        scene.options.error.value = error;
        compare_qualities(scene);
      }
      scene.info.geometry.spacing = {0.7, 1.3, 2.1};
      compare_qualities(scene);
    }
  }
}

TEST(PlainRules, VoxelsThatAreNoCubes) {
  for (const std::string& kind : kinds()) {
    Scene scene = generated(kind);
    scene.info.geometry.spacing = {0.7, 0.9, 1.9};
    scene.options.closed = kind.size() % 2 == 0;
    compare_qualities(scene);
  }
}

TEST(PlainRules, TypesOfSamplesAndSidesOfTheSurface) {
  for (const SampleType type :
       {SampleType::kUint8, SampleType::kInt8, SampleType::kUint16, SampleType::kInt16, SampleType::kUint32,
        SampleType::kInt32, SampleType::kUint64, SampleType::kInt64, SampleType::kFloat64}) {
    GenerateOptions volume;
    volume.kind = "noise";
    volume.dims = {9, 10, 8};
    volume.type = type;
    Scene scene = generated(volume);
    scene.name += " " + std::string(sample_type_name(type));
    compare(scene);
    scene.options.inside_above = false;
    compare(scene);
    scene.info.slope = -0.5;
    scene.info.intercept = 3;
    scene.options.iso = 3 - 0.5 * scene.options.iso;
    compare(scene);
  }
}

// Planes of samples, rows of them, and lattices that are three points wide.
TEST(PlainRules, FlatVolumes) {
  for (const std::array<std::int64_t, 3>& dims : {std::array<std::int64_t, 3>{1, 14, 15},
                                                  {14, 1, 15},
                                                  {13, 14, 1},
                                                  {2, 13, 12},
                                                  {1, 1, 20},
                                                  {1, 20, 1},
                                                  {20, 1, 1},
                                                  {1, 1, 1}}) {
    GenerateOptions volume;
    volume.kind = "white";
    volume.dims = dims;
    Scene scene = generated(volume);
    for (const double error : {0.3, 2.0}) {
      scene.options.error.value = error;
      for (const Quality quality : kQualities) {
        scene.options.quality = quality;
        compare(scene);
      }
    }
  }
}

TEST(PlainRules, SamplesThatAreNoNumbers) {
  Scene scene = made_of("holes", {9, 10, 11}, [](double i, double j, double k) {
    const bool hole = std::fmod(3 * i + 5 * j + 7 * k, 11) < 2;
    return hole ? std::numeric_limits<double>::quiet_NaN() : 4 - std::hypot(i - 4.1, j - 4.7, k - 5.2);
  });
  compare_qualities(scene);
  scene.options.closed = false;
  scene.options.normals = Normals::kQuadric;
  compare_qualities(scene);
}

TEST(PlainRules, NumbersOfTriangles) {
  for (const std::string& kind : some({"noise", "gyroid", "specks", "box"})) {
    for (const std::uint64_t triangles : {1U, 100U, 333U, 700U}) {
      Scene scene = generated(kind);
      scene.options.closed = triangles != 333;
      scene.options.triangles = triangles;
      for (const double error : {0.5, std::numeric_limits<double>::infinity()}) {
        scene.options.error.value = error;
        scene.options.drop_specks = error < 1;
        const plain::Surface surface = extracted_surface(scene);
        const plain::Outcome plain = plain_run(scene, surface);
        const Result library = mesh_of(scene, scene.options);
        expect_same(library.mesh, library.report, plain, name_of(scene));
        EXPECT_EQ(library.report.error, plain.dearest) << name_of(scene);
      }
    }
  }
}

TEST(PlainRules, SpecksThatGo) {
  std::uint64_t specks = 0;
  for (const std::string& kind : some({"specks", "white", "smooth"})) {
    for (const double error : {0.3, 0.6, 1.5, 4.0}) {
      for (const Quality quality : kQualities) {
        Scene scene = generated(kind);
        scene.options.drop_specks = true;
        scene.options.error.value = error;
        scene.options.quality = quality;
        specks += compare(scene).specks;
      }
    }
  }
  EXPECT_GT(specks, kSanitized ? 10U : 100U);
}

// Each level is the mesh of a run of its own.
TEST(PlainRules, Levels) {
  for (const Quality quality : kQualities) {
    Scene scene = generated("noise");
    scene.options.quality = quality;
    scene.options.levels = {{0.1, true}, {0.3, true}};
    scene.options.error = Length::voxels(1);
    scene.options.drop_specks = true;
    std::array<MeshInMemory, 3> meshes;
    std::array<MeshSink*, 3> sinks{};
    std::ranges::transform(meshes, sinks.begin(), [](MeshInMemory& mesh) { return &mesh; });
    mesh_volume(*scene.open(), sinks, scene.options, one_thread(scene));
    scene.options.levels = {};
    const plain::Surface surface = extracted_surface(scene);
    for (std::size_t level = 0; level < meshes.size(); ++level) {
      scene.options.error.value = std::array{0.1, 0.3, 1.0}.at(level);
      const plain::Outcome plain = plain_run(scene, surface);
      EXPECT_TRUE(mesh_bits(meshes.at(level).copy()) == mesh_bits(plain.surface, false, false)) << level;
    }
  }
}

TEST(PlainRules, DistancesThatAreBounded) {
  for (const std::string& kind : some({"noise", "gyroid", "box"})) {
    for (const double distance : {0.13, 0.37, 1.1}) {
      Scene scene = generated(kind);
      scene.options.error.value = 1;
      scene.options.closed = distance < 1;
      if (kind[0] == 'g') scene.info.geometry.spacing = {0.7, 0.9, 1.9};
      const std::uint64_t unbounded = mesh_of(scene, scene.options).report.postponed;
      scene.options.max_distance = Length::voxels(distance);
      const std::uint64_t postponed = compare(scene).postponed;
      if (distance < 0.2) {
        EXPECT_GT(postponed, unbounded) << name_of(scene);
      }
    }
  }
}

TEST(PlainRules, NormalsThatRideAlongAndNormalsThatCount) {
  for (const std::string& kind : kinds()) {
    for (const Normals normals : {Normals::kGradient, Normals::kQuadric}) {
      Scene scene = generated(kind);
      scene.options.normals = normals;
      scene.options.closed = kind.size() % 2 == 1;
      scene.info.geometry.spacing = {1.1, 0.9, 1.4};
      for (const Quality quality : kQualities) {
        scene.options.quality = quality;
        compare(scene);
      }
    }
  }
}

// Even normals save all that they cost, but for rounding.
TEST(PlainRules, ObliquePlanesWithNormalsThatCount) {
  for (const bool closed : {true, false}) {
    for (const std::int64_t size : {9, 12, 16}) {
      Scene scene = planes(closed, size);
      scene.options.normals = Normals::kQuadric;
      compare_qualities(scene);
    }
  }
}

TEST(PlainRules, ValuesThatRideAlong) {
  for (const std::string& kind : some({"noise", "box", "gyroid"})) {
    Scene scene = generated(kind);
    const auto samples = static_cast<std::size_t>(scene.info.dims[2] * scene.info.slice_samples());
    for (std::size_t n = 0; n < samples; ++n) {
      const auto number = static_cast<float>(n * 7919 % 101);
      scene.values.push_back(n % 13 == 0 ? std::numeric_limits<float>::quiet_NaN() : number);
    }
    scene.options.closed = false;
    compare_qualities(scene);
    scene.options.normals = Normals::kGradient;
    compare_qualities(scene);
  }
}

TEST(PlainRules, ComponentsThatAreKept) {
  for (const std::string& kind : some({"smooth", "white", "shells"})) {
    for (const ComponentRule& rule : {ComponentRule{40, false}, ComponentRule{0, true}}) {
      Scene scene = generated(kind);
      const ComponentChoice choice = choose_components(*scene.open(), scene.options, rule, one_thread(scene));
      scene.options.components = borrow(choice);
      plain::Surface surface = extracted_surface(scene);
      plain::keep(rule, surface);
      const Result library = mesh_of(scene, scene.options);
      expect_same(library.mesh, library.report, plain_run(scene, surface), name_of(scene));
    }
  }
}

TEST(PlainRules, MasksWithoutTheirStaircase) {
  for (const char* kind : {"sphere", "smooth"}) {
    Scene scene = generated(kind);
    scene.options.smooth = 3;
    compare_qualities(scene);
    scene.options.closed = false;
    compare_qualities(scene);
  }
}

// One of a few.
template <class T>
T pick(std::mt19937& random, std::initializer_list<T> of) {
  return *(of.begin() + random() % of.size());
}

Scene any_scene(std::mt19937& random) {
  const auto side = [&] { return static_cast<std::int64_t>(1 + random() % 12); };
  const auto length = [&] { return 0.5 + static_cast<double>(random() % 100) / 50; };
  const std::vector<std::string> all = generator_kinds();
  GenerateOptions volume;
  volume.kind = all[random() % all.size()];
  volume.dims = {side(), side(), side()};
  volume.type = pick(random, {SampleType::kFloat32, SampleType::kUint8, SampleType::kFloat64});
  volume.spacing = {length(), length(), length()};
  volume.seed = random();
  Scene scene = generated(volume);
  MeshOptions& options = scene.options;
  options.closed = pick(random, {true, false});
  options.inside_above = pick(random, {true, true, false});
  options.smooth = pick(random, {0, 0, 0, 0, 3});
  options.error.value = pick(random, {0.03, 0.2, 0.5, 1.0, 5.0});
  options.quality = pick(random, {Quality::kFast, Quality::kNormal, Quality::kFine});
  options.drop_specks = pick(random, {true, false});
  options.normals = pick(random, {Normals::kAbsent, Normals::kGradient, Normals::kQuadric});
  options.max_distance = Length::voxels(pick(random, {0.0, 0.0, 0.2, 0.6, 1.5}));
  options.triangles = pick<std::uint64_t>(random, {0, 0, 60, 250});
  scene.slab = pick<std::int64_t>(random, {0, 1, 3, 100});
  return scene;
}

// Options that are drawn by chance, together: one may change the work of another.
TEST(PlainRules, AnyOptionsTogether) {
  std::mt19937 random(2024);
  std::uint64_t collapses = 0;
  for (int n = 0; n < (kSanitized ? 30 : 100); ++n) {
    Scene scene = any_scene(random);
    scene.name = std::to_string(n) + ": " + scene.name;
    collapses += compare(scene).collapses;
  }
  EXPECT_GT(collapses, kSanitized ? 1000U : 5000U);
}

// Labels of a map, each with a box of its own.
TEST(PlainRules, Labels) {
  GenerateOptions volume;
  volume.kind = "smooth";
  volume.dims = {13, 12, 11};
  volume.type = SampleType::kUint8;
  Scene scene = generated(volume);
  for (std::byte& sample : scene.samples) sample >>= 6;
  scene.options.iso = 0.5;
  scene.options.smooth = 2;
  const std::vector<LabelExtent> labels = find_labels(*scene.open());
  std::vector<MeshInMemory> meshes(labels.size());
  std::vector<LabelSink> sinks;
  for (std::size_t n = 0; n < labels.size(); ++n) sinks.push_back({labels[n].label, &meshes[n], labels[n].box});
  const LabelsReport report = mesh_labels(*scene.open(), sinks, scene.options, one_thread(scene));
  ASSERT_GT(labels.size(), 1U);
  for (std::size_t n = 0; n < labels.size(); ++n) {
    Scene mask = scene;
    const auto source = label_volume(scene.open(), labels[n].label);
    mask.info = source->info();
    mask.samples.resize(static_cast<std::size_t>(mask.info.dims[2]) * mask.info.slice_bytes());
    source->read(0, mask.info.dims[2], mask.samples);
    const plain::Outcome plain = plain_run(mask, extracted_surface(mask));
    EXPECT_GT(plain.collapses, 0U);
    expect_same(meshes[n].copy(), report.labels[n], plain, "label " + labels[n].label.text());
  }
}

// Meshes of files: ids are positions there, lengths are in roots of twice the mean area of a triangle.
plain::Outcome compare(const TriangleMesh& mesh, const MeshOptions& options, const std::string& what) {
  RunControl control;
  control.threads = 1;
  control.piece = 50;
  MeshInMemory sink;
  const MeshReport report = simplify_mesh(mesh, sink, options, control);
  const plain::Surface surface = plain::surface_of(mesh);
  plain::Outcome plain = plain::simplify(surface, plain_options(options, std::sqrt(surface.face)));
  expect_same(sink.copy(), report, plain,
              what + ", error " + std::to_string(options.error.value) + ", quality " +
                  std::to_string(static_cast<int>(options.quality)));
  return plain;
}

void compare_all(const TriangleMesh& mesh, const std::string& what) {
  for (const double error : {0.02, 0.5, 3.0}) {
    for (const Quality quality : kQualities) {
      MeshOptions options;
      options.error = Length::voxels(error);
      options.quality = quality;
      options.drop_specks = error > 1;
      compare(mesh, options, what);
    }
  }
}

// Vertices and triangles in another order.
TriangleMesh shuffled(const TriangleMesh& mesh) {
  std::mt19937 random(11);
  std::vector<std::uint32_t> from(mesh.vertices.size());
  std::iota(from.begin(), from.end(), 0U);
  std::shuffle(from.begin(), from.end(), random);
  TriangleMesh out = mesh;
  std::vector<std::uint32_t> to(from.size());
  for (std::uint32_t v = 0; v < from.size(); ++v) {
    to[from[v]] = v;
    out.vertices[v] = mesh.vertices[from[v]];
  }
  for (auto& triangle : out.triangles) {
    for (std::uint32_t& v : triangle) v = to[v];
  }
  std::shuffle(out.triangles.begin(), out.triangles.end(), random);
  return out;
}

TriangleMesh unsimplified(const std::string& kind, bool closed) {
  Scene scene = generated(kind);
  scene.options.error = {};
  scene.options.closed = closed;
  return mesh_of(scene, scene.options).mesh;
}

TEST(PlainRules, MeshesOfFiles) {
  for (const std::string& kind : some({"noise", "torus", "white"})) {
    for (const bool closed : {true, false}) {
      TriangleMesh mesh = shuffled(unsimplified(kind, closed));
      for (std::size_t v = 0; v < mesh.vertices.size(); ++v) mesh.values.push_back(static_cast<float>(v % 17));
      compare_all(mesh, kind);
    }
  }
}

// Of more triangles than the mean area is summed over at a time.
TEST(PlainRules, ObliquePlanesOfAFile) {
  Scene scene = planes(true, 36);
  scene.options.error = {};
  const TriangleMesh mesh = shuffled(mesh_of(scene, scene.options).mesh);
  EXPECT_GT(mesh.triangles.size(), 5000U);
  MeshOptions options;
  options.error = Length::voxels(0.3);
  compare(mesh, options, "planes");
}

// Some collapses are forbidden by a ring of many neighbours, by borders and by what is no manifold.
TEST(PlainRules, MeshesOfOddShapes) {
  compare_all(meshes::tetrahedron(), "tetrahedron");
  compare_all(meshes::cube(), "cube");
  compare_all(meshes::grid(9), "grid");
  compare_all(crumpled_grid(14), "crumpled grid");
  compare_all(skewed_cube(), "skewed cube");
  compare_all(meshes::two_tetrahedra_sharing_a_vertex(), "two tetrahedra at a vertex");
  compare_all(meshes::two_tetrahedra_sharing_an_edge(), "two tetrahedra at an edge");
  compare_all(meshes::moebius_strip(), "Moebius strip");
  compare_all(meshes::cube_with_a_flipped_triangle(), "flipped triangle");
  for (const std::uint32_t spokes : {3U, 24U, 25U, 26U, 27U, 29U, 40U}) {
    compare_all(wheel(spokes, false), "open wheel of " + std::to_string(spokes));
    compare_all(wheel(spokes, true), "double wheel of " + std::to_string(spokes));
  }
}

// Where triangles are left out of a surface at random it has borders, and vertices of several fans.
TEST(PlainRules, MeshesWithHoles) {
  for (const std::string& kind : some({"noise", "gyroid", "box"})) {
    TriangleMesh mesh = unsimplified(kind, true);
    std::mt19937 random(3);
    std::erase_if(mesh.triangles, [&](const auto&) { return random() % 8 == 0; });
    for (std::size_t n = 0; n < mesh.triangles.size(); n += 40) std::swap(mesh.triangles[n][0], mesh.triangles[n][1]);
    for (std::size_t n = 0; n < mesh.triangles.size(); n += 90) mesh.triangles[n][2] = mesh.triangles[n][0];
    compare_all(mesh, kind);
    MeshOptions options;
    options.error = Length::voxels(1);
    options.max_distance = Length::voxels(0.4);
    EXPECT_GT(compare(mesh, options, kind).locked, 0U);
    options.max_distance = {};
    options.triangles = 300;
    compare(mesh, options, kind);
  }
}

}  // namespace
}  // namespace isoweave::testing
