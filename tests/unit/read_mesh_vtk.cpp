// VTP and legacy VTK as VTK and others write them, by hand.
#include <algorithm>

#include "foreign_meshes.hpp"
#include "isoweave/volume.hpp"
#include "meshes.hpp"
#include "packing.hpp"

namespace isoweave::testing::read_mesh_vtk_test {
namespace {

using foreign::contains;
using foreign::failure;
using foreign::has_note;
using foreign::parse;
using meshes::Triangle;

std::string array(const std::string& attributes, const std::string& numbers) {
  return "<DataArray " + attributes + " format=\"ascii\" RangeMin=\"0\">\n  " + numbers +
         "\n<InformationKey name=\"L2_NORM_RANGE\"> 7 </InformationKey></DataArray>\n";
}

std::string cells(const std::string& section, const std::string& corners, const std::string& ends) {
  return "<" + section + ">" + array("type=\"Int64\" Name=\"connectivity\"", corners) +
         array("type=\"Int64\" Name=\"offsets\"", ends) + "</" + section + ">\n";
}

// Four points of the unit square, around, in a piece with these cells and these data of the points.
std::string piece(const std::string& counts, const std::string& cells, const std::string& point_data = "") {
  return "<Piece NumberOfPoints=\"4\" " + counts + ">" + point_data + "<Points>" +
         array("type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"", "0 0 0 1 0 0 1 1 0 0 1 0") + "</Points>" +
         cells + "</Piece>\n";
}

std::string vtp(const std::string& inside) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\" "
         "compressor=\"vtkZLibDataCompressor\">\n<PolyData>" +
         inside + "</PolyData>\n</VTKFile>\n";
}

const std::string kNone = cells("Verts", "", "") + cells("Lines", "", "");
const std::string kSquare = cells("Polys", "0 1 2 3", "4");

// Arrays of other cells stand before and behind those of the polygons.
TEST(ReadVtp, KeepsArraysOfOtherCellsApart) {
  const TriangleMesh mesh =
      parse("a.vtp", vtp(piece("NumberOfPolys=\"1\"", kNone + cells("Strips", "", "") + kSquare + kNone)));
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(mesh.notes.empty());
}

TEST(ReadVtp, ReadsStripsAndLeavesLinesOut) {
  const TriangleMesh mesh =
      parse("a.vtp", vtp(piece("NumberOfVerts=\"1\" NumberOfLines=\"2\" NumberOfStrips=\"1\" NumberOfPolys=\"2\"",
                               cells("Verts", "0", "1") + cells("Lines", "0 1 2 3", "2 4") +
                                   cells("Strips", "0 1 3 3 2", "5") + cells("Polys", "0 1 0 1 2", "2 5"))));
  // The strip turns at the corner that is repeated: 0 1 3, then 1 3 3 and 3 3 2, which are none.
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}}));
  EXPECT_TRUE(has_note(mesh, "2 lines"));
  EXPECT_TRUE(has_note(mesh, "1 cells that are points"));
  EXPECT_TRUE(has_note(mesh, "1 faces of fewer than three corners"));
}

TEST(ReadVtp, TurnsEveryOtherTriangleOfAStrip) {
  const TriangleMesh mesh = parse("a.vtp", vtp(piece("NumberOfStrips=\"1\"", cells("Strips", "0 1 3 2", "4"))));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 3}, {3, 1, 2}}));
}

TEST(ReadVtp, JoinsPieces) {
  const std::string one = piece("NumberOfPolys=\"1\"", kSquare);
  const TriangleMesh mesh = parse("a.vtp", vtp(one + "<Piece NumberOfPoints=\"0\"></Piece>" + one));
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}));
  EXPECT_TRUE(has_note(mesh, "2 pieces are joined"));
}

std::string ghosts(const std::string& bits) {
  return "<CellData>" + array("type=\"UInt8\" Name=\"vtkGhostType\"", bits) + "</CellData>";
}

// Pieces of parallel runs overlap: bits of 1, 8 and 32 are copies of cells of other pieces, refined and hidden cells.
TEST(ReadVtp, LeavesGhostCellsOut) {
  const std::string all = cells("Verts", "0", "1") + cells("Lines", "0 1", "2") +
                          cells("Polys", "0 1 2 0 2 3 1 2 3 0 1 3", "3 6 9 12") + cells("Strips", "0 1 3 3 1 2", "3 6");
  const std::string counts = "NumberOfVerts=\"1\" NumberOfLines=\"1\" NumberOfPolys=\"4\" NumberOfStrips=\"2\"";
  const TriangleMesh mesh = parse("a.vtp", vtp(piece(counts, all + ghosts("1 1 0 33 8 2 32 0"))));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}, {3, 1, 2}}));
  EXPECT_TRUE(has_note(mesh, "3 ghost cells"));
  EXPECT_FALSE(has_note(mesh, "not kept"));
  EXPECT_EQ(parse("a.vtp", vtp(piece(counts, all + ghosts("1 1 0 0 0 0 0 0")))).triangles.size(), 6U);
  EXPECT_TRUE(
      contains(failure("a.vtp", vtp(piece(counts, all + ghosts("0 0")))), "as many numbers as its header says"));
}

