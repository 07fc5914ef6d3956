// STL, OBJ, OFF and PLY as programs write them, beyond what the definitions say.
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mesh_file_helpers.hpp"
#include "meshes.hpp"

namespace isoweave::testing::read_mesh_dialects_test {
namespace {

using mesh_files::failure;
using mesh_files::parse;
using mesh_files::raw;
using mesh_files::raw_point;
using mesh_files::with_line_ends;
using Triangles = std::vector<meshes::Triangle>;
using Notes = std::vector<std::string>;

const std::string kMark = "\xEF\xBB\xBF";

// Two triangles of a square, which share an edge.
const std::string kStl =
    "solid part 1\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid part 1\n";
const std::string kObj = "# square\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
const std::string kOff = "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n";

void expect_square(const TriangleMesh& mesh, const std::string& what) {
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}})) << what;
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}})) << what;
  EXPECT_EQ(mesh.notes, Notes{}) << what;
}

const std::vector<std::pair<std::string, std::string>> kSquares{
    {"a.stl", kStl}, {"a.obj", kObj}, {"a.off", kOff}, {"a.ply", kPly}};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

TEST(ReadMeshDialects, TextsThatBeginAndEndAsTheyLike) {
  for (const auto& [name, text] : kSquares) {
    expect_square(parse(name, text), name);
    expect_square(parse(name, kMark + text), name + " with a byte order mark");
    expect_square(parse("no-ending", kMark + text), name + " told by content");
    expect_square(parse(name, "\n \t" + text), name + " behind blanks");
    expect_square(parse(name, text.substr(0, text.size() - 1)), name + " without a last line end");
    expect_square(parse(name, text + "\n\n \n"), name + " before empty lines");
    expect_square(parse(name, text + "\x1a"), name + " before the end of a text of DOS");
    for (const char* end : {"\r\n", "\r", " \t\n", "\n\n"}) {
      expect_square(parse(name, with_line_ends(text, end)), name + " with other line ends");
    }
  }
}

TEST(ReadMeshDialects, WideCharactersAreRefusedByName) {
  for (const auto& [name, text] : kSquares) {
    std::string little, big;
    for (const char c : text) {
      little += std::string(1, c) + '\0';
      big += '\0' + std::string(1, c);
    }
    for (const std::string& wide : {"\xFF\xFE" + little, "\xFE\xFF" + big, little, big}) {
      EXPECT_EQ(failure(name, wide), "expected text in ASCII or UTF-8, found UTF-16 or UTF-32");
    }
  }
}

TEST(ReadMeshDialects, DecimalCommasAndNumbersThatAreNone) {
  EXPECT_EQ(failure("a.stl", replaced(kStl, "vertex 1 1 0", "vertex 1,5 1 0")),
            "line 6: expected a number with a decimal point, found '1,5'");
  EXPECT_EQ(failure("a.obj", replaced(kObj, "v 1 0 0", "v 1,5 0,0 0")),
            "line 3: expected a number with a decimal point, found '1,5'");
  EXPECT_EQ(failure("a.off", replaced(kOff, "1 0 0", "1,5 0 0")),
            "line 4: expected a number with a decimal point, found '1,5'");
  EXPECT_EQ(failure("a.stl", replaced(kStl, "vertex 1 1 0", "vertex nan 1 0")),
            "line 6: expected a finite number, found 'nan'");
  EXPECT_EQ(failure("a.off", replaced(kOff, "1 0 0", "-inf 0 0")), "line 4: expected a finite number, found '-inf'");
  EXPECT_EQ(failure("a.obj", replaced(kObj, "v 1 0 0", "v 0 0 1.#INF")),
            "line 3: expected a finite number, found '1.#INF'")
      << "no comment begins inside a word";
}

TEST(ReadMeshDialects, NumbersInPlyText) {
  const TriangleMesh mesh = parse("a.ply", replaced(kPly, "\n1 0 0\n", "\n+1.5E+03 2.5D-01 1e-400\n"));
  EXPECT_EQ(mesh.vertices[1], (Point{1500, 0.25F, 0}));
  EXPECT_EQ(failure("a.ply", replaced(kPly, "\n1 0 0\n", "\n1,5 0 0\n")),
            "expected a number with a decimal point, found '1,5'");
  EXPECT_EQ(failure("a.ply", replaced(kPly, "\n1 0 0\n", "\n0 0 1.#INF\n")),
            "vertex 1 has 'z' = nan, expected a finite float32");
}

