// Several levels of detail in one GLB file.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "files.hpp"
#include "glb_helpers.hpp"
#include "isoweave/error.hpp"
#include "isoweave/mesh.hpp"
#include "meshes.hpp"

namespace isoweave::testing::write_mesh_levels_test {
namespace {

using glb_files::append;
using glb_files::Glb;
using glb_files::Json;

std::vector<TriangleMesh> levels() {
  std::vector<TriangleMesh> levels{meshes::grid(12), meshes::cube(), meshes::tetrahedron()};
  for (TriangleMesh& mesh : levels) mesh.normals.assign(mesh.vertices.size(), {0, 0.6F, -0.8F});
  return levels;
}

std::vector<MeshFileOptions> options_of(std::size_t count) {
  std::vector<MeshFileOptions> options(count);
  for (std::size_t n = 0; n < count; ++n) {
    options[n].normals = true;
    options[n].comments = {"level " + std::to_string(n)};
    options[n].unit = "mm";
  }
  return options;
}

void expect_levels(const std::string& path) {
  const Glb glb(path);
  EXPECT_EQ(glb.scene["extensionsUsed"].dump(), R"(["MSFT_lod"])");
  EXPECT_FALSE(glb.scene.contains("extensionsRequired"));
  EXPECT_EQ(glb.scene["nodes"][0]["children"].dump(), "[1]");
  EXPECT_EQ(glb.scene["nodes"][1]["extensions"]["MSFT_lod"]["ids"].dump(), "[2,3]");
  const std::vector<TriangleMesh> expected = levels();
  for (std::size_t n = 0; n < expected.size(); ++n) {
    const Json& node = glb.scene["nodes"][n + 1];
    EXPECT_EQ(node["extras"]["comments"][0], "level " + std::to_string(n));
    EXPECT_EQ(node["scale"], nlohmann::json({1e-3, 1e-3, 1e-3})) << "each level is as large by itself";
    EXPECT_TRUE(node.contains("rotation"));
    const Json& primitive = glb.scene["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
    EXPECT_EQ(glb.array<Point>(primitive["attributes"]["POSITION"]), expected[n].vertices);
    EXPECT_EQ(glb.array<Point>(primitive["attributes"]["NORMAL"]), expected[n].normals);
    EXPECT_EQ((glb.array<std::array<std::uint32_t, 3>>(primitive["indices"])), expected[n].triangles);
  }
  EXPECT_EQ(read_mesh(path).triangles, expected[0].triangles) << "the finest";
}

TEST(WriteLevels, AreMeshesOfOneFile) {
  const files::Folder folder;
  const std::vector<TriangleMesh> meshes = levels();
  const std::vector<MeshFileOptions> options = options_of(3);
  auto sinks = open_mesh_levels(folder / "a.glb", options);
  for (std::size_t part = 0; part < 300; part += 100) {
    for (const std::size_t n : {2U, 0U, 1U}) append(*sinks[n], meshes[n], part, part + 100);
  }
  for (const std::size_t n : {2U, 0U, 1U}) {
    EXPECT_FALSE(std::filesystem::exists(folder / "a.glb"));
    sinks[n]->finish();
    if (n != 1) sinks[n].reset();
  }
  expect_levels(folder / "a.glb");
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"a.glb"});
}

TEST(WriteLevels, NothingIsLeftWhereOneIsMissing) {
  const files::Folder folder;
  {
    const auto sinks = open_mesh_levels(folder / "a.glb", options_of(2));
    append(*sinks[0], levels()[0], 0, 300);
    append(*sinks[1], levels()[1], 0, 300);
    sinks[0]->finish();
    EXPECT_THROW(sinks[0]->finish(), std::logic_error);
  }
  EXPECT_TRUE(folder.entries().empty());
}

TEST(WriteLevels, GoOnFromTheirMarks) {
  const files::Folder folder;
  const std::vector<TriangleMesh> meshes = levels();
  std::vector<MeshFileOptions> options = options_of(3);
  for (std::size_t n = 0; n < 3; ++n) {
    options[n].parts = folder / ("parts" + std::to_string(n));
    std::filesystem::create_directory(options[n].parts);
  }
  {
    const auto sinks = open_mesh_levels(folder / "a.glb", options);
    for (std::size_t n = 0; n < 3; ++n) {
      append(*sinks[n], meshes[n], 0, 2);
      options[n].mark = sinks[n]->mark();
      append(*sinks[n], meshes[n], 2, 3);  // comes to nothing
    }
  }
  const auto sinks = open_mesh_levels(folder / "a.glb", options);
  for (std::size_t n = 0; n < 3; ++n) {
    append(*sinks[n], meshes[n], 2, 300);
    EXPECT_FALSE(std::filesystem::is_empty(options[0].parts)) << "until all are there";
    sinks[n]->finish();
  }
  expect_levels(folder / "a.glb");
  for (const auto& sink : sinks) sink->forget_marks();
  for (const MeshFileOptions& level : options) EXPECT_TRUE(std::filesystem::is_empty(level.parts));
}

TEST(WriteLevels, ThatHaveVanishedAreNodesWithoutMeshes) {
  const files::Folder folder;
  for (const std::size_t there : {0U, 1U}) {
    const auto sinks = open_mesh_levels(folder / "a.glb", options_of(2));
    if (there > 0) append(*sinks[0], levels()[0], 0, 300);
    for (const auto& sink : sinks) sink->finish();
    const Glb glb(folder / "a.glb");
    EXPECT_EQ(glb.scene.contains("meshes"), there > 0);
    EXPECT_EQ(read_mesh(folder / "a.glb").triangles.size(), there > 0 ? 288U : 0U);
    if (there > 0) {
      EXPECT_FALSE(glb.scene["nodes"][2].contains("mesh"));
    }
  }
}

TEST(WriteLevels, WrongUseIsRefused) {
  const files::Folder folder;
  for (const char* name : {"a.ply", "a.stl", "a.obj", "a.off", "a.vtp", "a.3mf", "a.precomputed", "a.doc"}) {
    EXPECT_THROW(open_mesh_levels(folder / name, options_of(2)), CannotWrite) << name;
  }
  EXPECT_THROW(open_mesh_levels(folder / "a.glb", {}), std::invalid_argument);
  std::vector<MeshFileOptions> options = options_of(2);
  options[1].normals = false;
  EXPECT_THROW(open_mesh_levels(folder / "a.glb", options), std::invalid_argument);
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace isoweave::testing::write_mesh_levels_test
