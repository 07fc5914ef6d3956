// Files as other programs write them, and round trips of our own.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "mesh_file_helpers.hpp"
#include "meshes.hpp"

namespace isoweave::testing::read_mesh_formats_test {
namespace {

using meshes::Triangle;
using Triangles = std::vector<Triangle>;

using mesh_files::failure;
using mesh_files::parse;
using mesh_files::raw;
using mesh_files::raw_point;

std::vector<std::uint32_t> bits(const std::vector<Point>& points) {
  std::vector<std::uint32_t> all;
  for (const Point& point : points) {
    for (const float coordinate : point) all.push_back(std::bit_cast<std::uint32_t>(coordinate));
  }
  return all;
}

TriangleMesh write_and_read(const TriangleMesh& mesh, const std::string& name) {
  const files::Folder folder;
  const auto sink = open_mesh_file(folder / name, {.normals = !mesh.normals.empty(), .comments = {"a comment"}});
  std::vector<std::array<std::uint64_t, 3>> triangles;
  for (const Triangle& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  // In two pieces, the first with what its one triangle needs, to mix vertices and faces.
  const std::size_t cut = std::max({triangles[0][0], triangles[0][1], triangles[0][2]}) + 1;
  const std::span<const Point> vertices(mesh.vertices);
  const std::span<const Point> normals(mesh.normals);
  const std::size_t normal_cut = normals.empty() ? 0 : cut;
  sink->append({.vertices = vertices.first(cut),
                .normals = normals.first(normal_cut),
                .triangles = std::span(triangles).first(1)});
  sink->append({.vertices = vertices.subspan(cut),
                .normals = normals.subspan(normal_cut),
                .triangles = std::span(triangles).subspan(1)});
  sink->finish();
  return read_mesh(folder / name);
}

// Coordinates whose bits a careless text format loses.
TriangleMesh awkward_cube() {
  TriangleMesh mesh = meshes::cube();
  mesh.vertices[0] = {0.1F, 1.0F / 3, -0.0F};
  mesh.vertices[1] = {1e-45F, 3.4028235e38F, 1.17549435e-38F};
  mesh.vertices[2] = {16777217.0F, 123456.789F, -2.5e-20F};
  return mesh;
}

TEST(ReadMesh, RoundTripsKeepEveryBit) {
  for (const std::string name : {"a.ply", "a.obj", "a.off", "a.vtp", "a.glb", "a.3mf"}) {
    TriangleMesh mesh = awkward_cube();
    EXPECT_TRUE(write_and_read(mesh, name).normals.empty()) << name;
    mesh.normals.assign(8, {0, 0.6F, -0.8F});
    const TriangleMesh back = write_and_read(mesh, name);
    EXPECT_EQ(bits(back.vertices), bits(mesh.vertices)) << name;
    EXPECT_EQ(bits(back.normals), bits(name == "a.3mf" ? std::vector<Point>{} : mesh.normals)) << name;
    EXPECT_EQ(back.triangles, mesh.triangles) << name;
  }
}

// STL numbers vertices anew, so only the triangles themselves can be compared.
TEST(ReadMesh, StlRoundTripKeepsTrianglesAndWeldsCorners) {
  const TriangleMesh mesh = awkward_cube();
  const TriangleMesh back = write_and_read(mesh, "a.stl");
  EXPECT_EQ(back.vertices.size(), 8U);
  ASSERT_EQ(back.triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(back.vertices[back.triangles[t][c]], mesh.vertices[mesh.triangles[t][c]]);
    }
  }
}

TEST(ReadMesh, EmptyMeshesRoundTrip) {
  for (const char* name : meshes::kFileNames) {
    const files::Folder folder;
    open_mesh_file(folder / name, {.normals = false, .comments = {"nothing"}})->finish();
    const TriangleMesh mesh = read_mesh(folder / name);
    EXPECT_TRUE(mesh.vertices.empty() && mesh.triangles.empty()) << name;
  }
}

TEST(ReadMesh, MoreCornersThanTheWeldTableStartsWith) {
  const TriangleMesh grid = meshes::grid(50);
  EXPECT_EQ(write_and_read(grid, "a.stl").vertices.size(), grid.vertices.size());
}

// -0 and 0 are equal coordinates: two triangles that share the corner must still share it after reading.
TEST(ReadMesh, StlWeldsNegativeZero) {
  const std::string facet = "facet normal 0 0 0\nouter loop\n";
  const std::string end = "endloop\nendfacet\n";
  const TriangleMesh mesh =
      parse("a.stl", "solid x\n" + facet + "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n" + end + facet +
                         "vertex -0 -0.0 0\nvertex 0 1 0\nvertex -1 0 0\n" + end + "endsolid x\n");
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}}));
}

