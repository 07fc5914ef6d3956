// Runs over files with an index and without.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "isoweave/index.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave::testing {

inline MeshReport run_file(const std::string& path, double iso, const std::string& index, Normals normals) {
  const auto volume = open_volume(path);
  MeshOptions options;
  options.iso = iso;
  options.closed = false;
  options.normals = normals;
  RunControl control;
  control.threads = 1;
  control.slab = 3;
  if (!index.empty()) control.index = read_index(index, volume->info());
  MeshInMemory mesh;
  return mesh_volume(*volume, mesh, options, control);
}

// Makes an index of a file, and expects the same mesh and the same report with it. Returns the report with it.
inline MeshReport expect_same_with_index(const std::string& path, double iso, Normals normals = Normals::kAbsent) {
  const std::string index = path + ".test-index";
  write_index(*build_index(*open_volume(path)), index);
  const MeshReport plain = run_file(path, iso, {}, normals);
  const MeshReport with = run_file(path, iso, index, normals);
  EXPECT_GT(plain.triangles, 0U);
  EXPECT_EQ(with.digest, plain.digest);
  EXPECT_EQ(with.min, plain.min);
  EXPECT_EQ(with.max, plain.max);
  EXPECT_EQ(with.nan, plain.nan);
  EXPECT_EQ(with.vertices_extracted, plain.vertices_extracted);
  EXPECT_EQ(with.cells_crossed, plain.cells_crossed);
  EXPECT_FALSE(plain.left_out);
  EXPECT_TRUE(with.left_out);
  return with;
}

}  // namespace isoweave::testing