TEST(ReadVtp, KeepsActiveScalarsAndNormals) {
  const std::string data = "<PointData Scalars=\"pressure\" Normals=\"up\">" +
                           array("type=\"Float32\" Name=\"other\"", "1 2 3 4") +
                           array("type=\"UInt8\" Name=\"pressure\"", "10 20 30 40") +
                           array("type=\"Float32\" Name=\"up\" NumberOfComponents=\"3\"", "0 0 1 0 0 1 0 0 1 0 1 0") +
                           "</PointData>" + "<CellData>" + array("type=\"Int8\" Name=\"kind\"", "1") + "</CellData>";
  const TriangleMesh mesh = parse("a.vtp", vtp(piece("NumberOfPolys=\"1\"", kSquare, data)));
  EXPECT_EQ(mesh.values, (std::vector<float>{10, 20, 30, 40}));
  ASSERT_EQ(mesh.normals.size(), 4U);
  EXPECT_EQ(mesh.normals[3], (Point{0, 1, 0}));
  EXPECT_TRUE(has_note(mesh, "point array 'other'"));
  EXPECT_TRUE(has_note(mesh, "cell array 'kind'"));
  // A piece without them has no numbers for its points.
  const TriangleMesh mixed =
      parse("a.vtp", vtp(piece("NumberOfPolys=\"1\"", kSquare, data) + piece("NumberOfPolys=\"1\"", kSquare)));
  EXPECT_TRUE(mixed.values.empty() && mixed.normals.empty());
  EXPECT_TRUE(has_note(mixed, "scalars, which some pieces lack"));
}

// VTK's strings in text are the numbers of their characters.
TEST(ReadVtp, TakesSpaceAndUnitFromFieldData) {
  const std::string fields =
      "<FieldData><Array type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\"> 82 65 83 0 </Array>"
      "<Array type=\"String\" Name=\"UNIT\" NumberOfTuples=\"1\" format=\"ascii\">117 109 0</Array>"
      "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">0</DataArray></FieldData>";
  const TriangleMesh mesh = parse("a.vtp", vtp(fields + piece("NumberOfPolys=\"1\"", kSquare)));
  EXPECT_EQ(mesh.space, "RAS");
  EXPECT_EQ(mesh.unit, "um");
}

TEST(ReadVtp, RefusesWhatIsWrong) {
  const auto with = [](const std::string& cells) { return failure("a.vtp", vtp(piece("NumberOfPolys=\"1\"", cells))); };
  EXPECT_EQ(with(cells("Polys", "0 1 4", "3")), "a cell refers to point 4, there are 4");
  EXPECT_TRUE(contains(with(cells("Polys", "0 -1 2", "3")), "an index or a count, found '-1'"));
  EXPECT_TRUE(contains(with(cells("Polys", "0 1", "3")), "the end of an array"));
  EXPECT_TRUE(contains(with(kNone), "connectivity and offsets in Polys"));
  EXPECT_TRUE(contains(with(cells("Polys", "0 1 2", "1000000")), "which cannot hold them"));
  EXPECT_EQ(failure("a.vtp", "<VTKFile type=\"ImageData\"></VTKFile>"),
            "expected VTK XML of type PolyData or UnstructuredGrid, found 'ImageData'");
  EXPECT_TRUE(contains(failure("a.vtp", vtp("")), "a piece of PolyData"));
  std::string infinite = vtp(piece("NumberOfPolys=\"1\"", kSquare));
  infinite.replace(infinite.find("0 0 0 1 0 0"), 11, "0 0 0 1 0 inf");
  EXPECT_TRUE(contains(failure("a.vtp", infinite), "vertex 1 has a coordinate that is not a finite number"));
}

std::string legacy(const std::string& rest, const std::string& version = "4.2") {
  return "# vtk DataFile Version " + version + "\na title\nASCII\nDATASET POLYDATA\n" + rest;
}

const std::string kPoints = "POINTS 4 float\n0 0 0 1 0 0\n1 1 0 0 1 0\n\n";

