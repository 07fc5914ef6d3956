// Threads: none, the loops are those of schedules.cpp
#include "conformance/plain_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "plain_rules/volume_surface.hpp"
#include "sanitized.hpp"

namespace isoweave::testing::plain_scenes {
namespace {

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

}  // namespace

std::unique_ptr<SliceSource> Scene::open_values() const {
  if (values.empty()) return nullptr;
  VolumeInfo other;
  other.dims = info.dims;
  other.type = SampleType::kFloat32;
  return volume_in_memory(other, std::as_bytes(std::span(values)));
}

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

Scene planes(bool closed, std::int64_t size) {
  const auto n = static_cast<double>(size);
  Scene scene = made_of("planes", {size, size + 1, size - 1}, [n](double i, double j, double k) {
    return std::min(
        {0.78 * n - 0.61 * i - 0.27 * j - 0.43 * k, 0.83 * i - 0.37 * j - 0.02 * n, 0.71 * k + 0.53 * j - 0.39 * n});
  });
  scene.options.closed = closed;
  return scene;
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

void compare_qualities(Scene scene) {
  for (const Quality quality : kQualities) {
    scene.options.quality = quality;
    const plain::Outcome plain = compare(scene);
    EXPECT_GT(plain.collapses, 0U) << name_of(scene);
  }
}

std::vector<std::string> some(std::vector<std::string> kinds) {
  if (kSanitized) kinds.resize(1);
  return kinds;
}

}  // namespace isoweave::testing::plain_scenes
