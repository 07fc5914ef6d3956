// Damaged files: whatever the damage, a mesh with indices in range or BadInput. Run under sanitizers.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "meshes.hpp"

namespace isoweave::testing::read_mesh_damaged_test {
namespace {

struct Sample {
  const char* name;
  std::string bytes;
};

std::string written_by_us(const std::string& name) {
  const files::Folder folder;
  const TriangleMesh mesh = meshes::tetrahedron();
  const auto sink = open_mesh_file(folder / name, {.normals = true, .comments = {"sample"}});
  std::vector<std::array<std::uint64_t, 3>> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  sink->append({.vertices = mesh.vertices, .normals = mesh.vertices, .triangles = triangles});
  sink->finish();
  return files::read_bytes(folder / name);
}

std::vector<Sample> samples() {
  std::vector<Sample> all;
  for (const char* name : meshes::kFileNames) all.push_back({name, written_by_us(name)});
  const std::vector<Sample> others{
      {"b.off", "OFF # one line\n4 2 0\n0 0 0\n1 0 0\n\n0 1 0\n0 0 1\n4 0 1 2 3 255 0 0\n3 1 2 3\n"},
      {"b.ply",
       "ply\nformat ascii 1.0\nelement extra 1\nproperty list uchar int n\nelement vertex 4\nproperty float x\n"
       "property double y\nproperty int z\nproperty list uchar short w\nelement face 2\n"
       "property list uchar int vertex_indices\nend_header\n2 5 6\n0 0 0 1 1\n1 0 0 0\n0 1 0 0\n0 0 1 2 3 4\n"
       "4 0 1 2 3\n3 1 2 3\n"},
      {"b.stl",
       "solid name\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
       "endsolid name\n"},
      {"c.ply",
       "\xEF\xBB\xBFply\rformat ascii 1.0\relement vertex 4\rproperty float x\rproperty float y\rproperty float z\r"
       "property float intensity\relement tristrips 1\rproperty list int int64 vertex_indices\rend_header\r"
       "0 0 0 1\r1 0 0 2\r0 1 0 3\r0 0 1 4\r8 0 1 2 3 -1 3 2 1\r"},
      {"c.stl",
       "\n SOLID name\nFACET NORMAL nan nan nan OUTER LOOP VERTEX 0 0 0 VERTEX 1D0 0 0\nVERTEX 0 1 0\nEND LOOP "
       "END FACET\nEND SOLID\n"},
      {"c.off", "STCNOFF4 2\n0 0 0 0 0 1\n1 0 0 1 1 1 1\n0 1\n0 7\n0 0 1\n3 0 1 2 7\n4 0 1\n3 2 7\n"},
      {"c.obj", "# c\\\nV 0 0 0 # c\nv 1 0 0 1 1 1\nv 0 \\\n1 0\nl 1 2\np 1\nf 1 2\nsurf 0 1 0 1 1\nfo 1 2 3\n"},
      {"d.obj", "v 0 0 0\nv 2 1 0\nv 4 0 0\nv 2 4 0\nv 1 1 0\nf 1 2 3 4\nf 1 2 3 4 5\nf 5 1 3 2 4\n"},
      {"b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -1 -2 -3\n"}};
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

// True when it parsed; the mesh must then be one that can be used without further checks.
bool parses(const std::string& path, const std::string& bytes) {
  files::write_bytes(path, bytes);
  TriangleMesh mesh;
  try {
    mesh = read_mesh(path);
  } catch (const BadInput& error) {
    const std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return false;
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) EXPECT_LT(index, mesh.vertices.size());
  }
  for (const Point& p : mesh.vertices) EXPECT_TRUE(std::isfinite(p[0] + p[1] + p[2]));
  EXPECT_TRUE(mesh.normals.empty() || mesh.normals.size() == mesh.vertices.size());
  return true;
}

TEST(ReadMeshDamaged, UndamagedSamplesParse) {
  const files::Folder folder;
  for (const Sample& sample : samples()) EXPECT_TRUE(parses(folder / sample.name, sample.bytes)) << sample.name;
}

// All but OBJ say how much there must be: no proper prefix may pass for the whole, but for a last line end.
TEST(ReadMeshDamaged, EveryPrefixIsRefused) {
  const files::Folder folder;
  for (const Sample& sample : samples()) {
    const bool counted = std::string(sample.name).find(".obj") == std::string::npos;
    for (std::size_t length = 0; length < sample.bytes.size(); ++length) {
      const bool parsed = parses(folder / sample.name, sample.bytes.substr(0, length));
      // The text formats end in words and digits that are not counted: "3\n", "endsolid name\n".
      const bool in_last_words = sample.bytes.find('\0') == std::string::npos && length + 8 > sample.bytes.size();
      if (counted && !in_last_words) {
        EXPECT_FALSE(parsed) << sample.name << " cut at " << length;
      }
    }
  }
}

TEST(ReadMeshDamaged, RandomByteFlips) {
  const files::Folder folder;
  std::mt19937_64 random(20240607);
  std::size_t refused = 0;
  for (const Sample& sample : samples()) {
    for (int round = 0; round < 600; ++round) {
      std::string bytes = sample.bytes;
      for (std::uint64_t flips = 1 + random() % 4; flips > 0; --flips) {
        bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
      }
      if (!parses(folder / sample.name, bytes)) ++refused;
    }
  }
  EXPECT_GT(refused, 1000U) << "the damage must reach the checks";
}

// Numbers and separators put in the place of others reach deeper than random bytes do in text.
TEST(ReadMeshDamaged, RandomWordsInText) {
  const files::Folder folder;
  std::mt19937_64 random(7);
  const std::vector<std::string> words{
      "-1",   "0",      "99999999999999999999", "nan", "1e999",   "/",          "//",   "\\\n", "\n",
      "list", "vertex", "element face 3\n",     "f",   "endloop", "4294967295", "uchar"};
  for (const Sample& sample : samples()) {
    for (int round = 0; round < 600; ++round) {
      std::string bytes = sample.bytes;
      const std::string& word = words[random() % words.size()];
      bytes.replace(random() % bytes.size(), random() % 4, word);
      parses(folder / sample.name, bytes);
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_damaged_test
