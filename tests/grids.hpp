// Small volumes by their samples, and their surfaces by any extractor.
#pragma once

#include <gtest/gtest.h>

#include <random>

#include "surfaces.hpp"

namespace isoweave::testing {

using Dims = std::array<std::int64_t, 3>;

constexpr std::array kAllExtractors{ExtractorKind::kCubes, ExtractorKind::kTrilinear, ExtractorKind::kTetrahedra,
                                    ExtractorKind::kDual};

struct Grid {
  Dims dims;
  std::vector<float> samples = std::vector<float>(static_cast<std::size_t>(dims[0] * dims[1] * dims[2]), -1.0F);

  float& at(std::int64_t i, std::int64_t j, std::int64_t k) {
    return samples[static_cast<std::size_t>((k * dims[1] + j) * dims[0] + i)];
  }
  bool is_inside(std::int64_t i, std::int64_t j, std::int64_t k) {
    const bool within = i >= 0 && j >= 0 && k >= 0 && i < dims[0] && j < dims[1] && k < dims[2];
    return within && at(i, j, k) >= 0;
  }
  template <class Fill>
  void fill(const Fill& fill) {
    for (std::int64_t k = 0; k < dims[2]; ++k) {
      for (std::int64_t j = 0; j < dims[1]; ++j) {
        for (std::int64_t i = 0; i < dims[0]; ++i) at(i, j, k) = fill(i, j, k);
      }
    }
  }
};

struct Made {
  TriangleMesh mesh;
  MeshCheck check;
  MeshReport report;
};

inline Made make(const Grid& grid, ExtractorKind extractor, bool closed = true,
                 const std::array<double, 3>& spacing = {1, 1, 1}, MeshOptions options = {}) {
  MemoryVolume volume(grid.dims, grid.samples);
  volume.info().geometry.spacing = spacing;
  options.closed = closed;
  options.extractor = extractor;
  MemorySink sink;
  Made made;
  made.report = mesh_volume(volume, sink, options);
  made.mesh = std::move(sink.mesh);
  made.check = check_mesh(made.mesh);
  return made;
}

inline MeshOptions full() { return full_surface({}); }

inline void expect_manifold(const Made& made, bool closed) {
  EXPECT_EQ(made.check.nonmanifold_edges, 0U);
  EXPECT_EQ(made.check.nonmanifold_vertices, 0U);
  EXPECT_EQ(made.check.misoriented_edges, 0U);
  EXPECT_EQ(made.check.degenerate_triangles, 0U);
  EXPECT_EQ(made.check.unused_vertices, 0U);
  if (closed) {
    EXPECT_EQ(made.check.open_edges, 0U);
  }
  EXPECT_EQ(made.check.open_edges, made.report.open_edges);
}

inline Grid random_grid(const Dims& dims, std::mt19937& random) {
  std::uniform_real_distribution<float> value(-1, 1);
  Grid grid{dims};
  grid.fill([&](auto...) { return value(random); });
  return grid;
}

}  // namespace isoweave::testing
