// GLB and glTF of other programs: nodes, accessors of every type, and what is refused.
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "foreign_meshes.hpp"
#include "isoweave/measure.hpp"
#include "meshes.hpp"

namespace isoweave::testing::read_mesh_gltf_test {
namespace {

using foreign::contains;
using foreign::has_note;
using foreign::raw;
using Json = nlohmann::json;

constexpr int kByte = 5120, kUbyte = 5121, kShort = 5122, kUshort = 5123, kUint = 5125, kFloat = 5126;

// A scene and its data, which accessors are added to.
struct Gltf {
  Json scene = {{"asset", {{"version", "2.0"}, {"generator", "another"}}}};
  std::string data;

  // An accessor of `count` elements over these bytes, in a view of its own.
  int add(const std::string& bytes, int component, std::size_t count, const char* type, const Json& more = {},
          int stride = 0) {
    while (data.size() % 4 != 0) data += '\0';
    Json view{{"buffer", 0}, {"byteOffset", data.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) view["byteStride"] = stride;
    scene["bufferViews"].push_back(view);
    data += bytes;
    Json accessor{{"bufferView", scene["bufferViews"].size() - 1},
                  {"componentType", component},
                  {"count", count},
                  {"type", type}};
    if (more.is_object()) accessor.update(more);
    scene["accessors"].push_back(accessor);
    return static_cast<int>(scene["accessors"].size()) - 1;
  }

  int add_points(const std::vector<Point>& points) {
    std::string bytes;
    for (const Point& p : points) bytes += raw(p);
    return add(bytes, kFloat, points.size(), "VEC3");
  }

  // A mesh of the corner of the unit cube; its number.
  int add_tetrahedron() {
    std::string bytes;
    for (const auto& t : meshes::tetrahedron().triangles) {
      for (const std::uint32_t v : t) bytes += raw(static_cast<std::uint16_t>(v));
    }
    const int points = add_points(meshes::tetrahedron().vertices);
    const int indices = add(bytes, kUshort, 12, "SCALAR");
    return add_mesh({{{"attributes", {{"POSITION", points}}}, {"indices", indices}}});
  }

  int add_mesh(const Json& primitives) {
    scene["meshes"].push_back({{"primitives", primitives}});
    return static_cast<int>(scene["meshes"].size()) - 1;
  }

  void show(const Json& nodes) {
    scene["nodes"] = nodes;
    scene["scenes"] = {{{"nodes", {0}}}};
    scene["scene"] = 0;
  }

  std::string glb() const {
    Json all = scene;
    all["buffers"] = {{{"byteLength", data.size()}}};
    std::string text = all.dump();
    while (text.size() % 4 != 0) text += ' ';
    const auto bytes = [](std::size_t n) { return raw(static_cast<std::uint32_t>(n)); };
    return "glTF" + bytes(2) + bytes(28 + text.size() + data.size()) + bytes(text.size()) + "JSON" + text +
           bytes(data.size()) + std::string("BIN\0", 4) + data;
  }
};

TriangleMesh read(const Gltf& gltf) { return foreign::parse("a.glb", gltf.glb()); }
std::string refusal(const Gltf& gltf) { return foreign::failure("a.glb", gltf.glb()); }

TEST(ReadGltf, PlacesMeshesByTheirNodes) {
  Gltf gltf;
  const int mesh = gltf.add_tetrahedron();
  // A quarter turn about z, doubled before and moved after; then doubled along y and moved by a matrix.
  const double half = std::sqrt(0.5);
  gltf.show({{{"children", {1}}, {"matrix", {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 100, 1}}},
             {{"mesh", mesh}, {"scale", {2, 2, 2}}, {"rotation", {0, 0, half, half}}, {"translation", {10, 0, 0}}}});
  const TriangleMesh found = read(gltf);
  ASSERT_EQ(found.vertices.size(), 4U);
  const std::vector<Point> right{{10, 0, 100}, {10, 4, 100}, {8, 0, 100}, {10, 0, 102}};
  for (std::size_t v = 0; v < 4; ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(found.vertices[v][axis], right[v][axis], 1e-5) << v;
  }
  EXPECT_EQ(found.triangles, meshes::tetrahedron().triangles);
  EXPECT_EQ(found.unit, "m");
  EXPECT_EQ(found.space, "");
  EXPECT_TRUE(has_note(found, "y up"));
}

TEST(ReadGltf, JoinsMeshesAndTurnsMirroredOnesOver) {
  Gltf gltf;
  const int mesh = gltf.add_tetrahedron();
  gltf.show(
      {{{"children", {1, 2}}}, {{"mesh", mesh}, {"scale", {-1, 1, 1}}}, {{"mesh", mesh}, {"translation", {5, 0, 0}}}});
  const TriangleMesh found = read(gltf);
  EXPECT_EQ(found.vertices.size(), 8U);
  EXPECT_NEAR(check_mesh(found).volume, 2.0 / 6, 1e-6);
  EXPECT_EQ(check_mesh(found).misoriented_edges, 0U);
}

// A scene with three copies of a tetrahedron, in a node that is moved along z.
Gltf three_copies() {
  Gltf gltf;
  const int mesh = gltf.add_tetrahedron();
  const int shifts = gltf.add_points({{0, 0, 0}, {10, 0, 0}, {20, 0, 0}});
  const int scales = gltf.add_points({{1, 1, 1}, {2, 2, 2}, {1, 1, -1}});
  // The second one is turned by a quarter about z; numbers of 8 bits with a sign.
  const std::string turns = {0, 0, 0, 127, 0, 0, 90, 90, 0, 0, 0, 127};
  const int rotations = gltf.add(turns, kByte, 3, "VEC4", {{"normalized", true}});
  gltf.show({{{"mesh", mesh}, {"translation", {0, 0, 100}}}});
  gltf.scene["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", shifts}, {"SCALE", scales}, {"ROTATION", rotations}, {"_ID", 99}};
  gltf.scene["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  return gltf;
}

TEST(ReadGltf, PlacesCopiesByTheListsOfTheirNode) {
  const TriangleMesh found = read(three_copies());
  ASSERT_EQ(found.vertices.size(), 12U);
  const std::vector<Point> right{{0, 0, 100}, {1, 0, 100},  {0, 1, 100},  {0, 0, 101},  {10, 0, 100}, {10, 2, 100},
                                 {8, 0, 100}, {10, 0, 102}, {20, 0, 100}, {21, 0, 100}, {20, 1, 100}, {20, 0, 99}};
  for (std::size_t v = 0; v < 12; ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(found.vertices[v][axis], right[v][axis], 1e-5) << v;
  }
  EXPECT_NEAR(check_mesh(found).volume, 10.0 / 6, 1e-6);
  EXPECT_EQ(check_mesh(found).misoriented_edges, 0U);
  EXPECT_TRUE(has_note(found, "3 meshes are joined"));
}

TEST(ReadGltf, RefusesCopiesWithoutAPlace) {
  for (const int count : {0, 2}) {
    Gltf gltf = three_copies();
    Json& copies = gltf.scene["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    gltf.scene["accessors"][copies["SCALE"].get<std::size_t>()]["count"] = count;
    if (count == 0) copies = {{"SCALE", copies["SCALE"]}};
    EXPECT_TRUE(contains(refusal(gltf), "places for all copies of a mesh")) << count;
  }
  foreign::expect_damage_is_safe("a.glb", three_copies().glb());
}

TEST(ReadGltf, ReadsIndicesOfEveryTypeAndNone) {
  for (const int component : {kUbyte, kUshort, kUint, 0}) {
    Gltf gltf;
    Json primitive{{"attributes", {{"POSITION", gltf.add_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})}}}};
    const std::uint32_t order[] = {2, 0, 1};
    std::string bytes;
    for (const std::uint32_t n : order) {
      bytes += component == kUbyte    ? raw(static_cast<std::uint8_t>(n))
               : component == kUshort ? raw(static_cast<std::uint16_t>(n))
                                      : raw(n);
    }
    if (component != 0) primitive["indices"] = gltf.add(bytes, component, 3, "SCALAR");
    gltf.show({{{"mesh", gltf.add_mesh(Json::array({primitive}))}}});
    const meshes::Triangle right = component == 0 ? meshes::Triangle{0, 1, 2} : meshes::Triangle{2, 0, 1};
    EXPECT_EQ(read(gltf).triangles, std::vector{right}) << component;
  }
}

// The corners of a strip in a plane, all to be seen from above.
TEST(ReadGltf, ReadsStripsAndFans) {
  Gltf gltf;
  const int strip = gltf.add_points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}});
  const int fan = gltf.add_points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const int joined = gltf.add(std::string("\0\1\2\2\3\3", 6), kUbyte, 6, "SCALAR");
  const int points = gltf.add_points({{9, 9, 9}});
  gltf.show({{{"mesh", gltf.add_mesh({{{"attributes", {{"POSITION", strip}}}, {"mode", 5}},
                                      {{"attributes", {{"POSITION", fan}}}, {"mode", 6}},
                                      {{"attributes", {{"POSITION", strip}}}, {"mode", 5}, {"indices", joined}},
                                      {{"attributes", {{"POSITION", points}}}, {"mode", 0}},
                                      {{"attributes", {{"POSITION", points}}}, {"mode", 3}}})}}});
  const TriangleMesh found = read(gltf);
  EXPECT_EQ(found.triangles,
            (std::vector<meshes::Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}, {5, 6, 7}, {5, 7, 8}, {0, 1, 2}}));
  EXPECT_EQ(found.vertices.size(), 9U) << "the third one shares the vertices of the first";
  EXPECT_TRUE(has_note(found, "1 sets of points"));
  EXPECT_TRUE(has_note(found, "1 sets of lines"));
}