TEST(ReadMeshDialects, NumbersOfEveryProgram) {
  const std::vector<Point> expected{{1500, 0.5F, -2}, {0, 0.25F, 3}, {1e-3F, 0, 7}};
  const std::string vertices = "v +1.5E+03 .5 -2.\nv 1e-400 2.5D-01 3d0\nv 1.0E-003 -0.0 007\n";
  EXPECT_EQ(parse("a.obj", vertices + "f 1 2 3\n").vertices, expected);
}

TEST(ReadMeshDialects, StlTextInCapitals) {
  std::string capitals = kStl;
  for (char& c : capitals) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  expect_square(parse("a.stl", capitals), "capitals");
  expect_square(parse("a.stl", "  " + capitals), "capitals behind blanks");
  expect_square(parse("a.stl", with_line_ends(kStl, " ")), "one line");
  expect_square(parse("a.stl", with_line_ends(replaced(kStl, "part 1", "facet of a part"), " ")), "one line");
  expect_square(parse("a.stl", with_line_ends(kStl, "\n\n\t")), "empty lines");
}

TEST(ReadMeshDialects, StlTextWithOtherWords) {
  for (const char* normal : {"facet normal nan nan nan", "facet normal -1.#IND 0 0", "facet normal", "facet"}) {
    expect_square(parse("a.stl", replaced(kStl, "facet normal 0 0 1", normal)), normal);
  }
  expect_square(parse("a.stl", replaced(replaced(kStl, "endfacet", "end facet"), "endloop", "End Loop")), "end facet");
  expect_square(parse("a.stl", replaced(kStl, "endsolid part 1", "end solid")), "end solid");
  expect_square(parse("a.stl", replaced(kStl, "solid part 1", "solid")), "no name");
  expect_square(parse("a.stl", replaced(kStl, "part 1", "p" + std::string(70, '\0'))), "a name filled up");
  expect_square(parse("a.stl", replaced(kStl, "endsolid part 1", "endsolid another name")), "another name");
  expect_square(parse("a.stl", replaced(kStl, "endsolid part 1", "endsolidPart")), "no blank before the name");
  expect_square(parse("a.stl", replaced(kStl, "endsolid part 1\n", "endsolid\n\nsolid empty\nendsolid")), "two solids");
}

// A text that is none of STL must not be taken for a binary file of billions of triangles.
TEST(ReadMeshDialects, StlTextThatIsWrong) {
  const std::string facets = kStl.substr(kStl.find("facet"));
  EXPECT_EQ(failure("a.stl", facets), "line 1: expected 'solid', found 'facet'");
  EXPECT_EQ(failure("a.stl", "hello\n" + kStl), "line 1: expected 'solid', found 'hello'");
  EXPECT_EQ(failure("a.stl", "hello"), "line 1: expected 'solid', found 'hello'");
  EXPECT_EQ(failure("a.stl", replaced(kStl, "endsolid part 1\n", "")),
            "truncated: expected 'endsolid', found the end of the file");
  EXPECT_EQ(failure("a.stl", replaced(kStl, "vertex 1 0 0\n", "")), "line 6: expected 'vertex', found 'endloop'");
  EXPECT_EQ(failure("a.stl", replaced(kStl, "endloop", "vertex 0 1 0")), "line 7: expected 'endloop', found 'vertex'");
  EXPECT_EQ(failure("a.stl", replaced(kStl, "outer loop\n", "")), "line 3: expected 'outer', found 'vertex'");
  EXPECT_EQ(failure("a.stl", replaced(kStl, "vertex 1 0 0", "vertex 1 0 0 7")), "line 5: expected 'vertex', found '7'");
}

std::string stl_triangle(float z, std::uint16_t attribute = 0) {
  return raw_point(0, 0, 1) + raw_point(0, 0, z) + raw_point(1, 0, z) + raw_point(0, 1, z) + raw(attribute);
}

std::string stl_binary(std::uint32_t count, const std::string& triangles, std::string header = "exported") {
  header.resize(80, ' ');
  return header + raw(count) + triangles;
}

TEST(ReadMeshDialects, StlBinaryOfAnyHeader) {
  for (const std::string header : {"solid", "SOLID x", " solid x", "ply", "OFF", "v 0 0 0", "facet"}) {
    EXPECT_EQ(parse("a.stl", stl_binary(2, stl_triangle(0) + stl_triangle(1), header)).triangles.size(), 2U) << header;
  }
}

