// Named parts in one file: GLB and VTP.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "files.hpp"
#include "glb_helpers.hpp"
#include "isoweave/error.hpp"
#include "isoweave/mesh.hpp"
#include "meshes.hpp"

namespace isoweave::testing::write_mesh_parts_test {
namespace {

using glb_files::append;
using glb_files::Glb;
using glb_files::Json;

// A surface, one that is empty, and two more, so that a part that is missing shifts others.
std::vector<TriangleMesh> surfaces() {
  std::vector<TriangleMesh> meshes{meshes::cube(), {}, meshes::grid(40), meshes::tetrahedron()};
  for (TriangleMesh& mesh : meshes) mesh.normals.assign(mesh.vertices.size(), {0, 0.6F, -0.8F});
  return meshes;
}

constexpr std::array<std::string_view, 4> kNames{"iso 10", "<empty> & \"quoted\"",
                                                 "Gr\xc3\xb6\xc3\x9f"
                                                 "e \\ ]]> -->",
                                                 std::string_view("a\0b\xff\n", 5)};

std::vector<MeshPart> parts_of(bool normals) {
  std::vector<MeshPart> parts;
  for (const std::string_view name : kNames) {
    const auto n = static_cast<double>(parts.size());
    parts.push_back({std::string(name), {1, n / 4, 0.2, n == 3 ? 0.5 : 1}, {}});
    parts.back().options.normals = normals;
    parts.back().options.unit = "um";
    parts.back().options.space = "RAS";
    parts.back().options.comments = {"comment " + std::to_string(parts.size() - 1)};
  }
  return parts;
}

// Writes the surfaces as parts, in pieces that come in turns, the last part first.
void write(const std::string& path, const std::vector<TriangleMesh>& meshes, const std::vector<MeshPart>& parts) {
  const auto sinks = open_mesh_parts(path, parts);
  for (std::size_t first = 0; first < 4000; first += 1000) {
    for (std::size_t n = meshes.size(); n-- > 0;) {
      TriangleMesh mesh = meshes[n];
      if (!parts[n].options.normals) mesh.normals.clear();
      append(*sinks[n], mesh, first, first + 1000);
    }
  }
  for (std::size_t n = meshes.size(); n-- > 0;) {
    EXPECT_FALSE(std::filesystem::exists(path));
    sinks[n]->finish();
  }
}

// All surfaces one after another.
TriangleMesh all_of(const std::vector<TriangleMesh>& meshes) {
  TriangleMesh all;
  for (const TriangleMesh& mesh : meshes) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    all.normals.insert(all.normals.end(), mesh.normals.begin(), mesh.normals.end());
    for (const auto& [a, b, c] : mesh.triangles) all.triangles.push_back({first + a, first + b, first + c});
  }
  return all;
}

void expect_read_back(const std::string& path, bool normals) {
  const TriangleMesh expected = all_of(surfaces());
  const TriangleMesh found = read_mesh(path);
  EXPECT_EQ(found.vertices, expected.vertices);
  EXPECT_EQ(found.triangles, expected.triangles);
  EXPECT_EQ(found.normals, normals ? expected.normals : std::vector<Point>{});
  EXPECT_EQ(found.unit, "um");
  EXPECT_EQ(found.space, "RAS");
  EXPECT_FALSE(found.notes.empty()) << "names are not kept";
}

TEST(WriteParts, OfGlbAreNodesWithMeshesAndMaterials) {
  const files::Folder folder;
  const std::vector<TriangleMesh> meshes = surfaces();
  write(folder / "many parts.glb", meshes, parts_of(true));
  const Glb glb(folder / "many parts.glb");
  EXPECT_EQ(glb.scene["scenes"][0]["nodes"].dump(), "[0]");
  const Json& root = glb.scene["nodes"][0];
  EXPECT_EQ(root["name"], "many parts");
  EXPECT_EQ(root["scale"], Json({1e-6, 1e-6, 1e-6}));
  EXPECT_TRUE(root.contains("rotation"));
  EXPECT_EQ(root["children"].dump(), "[1,2,3,4]");
  EXPECT_EQ(glb.scene["meshes"].size(), 3U) << "glTF has no empty meshes";
  EXPECT_FALSE(glb.scene["nodes"][2].contains("mesh"));
  for (const std::size_t n : {0U, 2U, 3U}) {
    const Json& node = glb.scene["nodes"][n + 1];
    EXPECT_FALSE(node.contains("scale") || node.contains("rotation") || node.contains("translation"));
    EXPECT_EQ(node["extras"]["comments"].dump(), "[\"comment " + std::to_string(n) + "\"]");
    const Json& mesh = glb.scene["meshes"][node["mesh"].get<std::size_t>()];
    const Json& primitive = mesh["primitives"][0];
    const Json& material = glb.scene["materials"][primitive["material"].get<std::size_t>()];
    for (const Json& named : {node, mesh, material}) {
      EXPECT_EQ(named["name"], n == 3 ? std::string("a\0b\xef\xbf\xbd\n", 7) : std::string(kNames[n]));
    }
    EXPECT_EQ(material["pbrMetallicRoughness"]["metallicFactor"], 0);
    const Json& color = material["pbrMetallicRoughness"]["baseColorFactor"];
    EXPECT_EQ(color[0], 1);
    EXPECT_NEAR(color[2].get<double>(), 0.033105, 1e-6) << "0.2 of sRGB";
    EXPECT_EQ(color[3], n == 3 ? 0.5 : 1);
    EXPECT_EQ(material.value("alphaMode", "OPAQUE"), n == 3 ? "BLEND" : "OPAQUE");
    EXPECT_EQ(glb.array<Point>(primitive["attributes"]["POSITION"]), meshes[n].vertices);
    EXPECT_EQ(glb.array<Point>(primitive["attributes"]["NORMAL"]), meshes[n].normals);
    EXPECT_EQ((glb.array<std::array<std::uint32_t, 3>>(primitive["indices"])), meshes[n].triangles);
  }
  expect_read_back(folder / "many parts.glb", true);
  EXPECT_EQ(folder.entries(), std::vector<std::string>{"many parts.glb"});
}

TEST(WriteParts, OfVtpArePiecesThatReadAsOne) {
  const files::Folder folder;
  for (const bool normals : {false, true}) {
    const std::string path = folder / (normals ? "with.vtp" : "without.vtp");
    write(path, surfaces(), parts_of(normals));
    expect_read_back(path, normals);
  }
  const std::string text = files::read_bytes(folder / "with.vtp");
  for (const char* comment : {"<!-- comment 0 -->", "<!-- comment 3 -->"}) {
    EXPECT_NE(text.find(comment), std::string::npos) << comment;
  }
  EXPECT_NE(text.find("NumberOfTuples=\"4\" format=\"ascii\">105 115 111 32 49 48 0 60 "), std::string::npos) << text;
}

TEST(WriteParts, ShareOneOffset) {
  const files::Folder folder;
  std::vector<MeshPart> parts = parts_of(false);
  for (MeshPart& part : parts) part.options.offset = {5e6, -4e6, 1.5};
  write(folder / "a.glb", surfaces(), parts);
  const Glb glb(folder / "a.glb");
  EXPECT_EQ(glb.scene["nodes"][0]["children"].dump(), "[1]");
  EXPECT_EQ(glb.scene["nodes"][1]["translation"], Json({5e6, -4e6, 1.5}));
  EXPECT_EQ(glb.scene["nodes"][1]["children"].dump(), "[2,3,4,5]");
  write(folder / "a.vtp", surfaces(), parts);
  const TriangleMesh expected = all_of(surfaces());
  for (const char* name : {"a.glb", "a.vtp"}) {
    const TriangleMesh found = read_mesh(folder / name);
    ASSERT_EQ(found.vertices.size(), expected.vertices.size());
    EXPECT_EQ(found.triangles, expected.triangles);
    for (std::size_t v = 0; v < expected.vertices.size(); ++v) {
      EXPECT_EQ(found.offset[0] + double{found.vertices[v][0]}, 5e6 + double{expected.vertices[v][0]}) << name;
    }
  }
}

TEST(WriteParts, ThatAreAllEmptyAreAnEmptyFile) {
  const files::Folder folder;
  for (const char* name : {"a.glb", "a.vtp"}) {
    const auto sinks = open_mesh_parts(folder / name, std::vector<MeshPart>(2));
    for (const auto& sink : sinks) sink->finish();
    EXPECT_TRUE(read_mesh(folder / name).vertices.empty()) << name;
  }
}

TEST(WriteParts, NothingIsLeftWhereOneIsMissing) {
  const files::Folder folder;
  for (const char* name : {"a.glb", "a.vtp"}) {
    const auto sinks = open_mesh_parts(folder / name, parts_of(true));
    for (std::size_t n = 0; n < 4; ++n) append(*sinks[n], surfaces()[n], 0, 4000);
    for (const std::size_t n : {3U, 1U, 0U}) sinks[n]->finish();
    EXPECT_THROW(sinks[0]->finish(), std::logic_error);
  }
  EXPECT_TRUE(folder.entries().empty());
}

TEST(WriteParts, WrongUseIsRefused) {
  const files::Folder folder;
  for (const char* name : {"a.ply", "a.stl", "a.obj", "a.off", "a.3mf", "a.precomputed", "a.txt"}) {
    EXPECT_THROW(open_mesh_parts(folder / name, parts_of(false)), CannotWrite) << name;
  }
  EXPECT_THROW(open_mesh_parts(folder / "a.glb", {}), std::invalid_argument);
  const auto refused = [&](const auto& change) {
    std::vector<MeshPart> parts = parts_of(false);
    change(parts[2]);
    EXPECT_THROW(open_mesh_parts(folder / "a.glb", parts), std::invalid_argument);
  };
  refused([](MeshPart& part) { part.options.normals = true; });
  refused([](MeshPart& part) { part.options.offset[1] = 1; });
  refused([](MeshPart& part) { part.options.compress = true; });
  refused([](MeshPart& part) { part.color[3] = 1.01; });
  refused([](MeshPart& part) { part.color[0] = std::nan(""); });
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace isoweave::testing::write_mesh_parts_test