TEST(ReadGltf, ReadsInterleavedAndNormalizedNumbers) {
  Gltf gltf;
  std::string bytes;
  for (const Point& p : {Point{0, 0, 0}, Point{1, 0, 0}, Point{0, 1, 0}}) bytes += raw(p) + raw(Point{0, 0, 1});
  gltf.add(bytes, kFloat, 3, "VEC3", {}, 24);
  // The normals lie in the same view.
  gltf.scene["accessors"].push_back(
      {{"bufferView", 0}, {"byteOffset", 12}, {"componentType", kFloat}, {"count", 3}, {"type", "VEC3"}});
  std::string shorts, signs;
  for (const int n : {0, 0, 0, 32767, 0, 0, 0, -32767, 0}) shorts += raw(static_cast<std::int16_t>(n));
  for (const int n : {0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}) signs += raw(static_cast<std::int8_t>(n));
  const int quantized = gltf.add(shorts, kShort, 3, "VEC3", {{"normalized", true}});
  const int directions = gltf.add(signs, kByte, 3, "VEC3", {{"normalized", true}}, 4);
  gltf.scene["extensionsRequired"] = {"KHR_mesh_quantization"};
  gltf.show({{{"mesh", gltf.add_mesh({{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}},
                                      {{"attributes", {{"POSITION", quantized}, {"NORMAL", directions}}}}})},
              {"scale", {2, 2, 4}}}});
  const TriangleMesh found = read(gltf);
  EXPECT_EQ(found.vertices, (std::vector<Point>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 0}, {2, 0, 0}, {0, -2, 0}}));
  ASSERT_EQ(found.normals.size(), 6U);
  EXPECT_EQ(found.normals[1], (Point{0, 0, 1}));
  EXPECT_EQ(found.normals[3], (Point{0, 0, 1}));
}

