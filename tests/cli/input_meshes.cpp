// Meshes of other programs: what is said of them, welding, values.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.hpp"

namespace isoweave::testing::cli_input_meshes_test {
namespace {

using Json = nlohmann::json;
using program::Result;
using program::run;

Result succeed(const files::Folder& folder, const std::vector<std::string>& arguments) {
  const Result result = run(folder.path(), arguments);
  EXPECT_EQ(result.code, 0) << result.err;
  return result;
}

// A square plate of 12 x 12 small squares as OBJ text: `more` behind each vertex; its right half has vertices of its
// own.
std::string plate_in_halves(const std::string& more = "") {
  std::string text;
  for (int half = 0; half < 2; ++half) {
    for (int j = 0; j <= 12; ++j) {
      for (int i = 0; i <= 6; ++i) {
        text += "v " + std::to_string(6 * half + i) + " " + std::to_string(j) + " 0" + more + "\n";
      }
    }
  }
  for (int half = 0; half < 2; ++half) {
    for (int j = 0; j < 12; ++j) {
      for (int i = 0; i < 6; ++i) {
        const int v = 1 + half * 91 + j * 7 + i;
        text += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " + std::to_string(v + 8) + " " +
                std::to_string(v + 7) + "\n";
      }
    }
  }
  return text;
}

TEST(CliInputMeshes, SeamsAreToldAndWelded) {
  const files::Folder folder;
  files::write_bytes(folder / "a.obj", plate_in_halves());
  const std::string warning =
      "a.obj: 24 border edges lie on others: vertices are doubled at seams, which --weld closes";
  for (const std::vector<std::string>& verb : std::vector<std::vector<std::string>>{
           {"check", "a.obj"}, {"simplify", "a.obj", "-o", "b.ply", "--error", "0.1", "--report", "b.json"}}) {
    std::vector<std::string> arguments = verb;
    EXPECT_NE(succeed(folder, arguments).err.find("isoweave: warning: " + warning), std::string::npos);
    arguments.emplace_back("--weld");
    const Result welded = succeed(folder, arguments);
    EXPECT_EQ(welded.err.find("border edges lie on"), std::string::npos) << welded.err;
    EXPECT_NE(welded.err.find("a.obj: 13 vertices welded to others"), std::string::npos) << welded.err;
  }
  EXPECT_EQ(Json::parse(files::read_bytes(folder / "b.json"))["input"]["welded"], 13);
  const Json apart = Json::parse(succeed(folder, {"check", "a.obj", "--json"}).out);
  EXPECT_EQ(apart["seam_edges"], 24);
  EXPECT_EQ(apart["components"], 2);
  const Json joined = Json::parse(succeed(folder, {"check", "a.obj", "--json", "--weld"}).out);
  EXPECT_EQ(joined["welded"], 13);
  EXPECT_EQ(joined["components"], 1);
  EXPECT_EQ(joined["open_edges"], 48);
  EXPECT_EQ(joined["digest"], apart["digest"]) << "the same triangles";
  EXPECT_LE(Json::parse(succeed(folder, {"check", "b.ply", "--json"}).out)["triangles"], 4) << "nothing holds the seam";
}

TEST(CliInputMeshes, ClosedMeshesHaveNoSeams) {
  const files::Folder folder;
  // Two tetrahedra that touch along an edge, at which each has vertices of its own.
  files::write_bytes(folder / "a.obj",
                     "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"
                     "v 0 0 0\nv 1 0 0\nv 0 -1 0\nv 0 0 -1\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 7 5 8\n");
  EXPECT_EQ(succeed(folder, {"check", "a.obj"}).err, "");
  const std::string said = succeed(folder, {"simplify", "a.obj", "-o", "b.ply", "--error", "0"}).err;
  EXPECT_EQ(said.find("warning"), std::string::npos) << said;
}

TEST(CliInputMeshes, WhatIsNotKeptIsTold) {
  const files::Folder folder;
  files::write_bytes(folder / "a.obj", plate_in_halves(" 1 0.5 0") + "usemtl wood\nl 1 2\n");
  const std::string first = "isoweave: warning: a.obj: not kept: colours of vertices, materials\n";
  const std::string second = "isoweave: warning: a.obj: left out: 1 lines\n";
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{"simplify", "a.obj", "-o", "b.ply", "--error", "0.1"},
                                             {"check", "a.obj"},
                                             {"compare", "a.obj", "a.obj", "--samples", "10"},
                                             {"render", "a.obj", "-o", "a.png", "--size", "16x16"}}) {
    const Result result = run(folder.path(), arguments);
    if (result.code != 0 && arguments[0] == "render") continue;  // a build that makes no pictures
    EXPECT_NE(result.err.find(first), std::string::npos) << arguments[0] << result.err;
    EXPECT_NE(result.err.find(second), std::string::npos) << arguments[0] << result.err;
  }
  const Json check = Json::parse(succeed(folder, {"check", "a.obj", "--json"}).out);
  EXPECT_EQ(check["warnings"][0], "a.obj: not kept: colours of vertices, materials");
  EXPECT_EQ(succeed(folder, {"simplify", "a.obj", "-o", "b.ply", "--error", "0.1", "--quiet"}).err, "");
}