std::string xml(const std::string& kind, const std::string& inside) {
  return "<VTKFile type=\"" + kind + "\" byte_order=\"LittleEndian\"><" + kind + ">" + inside + "</" + kind +
         "></VTKFile>\n";
}

std::string vtu(const std::string& corners, const std::string& ends, const std::string& kinds) {
  const std::string count = std::to_string(std::count(ends.begin(), ends.end(), ' ') + 1);
  std::string all = cells("Cells", corners, ends);
  all.insert(all.find("</Cells>"), array("type=\"UInt8\" Name=\"types\"", kinds));
  return xml("UnstructuredGrid", piece("NumberOfCells=\"" + count + "\"", all));
}

// A polygon, a triangle, a pixel, whose corners go row by row, a strip, a line.
TEST(ReadVtu, FlatCellsAreAMesh) {
  const TriangleMesh mesh = parse("a.vtu", vtu("0 1 2 3 0 1 2 0 1 3 2 0 1 3 2 0 1", "4 7 11 15 17", "7 5 8 6 3"));
  EXPECT_EQ(mesh.triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {3, 1, 2}}));
  EXPECT_TRUE(has_note(mesh, "1 lines"));
  EXPECT_EQ(parse("a.vtu", vtu("0 1 2 3", "4", "9")).triangles.size(), 2U);
}

TEST(ReadVtu, OtherCellsAreRefusedWithTheWayRound) {
  EXPECT_EQ(failure("a.vtu", vtu("0 1 2 3", "4", "10")),
            "expected cells that are triangles or polygons, found type 10 (extract the surface first: "
            "vtkDataSetSurfaceFilter, or Extract Surface of ParaView)");
  EXPECT_EQ(failure("a.vtu", vtu("0 1 2 7", "4", "9")), "a cell refers to point 7, there are 4");
  EXPECT_TRUE(contains(failure("a.vtu", vtu("0 1 2 3", "3 4", "9")), "as many numbers as its header says"))
      << failure("a.vtu", vtu("0 1 2 3", "3 4", "9"));
  EXPECT_EQ(failure("a.vtu", xml("UnstructuredGrid", piece("NumberOfCells=\"1\"", cells("Cells", "0 1 2", "3")))),
            "expected types of Cells, found none");
  EXPECT_EQ(failure("a.vtu", "text"), "expected a '<VTKFile' tag at the beginning, found 'text'");
  foreign::expect_damage_is_safe("a.vtu", vtu("0 1 2 3 0 1 2", "4 7", "7 5"));
}

TEST(ReadVtu, VolumesThatAreNoneSayThatTheyAreMeshes) {
  const files::Folder folder;
  files::write_bytes(folder / "a.vtu", vtu("0 1 2 3", "4", "9"));
  try {
    open_volume(folder / "a.vtu");
    FAIL() << "a mesh was read as a volume";
  } catch (const BadInput& error) {
    EXPECT_TRUE(contains(error.what(), "'UnstructuredGrid', a mesh: isoweave simplify takes it")) << error.what();
  }
}

// A list of pieces, and the pieces, in a folder.
class Pieces {
 public:
  Pieces() {
    const std::string square = piece("NumberOfPolys=\"1\"", kSquare);
    put("a_0.vtp", vtp(square));
    put("a_1.vtp", vtp(square + square));
    put("b_0.vtu", vtu("0 1 2", "3", "5"));
  }

  void put(const std::string& name, const std::string& content) const { files::write_bytes(folder_ / name, content); }
  std::string path() const { return folder_ / "a.pvtp"; }

  TriangleMesh read(const std::string& kind, const std::vector<std::string>& sources, bool external = true) const {
    std::string list = "<PPointData/>";
    for (const std::string& source : sources) list += "<Piece Source=\"" + source + "\"/>";
    put("a.pvtp", xml(kind, list));
    return read_mesh(path(), {external});
  }

  // Without the path of the list.
  std::string refusal(const std::string& kind, const std::vector<std::string>& sources, bool external = true) const {
    try {
      read(kind, sources, external);
    } catch (const BadInput& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find('\n'), std::string::npos);
      return message.starts_with(path()) ? message.substr(path().size() + 2) : message;
    }
    return "nothing thrown";
  }

 private:
  files::Folder folder_;
};