TEST(ReadGltf, ReadsTextWithItsDataInIt) {
  Gltf gltf;
  gltf.show({{{"mesh", gltf.add_mesh({{{"attributes", {{"POSITION", 0}}}}})}}});
  gltf.scene["bufferViews"] = {{{"buffer", 0}, {"byteLength", 36}}};
  gltf.scene["accessors"] = {{{"bufferView", 0}, {"componentType", kFloat}, {"count", 3}, {"type", "VEC3"}}};
  // (0, 0, 0), (1, 0, 0), (0, 1, 0)
  gltf.scene["buffers"] = {
      {{"byteLength", 36},
       {"uri", "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}};
  const TriangleMesh found = foreign::parse("a.gltf", gltf.scene.dump(2));
  EXPECT_EQ(found.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  gltf.scene["buffers"][0]["uri"] = "data:text/plain,abc";
  EXPECT_EQ(foreign::failure("a.gltf", gltf.scene.dump()),
            "expected data in base64 or the name of a file, found 'data:text/plain,abc'");
}

// A scene of a tetrahedron whose data are in a file of this name.
std::string scene_beside(const std::string& uri, std::string& data) {
  Gltf gltf;
  gltf.show({{{"mesh", gltf.add_tetrahedron()}}});
  gltf.scene["buffers"] = {{{"byteLength", gltf.data.size()}, {"uri", uri}}};
  data = gltf.data;
  return gltf.scene.dump();
}

TEST(ReadGltf, ReadsDataInAFileBesideIt) {
  const files::Folder folder;
  std::filesystem::create_directory(folder / "data");
  std::string data;
  const std::vector<std::pair<std::string, std::string>> names{
      {"a.bin", "a.bin"},           {"data/a.bin", "data/a.bin"},
      {"./data/../b.bin", "b.bin"}, {"a%20b%c3%a9.bin", "a b\xc3\xa9.bin"},
      {"50%.bin", "50%.bin"},       {folder / "c.bin", "c.bin"}};
  for (const auto& [uri, name] : names) {
    files::write_bytes(folder / "a.gltf", scene_beside(uri, data));
    files::write_bytes(folder / name, data);
    const TriangleMesh mesh = read_mesh(folder / "a.gltf");
    EXPECT_EQ(mesh.vertices, meshes::tetrahedron().vertices) << uri;
    EXPECT_EQ(mesh.triangles, meshes::tetrahedron().triangles) << uri;
    EXPECT_THROW(read_mesh(folder / "a.gltf", {.external = false}), BadInput) << uri;
  }
}

// The first number may have the bytes that gzip begins with.
TEST(ReadGltf, TakesDataBesideItAsTheyAre) {
  const files::Folder folder;
  std::string data;
  const std::string scene = scene_beside("a.bin", data);
  data.replace(0, 4, "\x1f\x8b\x08\x3f");
  files::write_bytes(folder / "a.gltf", scene);
  files::write_bytes(folder / "a.bin", data);
  EXPECT_NEAR(read_mesh(folder / "a.gltf").vertices[0][0], 0.533, 1e-3);
}

TEST(ReadGltf, RefusesDataInFilesThatAreNotAsTheSceneSays) {
  const files::Folder folder;
  std::string data;
  const auto refusal_with = [&](const std::string& uri, const ReadMeshOptions& options) {
    files::write_bytes(folder / "a.gltf", scene_beside(uri, data));
    try {
      read_mesh(folder / "a.gltf", options);
    } catch (const BadInput& error) {
      return std::string(error.what()).substr(folder.path().size() + 1);
    }
    return std::string("nothing thrown");
  };
  EXPECT_EQ(refusal_with("a.bin", {}),
            "a.gltf: expected a part of the mesh in " + folder / "a.bin" + ", found no such file");
  EXPECT_EQ(refusal_with("a.bin", {.external = false}),
            "a.gltf: expected a file that names no other, as --no-external asks, found 'a.bin'");
  EXPECT_EQ(refusal_with("http://x.org/a.bin", {}),
            "a.gltf: expected data in base64 or the name of a file, found 'http://x.org/a.bin'");
  files::write_bytes(folder / "a.bin", "");
  EXPECT_EQ(refusal_with("a.bin", {}), "a.bin: expected the data of a mesh, found an empty file");
  files::write_bytes(folder / "a.bin", data.substr(0, data.size() - 1));
  EXPECT_TRUE(contains(refusal_with("a.bin", {}), "a.gltf: expected 24 bytes from byte 48 of a buffer, found 71 bytes"))
      << refusal_with("a.bin", {});
}

// Data in Draco for those that know it, and plain ones for all others.
TEST(ReadGltf, DracoThatIsNotRequiredIsPassedOver) {
  Gltf gltf;
  gltf.show({{{"mesh", gltf.add_tetrahedron()}}});
  gltf.scene["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  gltf.scene["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  EXPECT_EQ(read(gltf).triangles, meshes::tetrahedron().triangles);
  gltf.scene["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  EXPECT_TRUE(contains(refusal(gltf), "KHR_draco_mesh_compression"));
}

TEST(ReadGltf, RefusesWhatItDoesNotRead) {
  const auto with = [](const std::function<void(Gltf&)>& change) {
    Gltf gltf;
    gltf.show({{{"mesh", gltf.add_tetrahedron()}}});
    EXPECT_EQ(read(gltf).triangles.size(), 4U);
    change(gltf);
    return refusal(gltf);
  };
  const auto primitive = [](Gltf& gltf) -> Json& { return gltf.scene["meshes"][0]["primitives"][0]; };
  EXPECT_TRUE(contains(with([&](Gltf& g) {
                         primitive(g)["extensions"]["KHR_draco_mesh_compression"] = Json::object();
                         g.scene["accessors"][0].erase("bufferView");
                       }),
                       "KHR_draco_mesh_compression"));
  EXPECT_TRUE(contains(
      with([&](Gltf& g) { g.scene["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = Json::object(); }),
      "not as glTF has it"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["extensionsRequired"] = {"EXT_other"}; }), "'EXT_other'"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["accessors"][0]["sparse"] = Json::object(); }), "a sparse one"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["accessors"][0].erase("bufferView"); }), "found one without"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["accessors"][0]["count"] = 5; }), "5 numbers within their view"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["accessors"][0]["count"] = -1; }), "a whole number as count"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["accessors"][0]["count"] = 1e300; }), "a whole number as count"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["bufferViews"][0]["byteOffset"] = 4000; }), "from byte 4000"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["accessors"][0]["type"] = "VEC2"; }), "type VEC3, found 'VEC2'"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["nodes"][0]["children"] = {0}; }), "nodes that form trees"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["nodes"][0]["mesh"] = 7; }), "number 7 of 'meshes'"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["nodes"][0]["scale"] = {1, 1}; }), "3 numbers as scale"));
  EXPECT_TRUE(
      contains(with([&](Gltf& g) { g.scene["scenes"][0]["nodes"] = Json::array(); }), "triangles in the scene"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { primitive(g)["mode"] = 0; }), "triangles in the scene"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.scene["asset"]["version"] = "1.0"; }), "glTF 2, found version '1.0'"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { primitive(g)["indices"] = primitive(g)["attributes"]["POSITION"]; }),
                       "type SCALAR"));
  EXPECT_TRUE(contains(with([&](Gltf& g) { g.data[48] = 9; }), "refers to vertex 9, its mesh has 4"));
}

TEST(ReadGltf, SurvivesDamage) {
  Gltf gltf;
  const int mesh = gltf.add_tetrahedron();
  gltf.show({{{"children", {1}}, {"mesh", mesh}}, {{"mesh", mesh}, {"scale", {2, 2, -2}}, {"rotation", {0, 0, 1, 0}}}});
  foreign::expect_damage_is_safe("a.glb", gltf.glb());
}

// Two thousand nodes that show one mesh of two thousand vertices.
TEST(ReadGltf, RefusesCopiesOutOfProportion) {
  Gltf gltf;
  std::vector<Point> many;
  for (int n = 0; n < 2000; ++n) many.push_back({static_cast<float>(n), static_cast<float>(n % 2), 0});
  const int mesh = gltf.add_mesh({{{"attributes", {{"POSITION", gltf.add_points(many)}}}, {"mode", 5}}});
  Json nodes = {{{"children", Json::array()}}};
  for (int n = 1; n <= 2000; ++n) {
    nodes[0]["children"].push_back(n);
    nodes.push_back({{"mesh", mesh}});
  }
  gltf.show(nodes);
  EXPECT_TRUE(contains(refusal(gltf), "in proportion to the file"));
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_gltf_test
