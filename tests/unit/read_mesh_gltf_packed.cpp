// GLB packed by meshoptimizer, read back.
#include <gtest/gtest.h>

#ifdef ISOWEAVE_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>

#include <cstring>
#include <functional>
#include <nlohmann/json.hpp>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "mesh_file_helpers.hpp"
#include "packed_meshes.hpp"

namespace isoweave::testing::read_mesh_gltf_packed_test {
namespace {

using namespace packed;
using Json = nlohmann::json;

constexpr std::size_t kHeader = 20, kChunkHeader = 8;

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

std::string word(std::size_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  return {reinterpret_cast<const char*>(&bits), sizeof bits};
}

std::string glb(const Json& scene, const std::string& data) {
  std::string text = scene.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return "glTF" + word(2) + word(kHeader + text.size() + kChunkHeader + data.size()) + word(text.size()) + "JSON" +
         text + word(data.size()) + std::string("BIN\0", 4) + data;
}

// The file with another scene around the same data.
void change_scene(const std::string& path, const std::function<void(Json&)>& change) {
  const std::string bytes = files::read_bytes(path);
  const std::size_t length = word_at(bytes, 12);
  Json scene = Json::parse(bytes.substr(kHeader, length));
  change(scene);
  files::write_bytes(path, glb(scene, bytes.substr(kHeader + length + kChunkHeader)));
}

double rounding_error(const std::string& path) {
  double error = 0;
  change_scene(path, [&](Json& scene) { error = scene["asset"]["extras"]["rounding_error"]; });
  return error;
}

TEST(ReadPackedGlb, IsTheMeshWithinItsRounding) {
  for (const char* space : {"LPS", "RAS", ""}) {
    for (const std::array<double, 3>& offset : {std::array<double, 3>{}, {1000, -2000.5, 3}}) {
      const files::Folder folder;
      TriangleMesh mesh = sheet();
      mesh.normals.assign(mesh.vertices.size(), {0, 0.6F, -0.8F});
      MeshFileOptions options = packed_options();
      options.normals = true;
      options.space = space;
      options.unit = "um";
      options.offset = offset;
      write(folder / "a.glb", mesh, options);
      const TriangleMesh found = read_mesh(folder / "a.glb");
      EXPECT_EQ(found.vertices.size(), mesh.vertices.size() - 1);  // one is of no triangle
      expect_close(corners_of(found), corners_of(mesh), 1.01 * rounding_error(folder / "a.glb"));
      EXPECT_EQ(found.space, space);
      EXPECT_EQ(found.unit, "um");
      EXPECT_EQ(found.offset, offset);
      ASSERT_EQ(found.normals.size(), found.vertices.size());
      EXPECT_NEAR(found.normals[0][1], 0.6, 0.01);
      EXPECT_NEAR(found.normals[0][2], -0.8, 0.01);
    }
  }
}

// As the file of another program: where the nodes place it.
TEST(ReadPackedGlb, LiesWhereItsNodesSay) {
  const files::Folder folder;
  MeshFileOptions options = packed_options();
  options.offset = {10, 20, 30};
  write(folder / "packed.glb", sheet(), options);
  options.compress = false;
  write(folder / "plain.glb", sheet(), options);
  for (const char* name : {"packed.glb", "plain.glb"}) {
    change_scene(folder / name, [](Json& scene) { scene["asset"]["generator"] = "another"; });
  }
  const auto in_millimetres = [](TriangleMesh mesh) {
    for (Point& p : mesh.vertices) p = {p[0] * 1000, p[1] * 1000, p[2] * 1000};
    return corners_of(mesh);
  };
  expect_close(in_millimetres(read_mesh(folder / "packed.glb")), in_millimetres(read_mesh(folder / "plain.glb")),
               1.01 * rounding_error(folder / "packed.glb"));
}

// Filters and modes of other programs.
TEST(ReadPackedGlb, TakesFiltersAndSequences) {
  const TriangleMesh mesh = meshes::grid(5);
  std::vector<std::array<float, 3>> points(mesh.vertices.begin(), mesh.vertices.end());
  std::vector<std::array<std::uint32_t, 3>> filtered(points.size());
  meshopt_encodeFilterExp(filtered.data(), points.size(), 12, 20, points.front().data());
  std::string data(meshopt_encodeVertexBufferBound(points.size(), 12), '\0');
  data.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(data.data()), data.size(), filtered.data(),
                                         points.size(), 12));
  const std::size_t vertex_bytes = data.size();
  std::vector<std::uint32_t> corners;
  for (const auto& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  std::string sequence(meshopt_encodeIndexSequenceBound(corners.size(), points.size()), '\0');
  sequence.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(sequence.data()), sequence.size(),
                                              corners.data(), corners.size()));
  const auto view = [](std::size_t at, std::size_t bytes, std::size_t count, int stride, const char* mode) {
    return Json{{"buffer", 0},  {"byteOffset", at}, {"byteLength", bytes},
                {"mode", mode}, {"count", count},   {"byteStride", stride}};
  };
  Json scene;
  scene["asset"] = {{"version", "2.0"}};
  Json vertices = view(0, vertex_bytes, points.size(), 12, "ATTRIBUTES");
  vertices["filter"] = "EXPONENTIAL";
  scene["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = vertices;
  scene["bufferViews"][1]["extensions"]["KHR_meshopt_compression"] =
      view(vertex_bytes, sequence.size(), corners.size(), 4, "INDICES");
  scene["accessors"][0] = {{"bufferView", 0}, {"componentType", 5126}, {"count", points.size()}, {"type", "VEC3"}};
  scene["accessors"][1] = {{"bufferView", 1}, {"componentType", 5125}, {"count", corners.size()}, {"type", "SCALAR"}};
  scene["meshes"][0]["primitives"][0] = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}};
  scene["nodes"][0]["mesh"] = 0;
  scene["buffers"][0]["byteLength"] = data.size() + sequence.size();
  const files::Folder folder;
  files::write_bytes(folder / "a.glb", glb(scene, data + sequence));
  const TriangleMesh found = read_mesh(folder / "a.glb");
  EXPECT_EQ(found.triangles, mesh.triangles);
  expect_close(corners_of(found), corners_of(mesh), 1e-4);
}

