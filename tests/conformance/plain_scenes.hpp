// Volumes in memory, and the comparison of their meshes, bit for bit, with those of rules that were written a second
// time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "isoweave/generate.hpp"
#include "isoweave/pipeline.hpp"
#include "plain_rules/simplifier.hpp"

namespace isoweave::testing::plain_scenes {

// A volume in memory, and how it is meshed: lengths in mean voxels.
struct Scene {
  std::string name;
  VolumeInfo info{};
  std::vector<std::byte> samples{};
  std::vector<float> values{};  // of another volume, or none
  MeshOptions options{};
  std::int64_t slab = 4;

  std::unique_ptr<SliceSource> open() const { return volume_in_memory(info, samples); }
  std::unique_ptr<SliceSource> open_values() const;  // nullptr: there is no other volume
};

Scene make_scene(const std::string& name);
Scene generated(const GenerateOptions& volume);
Scene generated(const std::string& kind);

// Oblique planes: what an edge costs there is rounding alone, so the last bit of every sum decides the order.
Scene planes(bool closed, std::int64_t size);

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

inline constexpr std::array kQualities{Quality::kFast, Quality::kNormal, Quality::kFine};

// Under a sanitizer the first of them.
std::vector<std::string> some(std::vector<std::string> kinds);

std::string name_of(const Scene& scene);
RunControl one_thread(const Scene& scene);

struct Result {
  TriangleMesh mesh;
  MeshReport report;
};

// By the library.
Result mesh_of(const Scene& scene, MeshOptions options);

// By the plain rules. Lengths of the options are in units.
plain::Options plain_options(const MeshOptions& options, double unit);
plain::Surface extracted_surface(const Scene& scene);
plain::Outcome plain_run(const Scene& scene, const plain::Surface& surface);

// A triangle by the bits of all that its corners have, the least corner first.
using Bits = std::vector<std::uint32_t>;

// Of all triangles, sorted.
std::vector<Bits> mesh_bits(const TriangleMesh& mesh);
std::vector<Bits> mesh_bits(const plain::Surface& surface, bool normals, bool values);

// The counters of the library and of the plain rules, and every bit of their meshes, are equal.
void expect_same(const TriangleMesh& mesh, const MeshReport& report, const plain::Outcome& plain,
                 const std::string& what);

plain::Outcome compare(const Scene& scene);
void compare_qualities(Scene scene);

}  // namespace isoweave::testing::plain_scenes
