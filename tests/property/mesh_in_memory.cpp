// A sink with room for pieces gets the mesh that one without gets, vertex by vertex and triangle by triangle.
// Threads: none, mesh_pieces.cpp and surfaces.cpp have the same runs
#include <gtest/gtest.h>

#include <span>
#include <tuple>

#include "surfaces.hpp"

namespace isoweave::testing::mesh_in_memory_test {
namespace {

void expect_same(const MeshInMemory& found, const MemorySink& expected) {
  const TriangleMesh mesh = found.copy();
  EXPECT_EQ(mesh.vertices, expected.mesh.vertices);
  EXPECT_EQ(mesh.normals, expected.mesh.normals);
  EXPECT_EQ(mesh.values, expected.mesh.values);
  EXPECT_EQ(mesh.triangles, expected.mesh.triangles);
  EXPECT_GT(mesh.triangles.size(), 100U);
}

template <class Sink>
std::vector<MeshSink*> pointers(std::vector<Sink>& sinks) {
  std::vector<MeshSink*> list;
  for (Sink& sink : sinks) list.push_back(&sink);
  return list;
}

class InMemory : public ::testing::TestWithParam<std::tuple<int, std::string, bool>> {
 protected:
  InMemory() {
    control_.threads = std::get<0>(GetParam());
    volume_.kind = std::get<1>(GetParam());
    volume_.dims = {21, 18, 25};
    volume_.spacing = {0.7, 0.9, 1.6};
    volume_.seed = 5;
    options_.iso = suggested_iso(volume_.kind, volume_.type);
    control_.slab = 6;
    options_.normals = Normals::kGradient;
  }

  std::unique_ptr<SliceSource> source() const {
    const auto generated = generate_volume(volume_);
    std::vector<float> samples(static_cast<std::size_t>(generated->info().slice_samples() * volume_.dims[2]));
    generated->read(0, volume_.dims[2], std::as_writable_bytes(std::span(samples)));
    auto volume = std::make_unique<MemoryVolume>(volume_.dims, samples);
    volume->info().geometry = generated->info().geometry;
    if (std::get<2>(GetParam())) volume->info().geometry.direction = {-1, 0, 0, 0, 1, 0, 0, 0, 1};  // mirrors
    return volume;
  }

  RunControl control_;
  GenerateOptions volume_;
  MeshOptions options_;
};

TEST_P(InMemory, Extracted) {
  const auto values = source();
  options_.error = Length::voxels(0);
  options_.values = borrow(*values);
  MeshInMemory found;
  MemorySink expected;
  const MeshReport report = mesh_volume(*source(), found, options_, control_);
  EXPECT_EQ(mesh_volume(*source(), expected, options_, control_).digest, report.digest);
  expect_same(found, expected);
}

TEST_P(InMemory, SimplifiedInLevels) {
  const auto values = source();
  options_.error = Length::voxels(0.3);
  options_.levels = {{0.05, true}, {0.1, true}};
  options_.values = borrow(*values);
  std::vector<MeshInMemory> found(3);
  std::vector<MemorySink> expected(3);
  mesh_volume(*source(), pointers(found), options_, control_);
  mesh_volume(*source(), pointers(expected), options_, control_);
  for (std::size_t level = 0; level < 3; ++level) expect_same(found[level], expected[level]);
}

TEST_P(InMemory, FromAMesh) {
  options_.error = Length::voxels(0);
  MemorySink full;
  mesh_volume(*source(), full, options_, control_);
  MeshInMemory found;
  MemorySink expected;
  const SimplifyOptions options{.error = Length::units(0.2)};
  control_.piece = 700;
  simplify_mesh(full.mesh, found, options, control_);
  simplify_mesh(full.mesh, expected, options, control_);
  expect_same(found, expected);
}

INSTANTIATE_TEST_SUITE_P(Sinks, InMemory,
                         ::testing::Combine(::testing::Values(1, 3), ::testing::Values("gyroid", "noise"),
                                            ::testing::Bool()));

}  // namespace
}  // namespace isoweave::testing::mesh_in_memory_test