TEST(ReadMesh, StlAsciiInAnyCaseAndLayout) {
  const TriangleMesh mesh =
      parse("a.stl",
            "solid\r\n  FACET NORMAL 0 0 1\r\n\r\n\tOuter Loop\r\n vertex 1e0 +0 0\r\n vertex 0 1. 0\r\n vertex 0 0 "
            ".5\r\n endloop\r\n endfacet\r\nendsolid\r\nsolid second facet\nendsolid");
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{1, 0, 0}, {0, 1, 0}, {0, 0, 0.5F}}));
}

// Some programs begin binary files with "solid" too; the length tells.
TEST(ReadMesh, StlBinaryThatBeginsWithSolid) {
  std::string bytes = "solid model";
  bytes.resize(80, ' ');
  bytes += raw(std::uint32_t{1}) + std::string(12, '\0');
  for (const float f : {0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F}) bytes += raw(f);
  bytes += std::string(2, '\0');
  EXPECT_EQ(parse("a.stl", bytes).triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(parse("name-without-ending", bytes).triangles.size(), 1U) << "told by content";
}

TEST(ReadMesh, PlyAsciiWithAnyOrderTypesAndExtras) {
  const TriangleMesh mesh = parse("a.ply",
                                  "ply\nformat ascii 1.0\ncomment x\nobj_info y\n"
                                  "element camera 2\nproperty float view\nproperty list uchar int marks\n"
                                  "element vertex 4\nproperty uchar red\nproperty double z\nproperty float y\n"
                                  "property list uchar float weights\nproperty short x\n"
                                  "element face 2\nproperty list uchar int vertex_index\nproperty uchar flags\n"
                                  "element material 1\nproperty int id\nend_header\n"
                                  "0.5 2 7 8\n0.5 0\n"
                                  "255 3 2 1 0.5 1\n255 0 0 0 10\n255 1 1 0 20\n255 2 2 0 -30\n"
                                  "4 0 1 2 3 9\n3 3 2 1 9\n42");
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{1, 2, 3}, {10, 0, 0}, {20, 1, 1}, {-30, 2, 2}}));
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}})) << "the square is fanned";
}

TEST(ReadMesh, PlyBinaryInBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\r\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\r\nelement skipped 2\r\nproperty ushort a\r\nproperty char b\r\n"
                        "element vertex 3\r\nproperty double x\r\nproperty float y\r\nproperty int z\r\n"
                        "property list uchar ushort extra\r\nproperty float nx\r\nproperty float ny\r\nproperty float "
                        "nz\r\nelement face 1\r\nproperty list ushort ushort vertex_indices\r\nend_header\r\n";
    bytes += std::string(6, 'q');
    for (int v = 0; v < 3; ++v) {
      bytes += raw(0.25 * v, big) + raw(1.5F, big) + raw(-v, big);
      bytes += raw(std::uint8_t{2}) + std::string(4, 'q');
      bytes += raw(0.0F, big) + raw(0.0F, big) + raw(1.0F, big);
    }
    bytes += raw(std::uint16_t{3}, big);
    for (const std::uint16_t index : std::initializer_list<std::uint16_t>{2, 0, 1}) bytes += raw(index, big);
    const TriangleMesh mesh = parse("a.ply", bytes);
    EXPECT_EQ(mesh.vertices, (std::vector<Point>{{0, 1.5F, 0}, {0.25F, 1.5F, -1}, {0.5F, 1.5F, -2}}));
    EXPECT_EQ(mesh.normals, std::vector<Point>(3, {0, 0, 1}));
    EXPECT_EQ(mesh.triangles, (Triangles{{2, 0, 1}}));
  }
}