TEST(ReadPvtp, PiecesInOtherFilesAreJoined) {
  const Pieces pieces;
  const TriangleMesh mesh = pieces.read("PPolyData", {"a_0.vtp", "a_1.vtp"});
  EXPECT_EQ(mesh.vertices.size(), 12U);
  EXPECT_EQ(mesh.triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {8, 9, 10}, {8, 10, 11}}));
  EXPECT_TRUE(has_note(mesh, "3 pieces are joined"));
  EXPECT_EQ(pieces.read("PUnstructuredGrid", {"b_0.vtu"}).triangles, (std::vector<Triangle>{{0, 1, 2}}));
  pieces.put("sub.vtp", testing::gzipped(vtp(piece("NumberOfPolys=\"1\"", kSquare))));
  EXPECT_EQ(pieces.read("PPolyData", {"sub.vtp"}).triangles.size(), 2U);
}

TEST(ReadPvtp, WhatIsNoPieceIsRefused) {
  const Pieces pieces;
  EXPECT_EQ(pieces.refusal("PPolyData", {"a_0.vtp"}, false),
            "expected a file that names no other, as --no-external asks, found 'a_0.vtp'");
  EXPECT_TRUE(contains(pieces.refusal("PPolyData", {"none.vtp"}), "none.vtp, found no such file"));
  EXPECT_EQ(pieces.refusal("PPolyData", {""}), "expected a file as Source of each piece, found none");
  EXPECT_EQ(pieces.refusal("PPolyData", {}), "expected a piece of PPolyData, found none");
  EXPECT_TRUE(contains(pieces.refusal("PPolyData", {"b_0.vtu"}), "b_0.vtu: expected VTK XML of type PolyData"));
  // A list of itself.
  EXPECT_TRUE(
      contains(pieces.refusal("PPolyData", {"a.pvtp"}), "expected VTK XML of type PolyData, found 'PPolyData'"));
  pieces.put("a_1.vtp", vtp(piece("NumberOfPolys=\"1\"", cells("Polys", "0 1 9", "3"))));
  EXPECT_TRUE(contains(pieces.refusal("PPolyData", {"a_0.vtp", "a_1.vtp"}), "a cell refers to point 9"));
}

TEST(ReadLegacyVtk, ReadsBothFormsOfCells) {
  const std::vector<Triangle> right{{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(parse("a.vtk", legacy(kPoints + "POLYGONS 1 5\n4 0 1 2 3\n")).triangles, right);
  const std::string offsets =
      "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1.4\n\n"
      "POLYGONS 2 4\nOFFSETS vtktypeint64\n0 4 \nCONNECTIVITY vtktypeint64\n0 1 2 3 \n";
  EXPECT_EQ(parse("a.vtk", legacy(kPoints + offsets, "5.1")).triangles, right);
  EXPECT_EQ(parse("no-ending", legacy(kPoints + "polygons 1 5\n4 0 1 2 3")).triangles, right);
}

TEST(ReadLegacyVtk, ReadsScalarsAndNormals) {
  const TriangleMesh mesh =
      parse("a.vtk", legacy(kPoints + "POLYGONS 1 5\n4 0 1 2 3\nCELL_DATA 1\nSCALARS c int 1\nLOOKUP_TABLE t\n7\n"
                                      "LOOKUP_TABLE t 2\n0 0 0 1\n1 1 1 1\nPOINT_DATA 4\nSCALARS s double\n"
                                      "LOOKUP_TABLE default\n1 2\n3 4\nNORMALS n float\n0 0 1 0 0 1 0 0 1 1 0 0\n"
                                      "FIELD FieldData 2\nv 3 4 float\n1 2 3 4 5 6 7 8 9 10 11 12\nMETADATA\n"
                                      "COMPONENT_NAMES\nx\n\nnames 1 4 string\na\nb%20c\n\nd\n"));
  EXPECT_EQ(mesh.values, (std::vector<float>{1, 2, 3, 4}));
  ASSERT_EQ(mesh.normals.size(), 4U);
  EXPECT_EQ(mesh.normals[3], (Point{1, 0, 0}));
  for (const char* other : {"cell array 'c'", "point array 'v'", "point array 'names'"}) {
    EXPECT_TRUE(has_note(mesh, other)) << other;
  }
}

TEST(ReadLegacyVtk, ReadsFlatCellsOfUnstructuredGrids) {
  const std::string head = "# vtk DataFile Version 4.2\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n" + kPoints;
  const std::string cells = "CELLS 4 17\n3 0 1 2\n4 0 1 3 2\n2 0 1\n4 0 1 2 3\nCELL_TYPES 4\n";
  EXPECT_EQ(parse("a.vtk", head + cells + "5\n8\n3\n9\n").triangles,
            (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 2, 3}}));
  EXPECT_TRUE(contains(failure("a.vtk", head + cells + "5\n8\n3\n10\n"), "found type 10"));
  EXPECT_TRUE(contains(failure("a.vtk", head + "CELLS 1 4\n3 0 1 2\n"), "a type for each cell"));
}