// A plate whose values are 3, and another one 100 further along x, of 7.
std::string plates_with_values(bool with_values) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 338\nproperty float x\nproperty float y\nproperty float z\n";
  if (with_values) text += "property double temperature\n";
  text += "element face 288\nproperty list uchar int vertex_indices\nend_header\n";
  for (int v = 0; v < 338; ++v) {
    const int x = v / 169 * 100 + v % 13;
    text += std::to_string(x) + " " + std::to_string(v % 169 / 13) + " 0";
    text += !with_values ? "\n" : x < 50 ? " 3\n" : " 7\n";
  }
  for (int face = 0; face < 288; ++face) {
    const int v = face / 144 * 169 + face % 144 / 12 * 13 + face % 12;
    text += "4";
    for (const int corner : {v, v + 1, v + 14, v + 13}) text += " " + std::to_string(corner);
    text += "\n";
  }
  return text;
}

// x, y, z and the value of each vertex of a binary PLY file.
std::vector<std::array<float, 4>> vertices_with_values(const std::string& path) {
  const std::string bytes = files::read_bytes(path);
  EXPECT_NE(bytes.find("property float z\nproperty float quality\nelement"), std::string::npos);
  const std::size_t at = bytes.find("element vertex ") + std::strlen("element vertex ");
  std::vector<std::array<float, 4>> vertices(std::stoul(bytes.substr(at)));
  std::memcpy(vertices.data(), bytes.data() + bytes.find("end_header\n") + std::strlen("end_header\n"),
              vertices.size() * sizeof(vertices[0]));
  return vertices;
}

TEST(CliInputMeshes, ValuesAreKeptWhereThereIsAPlaceForThem) {
  const files::Folder folder;
  files::write_bytes(folder / "a.ply", plates_with_values(true));
  const Result kept = succeed(folder, {"simplify", "a.ply", "-o", "b.ply", "--error", "0.1", "--report", "b.json"});
  EXPECT_NE(kept.err.find("a.ply: the values at its vertices are the property 'temperature'"), std::string::npos);
  const auto vertices = vertices_with_values(folder / "b.ply");
  EXPECT_LT(vertices.size(), 20U);
  for (const auto& [x, y, z, value] : vertices) EXPECT_EQ(value, x < 50 ? 3 : 7) << x << " " << y << " " << z;
  const std::string obj = succeed(folder, {"simplify", "a.ply", "-o", "b.obj", "--error", "0.1"}).err;
  EXPECT_NE(obj.find("warning: a.ply: the values at its vertices are not kept"), std::string::npos) << obj;
  files::write_bytes(folder / "plain.ply", plates_with_values(false));
  succeed(folder, {"simplify", "plain.ply", "-o", "c.ply", "--error", "0.1", "--report", "c.json"});
  EXPECT_EQ(Json::parse(files::read_bytes(folder / "b.json"))["digest"],
            Json::parse(files::read_bytes(folder / "c.json"))["digest"])
      << "values change nothing else";
}

TEST(CliInputMeshes, CloudsOfPointsAreNoSurface) {
  const files::Folder folder;
  files::write_bytes(folder / "a.obj", "v 0 0 0\nv 1 0 0\n");
  const std::string warning = "a.obj: has no triangles, but 2 vertices: a cloud of points";
  EXPECT_NE(succeed(folder, {"check", "a.obj"}).err.find(warning), std::string::npos);
  const std::vector<std::string> simplify{"simplify", "a.obj", "-o", "b.ply", "--error", "1"};
  program::expect_failed(run(folder.path(), simplify), 3, warning);
  std::vector<std::string> allowed = simplify;
  allowed.emplace_back("--allow-empty");
  EXPECT_NE(succeed(folder, allowed).err.find(warning), std::string::npos);
  const Result compared = run(folder.path(), {"compare", "a.obj", "a.obj"});
  EXPECT_EQ(compared.code, 3);
  EXPECT_NE(compared.err.find("expected a mesh with triangles"), std::string::npos);
}

// A scene whose data are in a file beside it, which only those who trust it read.
TEST(CliInputMeshes, FilesThatAMeshNamesAreReadUnlessTheyMustNot) {
  const files::Folder folder;
  files::write_bytes(
      folder / "a.gltf",
      R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,)"
      R"("byteLength":36}],"buffers":[{"byteLength":36,"uri":"a.bin"}]})");
  const std::string one("\0\0\x80?", 4), nought(4, '\0');
  files::write_bytes(folder / "a.bin", nought + nought + nought + one + nought + nought + nought + one + nought);
  for (std::vector<std::string> arguments :
       std::vector<std::vector<std::string>>{{"check", "a.gltf"},
                                             {"simplify", "a.gltf", "-o", "o.ply", "--error", "0"},
                                             {"compare", "a.gltf", "a.gltf", "--samples", "10"},
                                             {"render", "a.gltf", "-o", "o.png", "--size", "16x16"},
                                             {"view", "a.gltf", "-o", "o.html"}}) {
    const bool may_lack = arguments[0] == "render" || arguments[0] == "view";
    const Result read = run(folder.path(), arguments);
    if (may_lack && read.code != 0 && read.err.find("build") != std::string::npos) continue;
    EXPECT_EQ(read.code, 0) << arguments[0] << read.err;
    for (const char* written : {"o.ply", "o.png", "o.html"}) std::filesystem::remove(folder / written);
    arguments.emplace_back("--no-external");
    program::expect_failed(run(folder.path(), arguments), 3, "a file that names no other, as --no-external asks");
    EXPECT_EQ(program::listing(folder), (std::vector<std::string>{"a.bin", "a.gltf"})) << arguments[0];
  }
}

}  // namespace
}  // namespace isoweave::testing::cli_input_meshes_test