TEST(ReadMeshDialects, StlBinaryWhoseCountIsWrong) {
  const std::string two = stl_triangle(0) + stl_triangle(1);
  for (const std::uint32_t said : {0U, 1U, 0xffffffffU}) {
    const TriangleMesh mesh = parse("a.stl", stl_binary(said, two));
    EXPECT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.notes,
              Notes{"its header counts " + std::to_string(said) + " triangles, its length 2, which are read"});
  }
  EXPECT_EQ(failure("a.stl", stl_binary(3, two)), "expected 150 bytes of 3 triangles after the header, found 100")
      << "what was cut off between two triangles";
  const TriangleMesh more = parse("a.stl", stl_binary(2, two + "the end"));
  EXPECT_EQ(more.triangles.size(), 2U);
  EXPECT_EQ(more.notes, Notes{"left out: 7 bytes behind the last triangle"});
  EXPECT_EQ(failure("a.stl", stl_binary(0, two + "the end")),
            "expected 0 bytes of 0 triangles after the header, found 107");
  EXPECT_EQ(parse("a.stl", stl_binary(0, "")).notes, Notes{});
}

TEST(ReadMeshDialects, StlColoursAreTold) {
  const std::string coloured = stl_triangle(0, 0x801f) + stl_triangle(1) + stl_triangle(2, 1);
  EXPECT_EQ(parse("a.stl", stl_binary(3, coloured, "COLOR=")).notes,
            Notes{"left out: 2 attributes of triangles, which may be colours"});
}

std::string ply_with(const std::string& properties, const std::string& more, const std::string& last = "") {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
                     properties + "element face 1\nproperty list uchar int vertex_indices\n" + last + "end_header\n";
  for (const char* point : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) text += point + more + "\n";
  return text + "3 0 1 2 ";
}

TEST(ReadMeshDialects, PlyHeaderInOtherLetters) {
  expect_square(
      parse("a.ply", replaced(replaced(kPly, "ply\nformat", "PLY\nFormat"), "property float x", "Property Float32 x")),
      "capitals");
  expect_square(parse("a.ply", replaced(kPly, "element vertex 4", "obj_info\ncomment\n\n  element \t vertex  4 ")),
                "blanks and comments");
  for (const char* list : {"list char int8", "list int16 short", "list uint32 uint", "list int64 uint64"}) {
    expect_square(parse("a.ply", replaced(kPly, "list uchar int", list)), list);
  }
  expect_square(parse("a.ply", replaced(kPly, "vertex_indices", "vertex_index")), "vertex_index");
}

// As meshio writes arrays whose names have blanks.
TEST(ReadMeshDialects, PlyPropertiesWithBlanksInTheirNames) {
  const TriangleMesh mesh = parse("a.ply", ply_with("property double  wall stress \nproperty int cell  id\n", "7 1"));
  EXPECT_EQ(mesh.values, (std::vector<float>{7, 7, 7}));
  EXPECT_EQ(mesh.notes, (Notes{"not kept: cell  id", "the values at its vertices are the property 'wall stress'"}));
  EXPECT_EQ(failure("a.ply", replaced(kPly, "float x", "float x 1")), "its vertices have no number 'x'");
  EXPECT_EQ(failure("a.ply", replaced(kPly, "float x", "float ")),
            "header line 4: expected 'property TYPE NAME', found 'property float'");
}

// The data begin with a line feed, which belongs to the first number.
TEST(ReadMeshDialects, PlyBinaryAfterLinesThatEndInReturns) {
  for (const bool big : {false, true}) {
    const auto first = std::bit_cast<float>(big ? 0x0a000041U : 0x4100000aU);
    std::string header =
        replaced(kPly.substr(0, kPly.find("0 0 0")), "ascii", big ? "binary_big_endian" : "binary_little_endian");
    header = replaced(replaced(header, "vertex 4", "vertex 3"), "face 2", "face 1");
    std::string data;
    for (const float number : {first, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F, 7.0F, 8.0F, 9.0F}) data += raw(number, big);
    data += '\3';
    for (const int corner : {0, 1, 2}) data += raw(corner, big);
    for (const char* end : {"\n", "\r\n", "\r"}) {
      const TriangleMesh mesh = parse("a.ply", with_line_ends(header, end) + data);
      EXPECT_EQ(mesh.vertices, (std::vector<Point>{{first, 2, 3}, {4, 5, 6}, {7, 8, 9}}));
      EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
    }
  }
}

