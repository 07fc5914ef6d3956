// Whole meshes of volumes, compared bit for bit with those of rules that were written a second time.
// Threads: none, the loops are those of schedules.cpp
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "conformance/plain_scenes.hpp"
#include "plain_rules/volume_surface.hpp"
#include "sanitized.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::plain_rules_test {

using namespace plain_scenes;

namespace {

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
    for (const double distance : {0.03, 0.13, 0.37, 1.1}) {
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
  options.max_distance = Length::voxels(pick(random, {0.0, 0.0, 0.05, 0.2, 0.6, 1.5}));
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

}  // namespace
}  // namespace isoweave::testing::plain_rules_test
