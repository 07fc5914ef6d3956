// Volumes of several components, and the plain way to the mesh of those that are kept.
#pragma once

#include <map>
#include <numeric>

#include "extract/marching_cubes.hpp"
#include "oracle.hpp"
#include "output/world.hpp"

namespace isoweave::testing {

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
    options.error = Length::voxels(surface.error);
    options.quality = surface.quality;
    options.drop_specks = surface.drop_specks;
    options.max_distance = Length::voxels(surface.max_distance);
    return options;
  }

  SurfaceCase surface;  // the kind of its volume means nothing
  std::vector<float> samples;
};

inline Scene generated(const std::string& kind, const Dims& dims) {
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
inline Scene arches() {
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
inline Scene grains() {
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
inline Scene twins() {
  Scene scene({16, 12, 12});
  for (std::int64_t n = 0; n < 8; ++n) {
    const Dims first{10 - 8 * (n & 1), 7 - 6 * (n >> 1 & 1), 7 - 6 * (n >> 2 & 1)};
    scene.fill(first, {first[0] + 3, first[1] + 3, first[2] + 3});
  }
  return scene;
}

// The complete surface in one piece.
inline SurfacePiece extract_all(const Scene& scene, bool normals = false) {
  const Executor executor(1);
  const auto volume = scene.volume();
  MarchingCubes extractor(volume->info(), {{0.5, true, scene.surface.closed}, normals}, executor);
  SliceWindow window(*volume);
  window.advance(0, volume->info().dims[2]);
  SurfacePiece piece;
  extractor.extract(window, extractor.layers_left(), ~std::uint64_t{0}, piece);
  return piece;
}

// The first vertex of the component of each.
inline std::vector<std::uint32_t> component_of_vertices(const SurfacePiece& piece) {
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
inline Kept keep(const SurfacePiece& all, const ComponentRule& rule) {
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
inline SurfaceRun reference(const Scene& scene, const Kept& kept, std::uint64_t triangles = 0) {
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
  output.take(simplifier.final_source());
  output.wait();
  output.report(run.report);
  run.mesh = std::move(sink.mesh);
  return run;
}

inline ComponentChoice choose(const Scene& scene, const ComponentRule& rule, std::int64_t slab = 3, int threads = 2) {
  MeshOptions options = scene.options();
  RunControl control;
  control.slab = slab;
  control.threads = threads;
  return choose_components(*scene.volume(), options, rule, control);
}

}  // namespace isoweave::testing