std::string ply_of_strips(const std::string& strips, const std::string& before = "") {
  return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n" + before +
         "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
         "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n" +
         strips;
}

// The Stanford models: every second triangle is turned, -1 begins a strip.
TEST(ReadMeshDialects, PlyStrips) {
  EXPECT_EQ(parse("a.ply", ply_of_strips("5 0 2 1 3 5\n")).triangles, (Triangles{{0, 2, 1}, {1, 2, 3}, {1, 3, 5}}));
  EXPECT_EQ(parse("a.ply", ply_of_strips("9 0 2 1 -1 2 4 3 5 -1\n")).triangles,
            (Triangles{{0, 2, 1}, {2, 4, 3}, {3, 4, 5}}));
  EXPECT_EQ(parse("a.ply", ply_of_strips("8 0 2 1 1 2 2 4 3\n")).triangles, (Triangles{{0, 2, 1}, {4, 2, 3}}))
      << "repeated corners lead from one strip to the next";
  EXPECT_EQ(parse("a.ply", ply_of_strips("2 0 1\n")).triangles, Triangles{});
  EXPECT_EQ(failure("a.ply", ply_of_strips("4 0 2 1 6\n")), "strip 0 refers to vertex 6, the file has 6");
  EXPECT_EQ(failure("a.ply", ply_of_strips("4 0 2 1 -2\n")), "strip 0 refers to vertex -2, the file has 6");
  EXPECT_EQ(failure("a.ply", ply_of_strips("4 0 2 1\n")), "truncated: expected a number, found the end of the file");
  EXPECT_EQ(parse("a.ply", ply_of_strips("3 0 2 1\n", "element face 0\n")).triangles, (Triangles{{0, 2, 1}}));
}

TEST(ReadMeshDialects, PlyValuesAreTheNumberThatProgramsMean) {
  const auto values = [](const std::string& properties, const std::string& more) {
    const TriangleMesh mesh = parse("a.ply", ply_with(properties, more));
    EXPECT_TRUE(mesh.values.empty() || mesh.values.size() == 3U);
    return mesh.values.empty() ? -1.0F : mesh.values[1];
  };
  EXPECT_EQ(values("property double quality\n", "7"), 7);
  EXPECT_EQ(values("property float scalar_Intensity\nproperty uchar red\n", "7 255"), 7);
  EXPECT_EQ(values("property float confidence\nproperty float intensity\n", "0.5 7"), 7) << "Stanford's scans";
  EXPECT_EQ(values("property uchar intensity\nproperty float temperature\n", "7 300"), 7);
  EXPECT_EQ(values("property float temperature\nproperty uchar red\n", "7 255"), 7) << "the only real number";
  EXPECT_EQ(values("property float temperature\nproperty float pressure\n", "7 8"), -1) << "neither of two";
  EXPECT_EQ(values("property int label\n", "7"), -1) << "there is nothing between labels";
  EXPECT_EQ(values("property float s\nproperty float t\n", "0.5 0.5"), -1);
  EXPECT_EQ(values("property list uchar float quality\n", "1 7"), -1);
}

TEST(ReadMeshDialects, PlyLeftoversAreTold) {
  EXPECT_EQ(parse("a.ply", ply_with("property float quality\n", "7") + "\n").notes, Notes{});
  EXPECT_EQ(parse("a.ply", ply_with("property float intensity\n", "7")).notes,
            Notes{"the values at its vertices are the property 'intensity'"});
  const std::string colours = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  EXPECT_EQ(parse("a.ply", ply_with(colours, "1 2 3", "property int flags\n") + "9").notes,
            Notes{"not kept: red, green, blue, flags of faces"});
  EXPECT_EQ(parse("a.ply", ply_with("", "", "element edge 2\nproperty int a\nproperty int b\n") + "0 1 1 2").notes,
            Notes{"left out: 2 of 'edge'"});
  std::string many, more;
  for (int n = 0; n < 20; ++n) {
    many += "property float f_rest_" + std::to_string(n) + "\n";
    more += "0 ";
  }
  const Notes notes = parse("a.ply", ply_with(many, more)).notes;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].ends_with("f_rest_11 and 8 more")) << notes[0];
}