std::string ply_header(const std::string& vertices, const std::string& faces, const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string raw_face(const std::vector<std::int32_t>& corners) {
  std::string bytes = raw(static_cast<std::uint8_t>(corners.size()));
  for (const std::int32_t corner : corners) bytes += raw(corner);
  return bytes;
}

// Larger than what is read at a time.
TEST(ReadMesh, PlyOfTrianglesWithOtherPolygonsBetween) {
  constexpr std::int32_t kVertices = 100'000;
  constexpr std::int32_t kFaces = 99'990;
  std::string bytes = ply_header(std::to_string(kVertices), std::to_string(kFaces), "binary_little_endian");
  TriangleMesh expected;
  for (std::int32_t v = 0; v < kVertices; ++v) {
    const auto x = static_cast<float>(v);
    bytes += raw_point(x, -x, 0.5F);
    expected.vertices.push_back({x, -x, 0.5F});
  }
  for (std::int32_t f = 0; f < kFaces; ++f) {
    const bool is_square = f % 30'000 == 7;
    bytes += raw_face(is_square ? std::vector{f, f + 1, f + 2, f + 3} : std::vector{f, f + 1, f + 2});
    const auto first = static_cast<std::uint32_t>(f);
    expected.triangles.push_back({first, first + 1, first + 2});
    if (is_square) expected.triangles.push_back({first, first + 2, first + 3});
  }
  const TriangleMesh mesh = parse("a.ply", bytes);
  EXPECT_EQ(mesh.vertices, expected.vertices);
  EXPECT_EQ(mesh.triangles, expected.triangles);
}

TEST(ReadMesh, PlyBinaryDataThatAreWrong) {
  const std::string header = ply_header("3", "2", "binary_little_endian");
  const std::string points = raw_point(0, 0, 0) + raw_point(1, 0, 0) + raw_point(0, 1, 0);
  const std::string face = raw_face({0, 1, 2});
  EXPECT_EQ(parse("a.ply", header + points + face + face).triangles.size(), 2U);
  EXPECT_EQ(failure("a.ply", header + points + face + raw_face({0, 1, 3})),
            "face 1 refers to vertex 3, the file has 3");
  EXPECT_EQ(failure("a.ply", header + points + face + raw_face({0, -1, 2})),
            "face 1 refers to vertex -1, the file has 3");
  EXPECT_EQ(failure("a.ply", header + points + face + raw_face({0, 1}) + "1234"),
            "expected the end of the file, found 4 more bytes");
  EXPECT_TRUE(failure("a.ply", header + points + raw_face({0, 1, 2, 1}) + face.substr(0, 9)).starts_with("truncated"));
  EXPECT_EQ(failure("a.ply", header + points + face + face + "7"), "expected the end of the file, found 1 more bytes");
  const std::string infinite = raw_point(0, std::numeric_limits<float>::infinity(), 0);
  EXPECT_TRUE(failure("a.ply", header + raw_point(0, 0, 0) + infinite + points.substr(12, 12) + face + face)
                  .starts_with("vertex 1 has 'y' = inf"));
}

TEST(ReadMesh, PlyOfPointsOnlyHasNoTriangles) {
  const TriangleMesh mesh = parse("a.ply",
                                  "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                                  "property float z\nend_header\n1 2 3\n");
  EXPECT_EQ(mesh.vertices.size(), 1U);
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(ReadMesh, ObjCornersOfEveryForm) {
  const TriangleMesh mesh =
      parse("a.obj",
            "# comment\nmtllib a.mtl\no thing\nv 0 0 0 1.0\nv 1 0 0 0.5 0.5 0.5\r\nv 1 1 0\nv 0 1 0\n"
            "vt 0 0\nvn 0 0 1\ns off\nf 1 2 3 4\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\n"
            "f 1/1/1 2/1/1 3/1/1\nf -4 -3 -2\nf 1 \\\n 2 \\\n 3\n");
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}}));
  EXPECT_TRUE(mesh.normals.empty()) << "one normal for four vertices has no place in a mesh";
}