// Newer libraries pack in versions that older ones do not read, and both kinds of data are sound.
TEST(ReadPackedGlb, TellsOfAVersionThatIsNotRead) {
  const files::Folder folder;
  write(folder / "a.glb", sheet(), packed_options());
  const std::string good = files::read_bytes(folder / "a.glb");
  const std::size_t length = word_at(good, 12), data = kHeader + length + kChunkHeader;
  const Json scene = Json::parse(good.substr(kHeader, length));
  ASSERT_EQ(scene["bufferViews"].size(), 2U);
  for (const Json& view : scene["bufferViews"]) {
    const Json& packed = view["extensions"]["EXT_meshopt_compression"];
    const std::size_t first = data + packed.value("byteOffset", std::size_t{0});
    std::string changed = good;
    changed[first] = static_cast<char>(changed[first] | 0xf);
    const std::string found = mesh_files::failure("a.glb", changed);
    EXPECT_TRUE(found.starts_with("expected " + packed["mode"].get<std::string>() + " packed in a version")) << found;
    EXPECT_NE(found.find("found version 15"), std::string::npos) << found;
    changed[first] = 0;
    EXPECT_TRUE(mesh_files::failure("a.glb", changed).ends_with("found damaged data"));
  }
}

TEST(ReadPackedGlb, RefusesWhatIsDamaged) {
  const auto refusal = [](const std::function<void(Json & packed)>& change) {
    const files::Folder folder;
    write(folder / "a.glb", sheet(), packed_options());
    change_scene(folder / "a.glb",
                 [&](Json& scene) { change(scene["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]); });
    try {
      read_mesh(folder / "a.glb");
    } catch (const BadInput& error) {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const auto says = [&](const std::function<void(Json & packed)>& change, const std::string& text) {
    const std::string found = refusal(change);
    EXPECT_NE(found.find(text), std::string::npos) << found;
  };
  says([](Json& packed) { packed["byteOffset"] = 4; }, "packed by meshoptimizer, found damaged data");
  says([](Json& packed) { packed["byteLength"] = 9; }, "packed by meshoptimizer, found damaged data");
  says([](Json& packed) { packed["byteLength"] = 1 << 30; }, "bytes from byte 0");
  says([](Json& packed) { packed["mode"] = "OTHER"; }, "found 'OTHER'");
  says([](Json& packed) { packed["filter"] = "OTHER"; }, "'OTHER'");
  says([](Json& packed) { packed["byteStride"] = 3; }, "3 and 'NONE'");
  says([](Json& packed) { packed["count"] = std::uint64_t{1} << 40; }, "in proportion to the file");
  says([](Json& packed) { packed["count"] = 7; }, "expected 7 items packed by meshoptimizer");
  says([](Json& packed) { packed.erase("buffer"); }, "not as glTF has it");
}

}  // namespace
}  // namespace isoweave::testing::read_mesh_gltf_packed_test
#endif