TEST(ReadMeshDialects, FacesOfFewerThanThreeCornersAreLeftOut) {
  const Notes two{"left out: 2 faces of fewer than three corners"};
  const TriangleMesh ply = parse("a.ply", replaced(kPly, "face 2", "face 4") + "2 0 1\n1 3\n");
  EXPECT_EQ(ply.triangles.size(), 2U);
  EXPECT_EQ(ply.notes, two);
  const TriangleMesh off = parse("a.off", replaced(kOff, "4 2 0", "4 4 0") + "2 0 1\n1 3\n");
  EXPECT_EQ(off.triangles.size(), 2U);
  EXPECT_EQ(off.notes, two);
  const TriangleMesh obj = parse("a.obj", kObj + "f 1 2\nf\n");
  EXPECT_EQ(obj.triangles.size(), 2U);
  EXPECT_EQ(obj.notes, two);
  EXPECT_EQ(failure("a.off", replaced(kOff, "4 2 0", "4 3 0") + "2 0\n"),
            "line 9: expected the number of a vertex, found the end of the file");
}

// Vertices without an area have no normal, and programs say so in their ways.
TEST(ReadMeshDialects, NormalsThatAreNone) {
  const Notes one{"not kept: normals, of which 1 are not finite"};
  const std::string properties = "property float nx\nproperty double ny\nproperty float nz\n";
  std::string ply = ply_with(properties, "0 0 1");
  EXPECT_EQ(parse("a.ply", ply).normals.size(), 3U);
  for (const char* normal : {"nan nan nan", "0 -inf 0", "0 1e300 0"}) {
    const TriangleMesh mesh = parse("a.ply", replaced(ply, "0 0 1", normal));
    EXPECT_TRUE(mesh.normals.empty()) << normal;
    EXPECT_EQ(mesh.notes, one) << normal;
  }
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//2 3//3\nvn 0 0 1\nvn 0 0 1\n";
  EXPECT_EQ(parse("a.obj", corners + "vn 0 0 1\n").normals.size(), 3U);
  EXPECT_EQ(parse("a.off", "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 nan 0 0\n3 0 1 2\n").notes, one);
  for (const char* normal : {"vn nan nan nan", "vn -nan(ind) 0 0", "vn -1.#IND 0 1.#QNAN"}) {
    EXPECT_EQ(parse("a.obj", corners + normal).notes, one) << normal;
  }
  EXPECT_EQ(failure("a.obj", corners + "vn 0 0 up"), "line 7: expected a number, found 'up'");
}

TEST(ReadMeshDialects, CloudsOfPointsAreTold) {
  const Notes cloud{"has no triangles, but 4 vertices: a cloud of points"};
  const std::string ply = kPly.substr(0, kPly.find("3 0 1 2"));
  EXPECT_EQ(parse("a.ply", replaced(ply, "element face 2\nproperty list uchar int vertex_indices\n", "")).notes, cloud);
  EXPECT_EQ(parse("a.ply", replaced(ply, "face 2\nproperty list uchar int vertex_indices", "face 0")).notes, cloud);
  EXPECT_EQ(parse("a.obj", kObj.substr(0, kObj.find("f 1"))).notes, cloud);
  EXPECT_EQ(parse("a.off", replaced(kOff.substr(0, kOff.find("3 0 1")), "4 2", "4 0")).notes, cloud);
}