// As many normals as vertices, but in another order: one per vertex by number would be wrong.
TEST(ReadMesh, ObjNormalsInAnotherOrderAreLeftOut) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nvn 1 0 0\n";
  EXPECT_EQ(parse("a.obj", text + "f 1//1 2//2 3//3\n").normals.size(), 3U);
  EXPECT_TRUE(parse("a.obj", text + "f 1//2 2//3 3//1\n").normals.empty());
}

TEST(ReadMesh, FormatIsToldByContentBeforeTheName) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  EXPECT_NO_THROW(parse("wrong.obj", ply));
  EXPECT_EQ(parse("no-ending", "# c\n\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").triangles.size(), 1U);
  EXPECT_EQ(failure("a.bin", "hello"), "expected PLY, STL, OBJ, OFF, VTP, VTU, VTK, GLB, glTF or 3MF, found 'hello'");
  EXPECT_EQ(failure("a.ply", "hello"), "expected the line 'ply' at the beginning, found 'hello'");
  EXPECT_EQ(failure("a.obj", ""), "expected a mesh file, found an empty file");
}

TEST(ReadMesh, MissingFilesFoldersAndPipesAreErrors) {
  const files::Folder folder;
  EXPECT_THROW(read_mesh(folder / "missing.ply"), BadInput);
  EXPECT_THROW(read_mesh(folder.path()), BadInput);
  EXPECT_THROW(read_mesh("/dev/null"), BadInput);
  EXPECT_THROW(read_mesh(""), BadInput);
}

// Each of these asks for more memory or time than the file is worth, or would crash a careless reader.
TEST(ReadMesh, PlyHeadersThatLie) {
  const std::string tail = "0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n";
  EXPECT_EQ(failure("a.ply", ply_header("4000000000", "1") + tail),
            "truncated: its header promises 4000000000 of 'vertex', expected at least 24000000000 bytes after the "
            "header, found 26");
  EXPECT_TRUE(failure("a.ply", ply_header("3", "18446744073709551615") + tail).starts_with("truncated"));
  EXPECT_TRUE(failure("a.ply", ply_header("4294967296", "1") + tail).find("at most 4294967295") != std::string::npos);
  EXPECT_TRUE(failure("a.ply", ply_header("-1", "1") + tail).starts_with("header line 3"));
  EXPECT_TRUE(failure("a.ply", ply_header("3", "1", "binary_little_endian") + tail).starts_with("truncated"));
  EXPECT_TRUE(failure("a.ply", "ply\n" + std::string(2 << 20, 'x')).find("longer than") != std::string::npos);
  EXPECT_TRUE(failure("a.ply", "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\nend_header\n")
                  .find("no element 'vertex'") != std::string::npos);
  // Records without any property take no bytes, so no file is too short for them.
  const std::string nothing = "ply\nformat ascii 1.0\nelement nothing 18446744073709551615\n" +
                              ply_header("3", "1").substr(std::strlen("ply\nformat ascii 1.0\n"));
  EXPECT_EQ(parse("a.ply", nothing + tail).triangles.size(), 1U);
}

