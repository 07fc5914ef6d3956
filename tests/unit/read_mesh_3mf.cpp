// 3MF of other programs: transforms, units, objects made of others, other parts.
#include "foreign_meshes.hpp"
#include "isoweave/measure.hpp"
#include "meshes.hpp"

namespace isoweave::testing::read_mesh_3mf_test {
namespace {

using foreign::contains;
using foreign::has_note;
using foreign::zip_of;

const std::string kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
const std::string kProduction = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";

// The corner of the unit cube as an object.
std::string object(const std::string& id, const std::string& attributes = "") {
  std::string text = "<object id=\"" + id + "\" " + attributes + "><mesh><vertices>";
  for (const Point& p : meshes::tetrahedron().vertices) {
    text += "<vertex x=\"" + std::to_string(p[0]) + "\" y=\"" + std::to_string(p[1]) + "\" z=\"" +
            std::to_string(p[2]) + "\" />";
  }
  text += "</vertices><triangles>";
  for (const auto& t : meshes::tetrahedron().triangles) {
    text += "<triangle v1=\"" + std::to_string(t[0]) + "\" v2=\"" + std::to_string(t[1]) + "\" v3=\"" +
            std::to_string(t[2]) + "\" pid=\"1\"/>";
  }
  return text + "</triangles></mesh></object>";
}

std::string model(const std::string& resources, const std::string& build, const std::string& attributes = "") {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model " + attributes + " xmlns=\"" + kCore + "\" xmlns:p=\"" +
         kProduction + "\"><resources>" + resources + "</resources><build>" + build + "</build></model>";
}

TriangleMesh read(const std::string& model) { return foreign::parse("a.3mf", zip_of({{"3D/3dmodel.model", model}})); }

std::string refusal(const std::string& model) {
  return foreign::failure("a.3mf", zip_of({{"3D/3dmodel.model", model}}));
}

TEST(Read3mf, PlacesTheItem) {
  const TriangleMesh mesh = read(model(object("1"), "<item objectid=\"1\" transform=\"2 0 0 0 3 0 0 0 4 50 60 -7\"/>"));
  EXPECT_EQ(mesh.vertices, (std::vector<Point>{{50, 60, -7}, {52, 60, -7}, {50, 63, -7}, {50, 60, -3}}));
  EXPECT_EQ(mesh.triangles, meshes::tetrahedron().triangles);
  EXPECT_EQ(mesh.unit, "mm") << "the unit of a file that names none";
  EXPECT_TRUE(mesh.notes.empty()) << mesh.notes.front();
}

// Points are rows that are multiplied from the left: x goes to (0, 2, 0) and not y to it.
TEST(Read3mf, TurnsAsRowsDo) {
  const TriangleMesh mesh = read(model(object("1"), "<item objectid=\"1\" transform=\"0 2 0 -1 0 0 0 0 1 0 0 0\"/>"));
  EXPECT_EQ(mesh.vertices[1], (Point{0, 2, 0}));
  EXPECT_EQ(mesh.vertices[2], (Point{-1, 0, 0}));
}

TEST(Read3mf, TakesComponentsBeforeTheirObject) {
  const std::string components =
      "<object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 1 0 0\"/>"
      "<component objectid=\"1\"/></components></object>"
      "<object id=\"3\"><components><component objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 0 5 0\"/></components>"
      "</object>";
  const TriangleMesh mesh =
      read(model(object("1") + components, "<item objectid=\"3\" transform=\"2 0 0 0 2 0 0 0 2 0 0 100\"/>"));
  ASSERT_EQ(mesh.vertices.size(), 8U);
  EXPECT_EQ(mesh.vertices[0], (Point{2, 10, 100})) << "moved by 1 and 5, then doubled, then moved by 100";
  EXPECT_EQ(mesh.vertices[4], (Point{0, 10, 100}));
  EXPECT_EQ(mesh.triangles[4], (meshes::Triangle{4, 6, 5}));
  EXPECT_TRUE(has_note(mesh, "2 objects are joined"));
}

TEST(Read3mf, TurnsMirroredTrianglesOver) {
  const TriangleMesh mesh = read(model(object("1"), "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>"));
  EXPECT_EQ(mesh.vertices[1], (Point{-1, 0, 0}));
  EXPECT_NEAR(check_mesh(mesh).volume, 1.0 / 6, 1e-7) << "the outside stays outside";
}

TEST(Read3mf, KeepsOrConvertsUnits) {
  const auto of = [](const std::string& unit) {
    return read(model(object("1"), "<item objectid=\"1\"/>", "unit=\"" + unit + "\""));
  };
  for (const auto& [name, unit, side] : {std::tuple("micron", "um", 1.0F),
                                         {"millimeter", "mm", 1.0F},
                                         {"centimeter", "mm", 10.0F},
                                         {"inch", "in", 1.0F},
                                         {"foot", "in", 12.0F},
                                         {"meter", "m", 1.0F}}) {
    const TriangleMesh mesh = of(name);
    EXPECT_EQ(mesh.unit, unit) << name;
    EXPECT_EQ(mesh.vertices[1], (Point{side, 0, 0})) << name;
    EXPECT_EQ(has_note(mesh, "units of " + std::string(name) + ", read as " + unit), side != 1) << name;
  }
  EXPECT_EQ(refusal(model(object("1"), "<item objectid=\"1\"/>", "unit=\"furlong\"")),
            "expected a unit of 3MF, found 'furlong'");
}

TEST(Read3mf, KeepsItsOwnUnits) {
  for (const std::string unit : {"nm", "um", "mm", "m", "in", ""}) {
    const files::Folder folder;
    write_mesh(folder / "a.3mf", meshes::tetrahedron(), {.comments = {}, .unit = unit, .space = "RAS"});
    const TriangleMesh mesh = read_mesh(folder / "a.3mf");
    EXPECT_EQ(mesh.unit, unit);
    EXPECT_EQ(mesh.space, "RAS");
    EXPECT_EQ(mesh.vertices, meshes::tetrahedron().vertices) << unit;
  }
}

// As slicers that keep projects write them: the root has only components.
TEST(Read3mf, ReadsObjectsInOtherParts) {
  const std::string root = model(
      "<object id=\"8\"><components><component p:path=\"/3D/Objects/Cube_1.model\" objectid=\"1\" "
      "transform=\"1 0 0 0 1 0 0 0 1 0 0 9\"/></components></object>",
      "<item objectid=\"8\"/>", "requiredextensions=\"p\"");
  const std::string relations =
      "<Relationships><Relationship Target=\"/3D/3dmodel.model\" Id=\"r\" "
      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";
  const std::vector<std::pair<std::string, std::string>> parts{
      {"3D/Objects/cube_1.model", model(object("1"), "")}, {"_rels/.rels", relations}, {"3D/3dmodel.model", root}};
  EXPECT_EQ(foreign::parse("a.3mf", zip_of(parts)).vertices[0], (Point{0, 0, 9}));
  EXPECT_EQ(foreign::failure("a.3mf", zip_of({parts[1], parts[2]})),
            "expected an entry '3d/objects/cube_1.model' in the archive, found none");
}

TEST(Read3mf, ReadsWhatIsOddButRight) {
  const std::string item = "<item objectid=\"1\"/>";
  const std::string comment =
      "<!-- <vertex x=\"1\" y=\"1\" z=\"1\"/> --><metadata name=\"a > b\"><![CDATA[<mesh>]]></metadata>";
  EXPECT_EQ(read(model(comment + object("1"), item)).vertices.size(), 4U);
  EXPECT_EQ(read(model("<s:vertex xmlns:s=\"slices\" x=\"1\"/>" + object("1"), item)).vertices.size(), 4U);
  const std::string archive = zip_of({{"3D/3dmodel.model", model(object("1"), item)}});
  std::string commented = archive + "a comment";
  commented[archive.size() - 2] = 9;
  EXPECT_EQ(foreign::parse("a.3mf", commented).vertices.size(), 4U);
  const TriangleMesh unbuilt = read(model(object("1"), ""));
  EXPECT_EQ(unbuilt.vertices.size(), 4U);
  EXPECT_TRUE(has_note(unbuilt, "all objects are read"));
  const TriangleMesh modified =
      read(model(object("1") + object("2", "type=\"other\""), item + "<item objectid=\"2\"/>"));
  EXPECT_EQ(modified.vertices.size(), 4U);
  EXPECT_TRUE(has_note(modified, "left out: 1 objects of type other"));
}

TEST(Read3mf, ReadsPrefixedElements) {
  std::string text = object("1");
  for (const std::string name : {"object", "mesh", "vertices", "vertex ", "triangles", "triangle "}) {
    for (std::size_t at = text.find("<" + name); at != text.npos; at = text.find("<" + name, at + 1)) {
      text.insert(at + 1, "c:");
    }
  }
  const std::string prefixed = "<c:model xmlns:c=\"" + kCore + "\"><c:resources>" + text +
                               "</c:resources><c:build><c:item objectid=\"1\"/></c:build></c:model>";
  EXPECT_EQ(read(prefixed).triangles.size(), 4U);
}

TEST(Read3mf, RefusesWhatItCannotPlace) {
  const std::string item = "<item objectid=\"1\"/>";
  EXPECT_EQ(refusal(model(object("1"), "<item objectid=\"2\"/>")), "expected an object 2, found none");
  EXPECT_TRUE(contains(refusal(model(object("1"), "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 0 0 0 0\"/>")),
                       "a transform that can be undone"));
  EXPECT_TRUE(contains(refusal(model(object("1"), "<item objectid=\"1\" transform=\"1 0 0\"/>")), "twelve numbers"));
  EXPECT_TRUE(contains(refusal(model(object("1") + object("1"), item)), "objects of different ids"));
  EXPECT_TRUE(
      contains(refusal(model("<object id=\"1\"><components><component objectid=\"1\"/></components></object>", item)),
               "up to 64 deep"));
  EXPECT_TRUE(contains(refusal(model(object("1"), item, "requiredextensions=\"b\" xmlns:b=\"http://beams\"")),
                       "requires 'http://beams'"));
  EXPECT_TRUE(contains(refusal(model(object("1", "type=\"support\""), item)), "objects that are models"));
  EXPECT_TRUE(contains(refusal("\xff\xfe<"), "UTF-8"));
}

// Twenty levels of two components each would be a million copies.
TEST(Read3mf, RefusesCopiesOutOfProportion) {
  std::string objects = object("1");
  for (int id = 2; id <= 21; ++id) {
    const std::string part = "<component objectid=\"" + std::to_string(id - 1) + "\"/>";
    objects += "<object id=\"" + std::to_string(id) + "\"><components>" + part + part + "</components></object>";
  }
  EXPECT_TRUE(contains(refusal(model(objects, "<item objectid=\"21\"/>")), "found more"));
  EXPECT_TRUE(contains(refusal(model(objects, "<item objectid=\"20\"/>")), "copies of objects in proportion"));
}

TEST(Read3mf, SurvivesDamage) {
  const std::string components =
      "<object id=\"2\"><components><component objectid=\"1\" transform=\"1 0 0 0 -1 0 0 0 1 1 0 0\"/>"
      "<component objectid=\"1\"/></components></object>";
  const std::string text = model(object("1") + components, "<item objectid=\"2\"/>");
  foreign::expect_damage_is_safe("a.3mf", zip_of({{"3D/3dmodel.model", text}}));
  // Under a checksum that fits.
  std::mt19937_64 random(3);
  for (int round = 0; round < 1500; ++round) {
    std::string damaged = text;
    damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    try {
      read(damaged);
    } catch (const BadInput& error) {
      EXPECT_FALSE(contains(error.what(), "\n")) << error.what();
    }
  }
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_3mf_test