TEST(ReadMeshDialects, ObjStatementsAsProgramsWriteThem) {
  expect_square(parse("a.obj", replaced(kObj, "v 1 0 0", "V\t1 0\t0 # corner")), "comments, tabs, capitals");
  expect_square(parse("a.obj", replaced(kObj, "v 1 0 0", "v 1 0 0 1.0")), "a weight");
  expect_square(parse("a.obj", replaced(kObj, "# square", "# C:\\models\\")), "a comment does not go on");
  expect_square(parse("a.obj", replaced(kObj, "f 1 2 3", "f 1 \\ \r\n 2 \\\n\\\n3")), "lines that go on");
  expect_square(parse("a.obj", replaced(kObj, "f 1 2 3", "g a #1\ns 1\no b\nfo 1 2 3")), "groups");
  expect_square(parse("a.obj", replaced(kObj, "f 1 2 3", "plugin_extra 7\nf -4 -3 -2")), "statements of a program");
  EXPECT_EQ(parse("a.obj", "vp 1 2\nf 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles, (Triangles{{0, 1, 2}}))
      << "faces before their vertices";
}

TEST(ReadMeshDialects, ObjLeftoversAreTold) {
  const auto notes = [](const std::string& more) { return parse("a.obj", kObj + more).notes; };
  EXPECT_EQ(notes("l 1 2\nl 2 3 4\np 1\n"), Notes{"left out: 2 lines, 1 elements of points"});
  EXPECT_EQ(notes("mtllib a.mtl\nusemtl red\nvt 0 0\n"), Notes{"not kept: materials, texture coordinates"});
  EXPECT_EQ(notes("cstype bezier\ndeg 3 3\nsurf 0 1 0 1 1 2 3 4\nparm u 0 1\nend\n"),
            Notes{"left out: 1 free-form curves and surfaces"});
  EXPECT_EQ(notes("vn 0 0 1\n"), Notes{"not kept: normals that are not numbered as the vertices are"});
  EXPECT_EQ(parse("a.obj", replaced(kObj, "v 1 0 0", "v 1 0 0 0.5 0.5 1")).notes,
            Notes{"not kept: colours of vertices"});
}

TEST(ReadMeshDialects, TextThatIsNoObj) {
  EXPECT_EQ(failure("a.obj", "hello world\n"), "expected OBJ statements such as 'v' and 'f', found 'hello'");
  EXPECT_TRUE(parse("a.obj", "# nothing\no empty\n").vertices.empty());
}

TEST(ReadMeshDialects, OffKeywordsAndCounts) {
  for (const char* head : {"\t  OFF4 2 0 # on one line", "OFF 4 2 0", "off\n4 2 0", "OFF4 2 5", "OFF\n\n# counts\n4 2",
                           "# by hand\nOFF # shape\n4 2 0", "4 2 0", "OFF\n4\n2"}) {
    expect_square(parse("a.off", replaced(kOff, "OFF\n4 2 0", head)), head);
  }
  expect_square(parse("no-ending", replaced(kOff, "OFF\n4 2 0", "OFF4 2 0")), "no blank behind the keyword");
  expect_square(parse("a.off", replaced(kOff, "1 0 0\n", "1\n0\n0\n")), "a line for each number");
  expect_square(parse("a.off", replaced(kOff, "3 0 1 2\n", "3\n0 1\n2\n")), "a face on three lines");
  for (const char* head : {"4OFF", "nOFF", "ST4OFF"}) {
    EXPECT_EQ(failure("a.off", replaced(kOff, "OFF", head)),
              "line 1: expected vertices of three coordinates, found '" + std::string(head) + "'");
  }
  EXPECT_EQ(failure("a.off", replaced(kOff, "OFF", "OFF BINARY")),
            "line 1: is a binary OFF file, expected one in text");
  EXPECT_EQ(failure("a.off", replaced(kOff, "OFF", "XOFF")), "line 1: expected the number of vertices, found 'XOFF'");
  EXPECT_EQ(failure("a.off", "hello"), "line 1: expected the number of vertices, found 'hello'");
}

TEST(ReadMeshDialects, OffOfMoreThanCoordinates) {
  const auto with = [](const std::string& keyword, const std::string& more) {
    std::string text = replaced(kOff, "OFF", keyword);
    for (const char* point : {"\n0 0 0", "\n1 0 0", "\n1 1 0", "\n0 1 0"}) text = replaced(text, point, point + more);
    return parse("a.off", text);
  };
  const std::vector<std::pair<std::string, Notes>> kinds{
      {"COFF", {"not kept: colours of vertices"}},
      {"coff", {"not kept: colours of vertices"}},
      {"STOFF", {"not kept: texture coordinates"}},
      {"STCOFF", {"not kept: colours of vertices, texture coordinates"}},
      {"NCOFF", {"not kept: normals, colours of vertices"}},
      {"CNOFF", {"not kept: normals, colours of vertices"}},
      {"OFF", {"not kept: numbers behind the coordinates of vertices"}}};
  for (const auto& [keyword, notes] : kinds) {
    TriangleMesh mesh = with(keyword, " 0.5 0.25 1 0.5 1 1 1");
    EXPECT_EQ(mesh.notes, notes) << keyword;
    EXPECT_TRUE(mesh.normals.empty()) << keyword;
    mesh.notes.clear();
    expect_square(mesh, keyword);
  }
  for (const char* keyword : {"NOFF", "STNOFF"}) {
    EXPECT_EQ(with(keyword, " 0 0 1").normals, std::vector<Point>(4, {0, 0, 1})) << keyword;
  }
  EXPECT_EQ(parse("a.off", replaced(kOff, "3 0 1 2", "3 0 1 2 255 0 0")).notes, Notes{"not kept: colours of faces"});
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_dialects_test