TEST(ReadMesh, PlyDataThatAreWrong) {
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  const std::string header = ply_header("3", "1");
  EXPECT_EQ(failure("a.ply", header + points + "3 0 1 3\n"), "face 0 refers to vertex 3, the file has 3");
  EXPECT_TRUE(failure("a.ply", header + points + "3 0 1 -1\n").starts_with("face 0 refers to"));
  EXPECT_TRUE(failure("a.ply", header + points + "3 0 1 1.5\n").starts_with("face 0 refers to"));
  EXPECT_TRUE(failure("a.ply", header + points + "3 0 1 nan\n").starts_with("face 0 refers to"));
  EXPECT_TRUE(failure("a.ply", header + points + "-3 0 1 2\n").starts_with("expected the length of list"));
  EXPECT_TRUE(failure("a.ply", header + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n").starts_with("vertex 0 has 'z' = nan"));
  EXPECT_TRUE(failure("a.ply", header + "0 0 inf\n1 0 0\n0 1 0\n3 0 1 2\n").starts_with("vertex 0 has 'z' = inf"));
  EXPECT_EQ(failure("a.ply", header + "0 0 1e99\n1 0 0\n0 1 0\n3 0 1 2\n"),
            "vertex 0 has 'z' = 1e+99, expected a finite float32");
  EXPECT_EQ(failure("a.ply", header + points + "3 0 1 \x1b[2J\n"), "expected a number, found '?[2J'");
  EXPECT_EQ(failure("a.ply", header + points + "3 0 1 2\n7"), "expected the end of the file, found 1 more bytes");
  EXPECT_TRUE(failure("a.ply", "ply\nformat ascii 1.0\nelement vertex 0\nend_header\n").find("no number 'x'") !=
              std::string::npos);
}

TEST(ReadMesh, StlDataThatAreWrong) {
  EXPECT_EQ(failure("a.stl", std::string(80, ' ') + raw(std::uint32_t{2}) + std::string(99, '\0')),
            "expected 100 bytes of 2 triangles after the header, found 99");
  std::string bytes = std::string(80, ' ') + raw(std::uint32_t{1}) + std::string(50, '\0');
  bytes.replace(84 + 12, 4, raw(std::bit_cast<float>(0x7fc00000U)));
  EXPECT_EQ(failure("a.stl", bytes), "triangle 0 has a coordinate that is not finite");
  EXPECT_EQ(failure("a.stl", "solid\nfacet normal 0 0 0\nouter loop\nvertex 0 0\n"),
            "line 4: expected a number, found the end of the file");
  EXPECT_EQ(failure("a.stl", "solid\nfacet normal 0 0 0\nouter loop\nendloop\n"),
            "line 4: expected 'vertex', found 'endloop'");
  EXPECT_EQ(failure("a.stl", "solid\n"), "truncated: expected 'endsolid', found the end of the file");
}

TEST(ReadMesh, ObjDataThatAreWrong) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(failure("a.obj", points + "f 1 2 4\n"), "a face refers to vertex 4, the file has 3");
  EXPECT_EQ(failure("a.obj", points + "f 1 2 0\n"), "line 4: expected the number of a vertex or normal, found '0'");
  EXPECT_EQ(failure("a.obj", points + "f 1 2 -4\n"), "line 4: expected the number of a vertex or normal, found '-4'");
  EXPECT_TRUE(failure("a.obj", points + "f 1 2 99999999999999999999\n").starts_with("line 4: expected the number"));
  EXPECT_TRUE(failure("a.obj", points + "f 1/1/1/1 2 3\n").starts_with("line 4: expected a corner"));
  EXPECT_EQ(failure("a.obj", "v 0 0 inf\n"), "line 1: expected a finite number, found 'inf'");
  EXPECT_EQ(failure("a.obj", "v 0 0 1e39\n"),
            "line 1: expected a number that 32 bits hold, up to 3.4e38, found '1e39'");
  EXPECT_EQ(failure("a.obj", "v 0 0\nv 0 0 0\n"), "line 1: expected a number, found the end of the line");
  EXPECT_TRUE(failure("a.obj", std::string("v 0 0 0\n\0\1\2", 11)).starts_with("line 2: expected an OBJ"));
  EXPECT_TRUE(failure("a.obj", std::string(3 << 20, 'v')).find("longer than") != std::string::npos);
  EXPECT_TRUE(failure("a.obj", points + "f 1 2 \\").starts_with("line 4: truncated"));
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_formats_test
