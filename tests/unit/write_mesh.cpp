// What the writers of PLY, STL and OBJ put on the disk, byte by byte, and what all writers refuse. Round trips through
// read_mesh are in read_mesh_*.cpp.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/mesh.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"
#include "meshes.hpp"

namespace isoweave::testing::write_mesh_test {
namespace {

const std::vector<Point> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<Triangle64> kOneTriangle{{0, 1, 2}};

void write_one_triangle(const std::string& path, const MeshFileOptions& options = {}) {
  const auto sink = open_mesh_file(path, options);
  sink->append(
      {.vertices = kCorners, .normals = options.normals ? kCorners : std::vector<Point>{}, .triangles = kOneTriangle});
  sink->finish();
}

TEST(WriteMesh, PlyHeaderSaysTheCountsAndTheSizeFollows) {
  const files::Folder folder;
  write_one_triangle(folder / "a.ply", {.normals = true, .comments = {"made by a\ntest"}});
  const std::string bytes = files::read_bytes(folder / "a.ply");
  const std::string expected =
      "ply\nformat binary_little_endian 1.0\ncomment made by a test\ncomment padding "
      "......................................\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\n"
      "element face 1\nproperty list uchar uint vertex_indices\nend_header\n";
  EXPECT_EQ(bytes.substr(0, expected.size()), expected);
  EXPECT_EQ(bytes.size(), expected.size() + 3 * 24 + 13);
  EXPECT_EQ(bytes.substr(bytes.size() - 13), std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13));
}

// The header has one length, whatever the counts: more digits take from the padding.
TEST(WriteMesh, PlyHeaderKeepsItsLengthAsCountsGrow) {
  const files::Folder folder;
  const auto header_bytes = [&](std::uint32_t n) {
    const TriangleMesh mesh = meshes::grid(n);
    const auto sink = open_mesh_file(folder / "a.ply");
    sink->append({.vertices = mesh.vertices});
    sink->finish();
    return files::read_bytes(folder / "a.ply").find("end_header");
  };
  EXPECT_EQ(header_bytes(1), header_bytes(40));
}

TEST(WriteMesh, StlHasCountNormalAndCorners) {
  const files::Folder folder;
  write_one_triangle(folder / "a.STL");
  const std::string bytes = files::read_bytes(folder / "a.STL");
  ASSERT_EQ(bytes.size(), 84U + 50U);
  EXPECT_NE(bytes.substr(0, 5), "solid");
  EXPECT_EQ(bytes.substr(80, 4), std::string("\1\0\0\0", 4));
  // Counter-clockwise in the plane z = 0: the normal is (0, 0, 1).
  EXPECT_EQ(bytes.substr(84, 12), std::string("\0\0\0\0\0\0\0\0\0\0\x80\x3f", 12));
  EXPECT_EQ(bytes.substr(96 + 12, 4), std::string("\0\0\x80\x3f", 4));
}

// Without area there is no direction; a NaN in the file would be worse than a zero.
TEST(WriteMesh, StlNormalOfATriangleWithoutAreaIsZero) {
  const files::Folder folder;
  const auto sink = open_mesh_file(folder / "a.stl");
  sink->append({.vertices = kCorners, .triangles = std::vector<Triangle64>{{0, 1, 1}}});
  sink->finish();
  EXPECT_EQ(files::read_bytes(folder / "a.stl").substr(84, 12), std::string(12, '\0'));
}

TEST(WriteMesh, ObjIsShortestText) {
  const files::Folder folder;
  const auto sink = open_mesh_file(folder / "a.obj", {.normals = false, .comments = {"hello"}});
  sink->append(
      {.vertices = std::vector<Point>{{0.1F, -0.0F, 1}, {1, 0, 0}, {0, 1e-10F, 0}}, .triangles = kOneTriangle});
  sink->finish();
  EXPECT_EQ(files::read_bytes(folder / "a.obj"), "# hello\nv 0.1 -0 1\nv 1 0 0\nv 0 1e-10 0\nf 1 2 3\n");
}

TEST(WriteMesh, ObjFacesNameNormals) {
  const files::Folder folder;
  write_one_triangle(folder / "a.obj", {.normals = true, .comments = {}});
  const std::string text = files::read_bytes(folder / "a.obj");
  EXPECT_NE(text.find("vn 1 0 0\n"), std::string::npos);
  EXPECT_NE(text.find("f 1//1 2//2 3//3\n"), std::string::npos);
}

TEST(WriteMesh, UnknownEndingIsAnError) {
  const files::Folder folder;
  for (const char* name : {"a.xyz", "a", "ply", "a.ply.gz", "b.stl/a", "a.ply/", "precomputed"}) {
    EXPECT_THROW(open_mesh_file(folder / name), CannotWrite) << name;
  }
  EXPECT_TRUE(folder.entries().empty());
}

TEST(WriteMesh, BadArgumentsAreRefused) {
  const files::Folder folder;
  for (const char* name : meshes::kFileNames) {
    const auto sink = open_mesh_file(folder / name);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(sink->append({.triangles = kOneTriangle}), std::invalid_argument) << "no vertex yet";
    EXPECT_THROW(sink->append({.vertices = std::vector<Point>{{0, nan, 0}}}), std::invalid_argument);
    EXPECT_THROW(sink->append({.vertices = kCorners, .normals = std::vector<Point>{{0, 0, 1}}}), std::invalid_argument);
    sink->append(
        {.vertices = kCorners, .triangles = kOneTriangle});  // refused arguments wrote nothing, so the mesh can go on
    sink->finish();
    EXPECT_THROW(sink->append({.vertices = kCorners}), std::logic_error) << "already finished";
  }
  const auto sink = open_mesh_file(folder / "n.ply", {.normals = true, .comments = {}});
  EXPECT_THROW(sink->append({.vertices = kCorners}), std::invalid_argument) << "normals were promised";
}

TEST(WriteMesh, CountsThatDoNotFitAreErrors) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
  EXPECT_NO_THROW(check_count_fits("a.ply", "vertices", kMost - 5, 5));
  EXPECT_THROW(check_count_fits("a.ply", "vertices", kMost - 5, 6), CannotWrite);
  EXPECT_THROW(check_count_fits("a.ply", "vertices", kMost + 1, 0), CannotWrite);
  EXPECT_THROW(check_count_fits("a.ply", "vertices", 1, ~std::uint64_t{0}), CannotWrite) << "the sum wraps around";
}

TEST(MeshFiles, SizesAreKnownBeforehandAndLimitsToo) {
  EXPECT_EQ(mesh_file_bytes("a.ply", 100, 200), 100U * 12 + 200U * 13);
  EXPECT_EQ(mesh_file_bytes("a.stl", 100, 200), 200U * 50);
  constexpr std::uint64_t kMany = std::uint64_t{1} << 33;
  EXPECT_THROW(mesh_file_bytes("a.ply", kMany, 1), CannotWrite);
  EXPECT_THROW(mesh_file_bytes("a.stl", 1, kMany), CannotWrite);
  EXPECT_GT(mesh_file_bytes("a.obj", kMany, kMany), kMany);
  EXPECT_GT(mesh_file_bytes("a.ply", 1, kMany), kMany) << "faces are not indices";
  EXPECT_THROW(mesh_file_bytes("a.xyz", 1, 1), CannotWrite);
}

}  // namespace
}  // namespace isoweave::testing::write_mesh_test
