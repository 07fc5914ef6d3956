// Meshes in gzip and out of pipes: the same as from the plain file, and one line where the packing is damaged.
// Threads: none, the thread here only feeds a pipe
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "foreign_meshes.hpp"
#include "isoweave/measure.hpp"
#include "meshes.hpp"
#include "volume_helpers.hpp"

namespace isoweave::testing::read_mesh_packed_test {
namespace {

using foreign::contains;
using mesh_files::failure;
using mesh_files::parse;
using testing::gzipped;

const std::string kLegacy =
    "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 "
    "2\n";
const std::string kStlText =
    "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid "
    "s\n";

// Every format by the name of a file.
std::vector<std::pair<std::string, std::string>> all_files() {
  const files::Folder folder;
  std::vector<std::pair<std::string, std::string>> all{
      {"b.vtk", kLegacy}, {"b.stl", kStlText}, {"b.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"}};
  for (const std::string name : meshes::kFileNames) {
    write_mesh(folder / name, meshes::tetrahedron());
    all.emplace_back(name, files::read_bytes(folder / name));
  }
  return all;
}

TEST(ReadMeshPacked, EveryFormatIsReadInGzip) {
  for (const auto& [name, content] : all_files()) {
    const TriangleMesh plain = parse(name, content);
    const std::string packed = gzipped(content);
    // The content tells, and the name before ".gz" where it does not.
    for (const std::string& as : {name + ".gz", name + ".GZ", name}) {
      const TriangleMesh mesh = parse(as, packed);
      EXPECT_EQ(mesh.triangles, plain.triangles) << as;
      EXPECT_EQ(mesh.vertices, plain.vertices) << as;
      EXPECT_EQ(mesh.notes, plain.notes) << as;
    }
  }
  EXPECT_EQ(parse("a", gzipped(kStlText)).triangles.size(), 1U);
  // OBJ whose first statement is none that is known: only the name tells.
  const std::string odd = "xyz\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(parse("a.obj.gz", gzipped(odd)).triangles.size(), 1U);
  EXPECT_TRUE(contains(failure("a.gz", gzipped(odd)), "expected PLY, STL")) << failure("a.gz", gzipped(odd));
}

// Members one after another, as pigz and bgzip write them.
TEST(ReadMeshPacked, SeveralMembersAreOneFile) {
  const std::string text = kStlText;
  const std::size_t half = text.size() / 2;
  EXPECT_EQ(parse("a.stl.gz", gzipped(text.substr(0, half)) + gzipped(text.substr(half))).triangles.size(), 1U);
}

TEST(ReadMeshPacked, DamageIsToldInOneLine) {
  const std::string packed = gzipped(kLegacy);
  EXPECT_EQ(failure("a.vtk.gz", packed.substr(0, packed.size() - 1)),
            "expected a complete compressed stream, found its end missing");
  EXPECT_EQ(failure("a.vtk.gz", packed.substr(0, packed.size() / 2)),
            "expected a complete compressed stream, found its end missing");
  std::string damaged = packed;
  damaged[damaged.size() - 6] ^= 1;  // its sum
  EXPECT_TRUE(contains(failure("a.vtk.gz", damaged), "the compressed data are corrupt: incorrect data check"));
  EXPECT_EQ(failure("a.ply.gz", gzipped("")), "expected a mesh file, found an empty file in gzip");
  EXPECT_EQ(failure("a.ply.gz", gzipped("plx")), "expected the line 'ply' at the beginning, found 'plx'");
  EXPECT_EQ(failure("a.ply", ""), "expected a mesh file, found an empty file");
  foreign::expect_damage_is_safe("a.vtk.gz", packed);
}

TEST(ReadMeshPacked, PipesAreRead) {
  const files::Folder folder;
  const std::string pipe = folder / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const auto read = [&](const std::string& content) {
    std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << content; });
    const TriangleMesh mesh = read_mesh(pipe);
    writer.join();
    return mesh;
  };
  for (const auto& [name, content] : all_files()) {
    EXPECT_EQ(read(content).vertices, parse(name, content).vertices) << name;
    EXPECT_EQ(read(gzipped(content)).vertices, parse(name, content).vertices) << name;
  }
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_packed_test