// Cut off at 84 bytes, a file of zeros is as long as a binary STL without triangles.
TEST(ReadLegacyVtk, LeavesGhostCellsOut) {
  const auto polygons = [](const std::string& ghosts) {
    return "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n"
           "VERTICES 1 2\n1 0\nPOLYGONS 2 8\n3 0 1 2\n3 0 2 3\nTRIANGLE_STRIPS 2 8\n3 0 1 3\n3 3 1 2\nCELL_DATA " +
           ghosts;
  };
  const std::string field = "5\nFIELD FieldData 1\nvtkGhostType 1 5 unsigned_char\n";
  const TriangleMesh mesh = parse("a.vtk", polygons(field + "1 0 1 32 2\n"));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 1, 2}}));
  EXPECT_TRUE(has_note(mesh, "2 ghost cells"));
  EXPECT_FALSE(has_note(mesh, "not kept"));
  EXPECT_EQ(parse("a.vtk", polygons(field + "0 0 0 0 0\n")).triangles.size(), 4U);
  EXPECT_TRUE(contains(failure("a.vtk", polygons("2\nFIELD FieldData 1\nvtkGhostType 1 2 unsigned_char\n0 1\n")),
                       "expected a number in 'vtkGhostType' for each of 5 cells, found 2"));
  const TriangleMesh grid =
      parse("a.vtk",
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n"
            "CELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 2\n5 5\nCELL_DATA 2\nFIELD FieldData 1\nvtkGhostType 1 2 "
            "unsigned_char\n1 0\n");
  EXPECT_EQ(grid.triangles, (std::vector<Triangle>{{0, 2, 3}}));
}

TEST(ReadLegacyVtk, IsNotTakenForStlWhereItIsCutOff) {
  std::string cut = "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\nPOINTS 4 float\n";
  cut.resize(84, '\0');
  EXPECT_TRUE(contains(failure("a.vtk", cut), "truncated: expected 12 numbers in 'POINTS'"));
}

TEST(ReadLegacyVtk, RefusesWhatIsWrong) {
  const auto with = [](const std::string& rest) { return failure("a.vtk", legacy(kPoints + rest)); };
  EXPECT_EQ(with("POLYGONS 1 4\n3 0 1 4\n"), "a cell refers to point 4, there are 4");
  EXPECT_TRUE(contains(with("POLYGONS 1 4\n4 0 1 2\n"), "expected 1 cells in 4 numbers"));
  EXPECT_TRUE(contains(with("POLYGONS 1 4000000\n3 0 1 2\n"), "truncated: expected 4000000 numbers"));
  EXPECT_TRUE(contains(with("POLYGONS 3 3\nOFFSETS int\n0 3 2\nCONNECTIVITY int\n0 1 2\n"), "OFFSETS that ascend"));
  EXPECT_TRUE(contains(with("RUBBISH 1 2\n"), "a part of PolyData, found 'RUBBISH'"));
  EXPECT_TRUE(contains(failure("a.vtk", legacy("")), "POINTS of PolyData"));
  EXPECT_TRUE(contains(failure("a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n"),
                       "DATASET POLYDATA or UNSTRUCTURED_GRID of a mesh, found 'STRUCTURED_POINTS'"));
  EXPECT_TRUE(contains(failure("a.vtk", "hello"), "# vtk DataFile Version"));
}

TEST(ReadVtp, SurvivesDamage) {
  const std::string data = "<PointData Scalars=\"s\">" + array("type=\"UInt8\" Name=\"s\"", "1 2 3 4") + "</PointData>";
  foreign::expect_damage_is_safe(
      "a.vtp", vtp(piece("NumberOfLines=\"1\" NumberOfStrips=\"1\" NumberOfPolys=\"1\"",
                         cells("Lines", "0 1", "2") + cells("Strips", "0 1 3 2", "4") + kSquare, data)));
}

TEST(ReadLegacyVtk, SurvivesDamage) {
  const std::string rest = kPoints +
                           "POLYGONS 2 9\n4 0 1 2 3\n3 0 1 2\nPOINT_DATA 4\nSCALARS s double\nLOOKUP_TABLE default\n"
                           "1 2 3 4\nFIELD f 1\nn 1 4 string\na\nb\nc\nd\n";
  foreign::expect_damage_is_safe("a.vtk", legacy(rest));
  foreign::expect_damage_is_safe(
      "a.vtk", legacy(kPoints + "POLYGONS 2 4\nOFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\n"));
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_vtk_test
