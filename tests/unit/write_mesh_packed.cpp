// Packed meshes, as their own libraries unpack them. neuroglancer's are in write_octree_mesh.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "meshes.hpp"
#include "packed_meshes.hpp"

#ifdef ISOWEAVE_HAS_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

namespace isoweave::testing::write_mesh_packed_test {
namespace {

using namespace packed;
using Json = nlohmann::json;

#ifdef ISOWEAVE_HAS_MESHOPTIMIZER
std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof(word));
  return word;
}

// The bytes of a view before its packing.
std::vector<unsigned char> unpack(const std::string& bytes, const Json& scene, std::size_t number) {
  const Json& view = scene["bufferViews"][number];
  const Json& packed = view["extensions"]["EXT_meshopt_compression"];
  const std::size_t at = 20 + word_at(bytes, 12) + 8 + packed["byteOffset"].get<std::size_t>();
  const auto count = packed["count"].get<std::size_t>();
  const auto stride = packed["byteStride"].get<std::size_t>();
  const std::string data = bytes.substr(at, packed["byteLength"].get<std::size_t>());
  const auto* in = reinterpret_cast<const unsigned char*>(data.data());
  std::vector<unsigned char> out(count * stride);
  EXPECT_EQ(out.size(), view["byteLength"].get<std::size_t>());
  const int result = packed["mode"] == "TRIANGLES"
                         ? meshopt_decodeIndexBuffer(out.data(), count, stride, in, data.size())
                         : meshopt_decodeVertexBuffer(out.data(), count, stride, in, data.size());
  EXPECT_EQ(result, 0);
  return out;
}

TEST(WritePackedGlb, UnpacksToTheMeshWithinTheErrorTold) {
  for (const bool normals : {false, true}) {
    const files::Folder folder;
    TriangleMesh mesh = sheet();
    if (normals) mesh.normals.assign(mesh.vertices.size(), {0, 0.6F, -0.8F});
    MeshFileOptions options = packed_options();
    options.normals = normals;
    const std::vector<std::string> notes = write(folder / "a.glb", mesh, options);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_NE(notes[0].find("rounded to 1/65535 of the longest side, by at most 0.00027 mm"), std::string::npos)
        << notes[0];

    const std::string bytes = files::read_bytes(folder / "a.glb");
    ASSERT_EQ(word_at(bytes, 8), bytes.size());
    const Json scene = Json::parse(bytes.substr(20, word_at(bytes, 12)));
    const Json& primitive = scene["meshes"][0]["primitives"][0];
    const auto positions = unpack(bytes, scene, 0);
    const auto indices = unpack(bytes, scene, primitive["indices"].get<std::size_t>());
    EXPECT_EQ(positions.size(), 21U * 21 * 8) << "the vertex of no triangle is gone";
    const Json& node = scene["nodes"][1];
    const auto origin = node["translation"].get<std::vector<double>>();
    const auto step = node["scale"].get<std::vector<double>>();
    std::vector<Corners> found(mesh.triangles.size());
    for (std::size_t n = 0; n < indices.size() / 4; ++n) {
      std::uint32_t index = 0;
      std::memcpy(&index, indices.data() + 4 * n, 4);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::uint16_t place = 0;
        std::memcpy(&place, positions.data() + 8 * index + 2 * axis, 2);
        found[n / 3][n % 3][axis] = origin[axis] + step[axis] * place;
      }
    }
    expect_close(corners_of(mesh), sorted(found), scene["asset"]["extras"]["rounding_error"].get<double>());
    if (!normals) continue;
    const auto packed = unpack(bytes, scene, 1);
    EXPECT_EQ(static_cast<signed char>(packed[1]), std::lround(0.6 * 127));
    EXPECT_EQ(static_cast<signed char>(packed[2]), -std::lround(0.8 * 127));
  }
}

TEST(WritePackedGlb, LevelsAreMeshesInStepsOfTheirOwn) {
  const files::Folder folder;
  const std::array<TriangleMesh, 2> levels{sheet(), meshes::grid(2)};
  const std::array<MeshFileOptions, 2> options{packed_options(), packed_options()};
  const auto sinks = open_mesh_levels(folder / "a.glb", options);
  for (const std::size_t level : {1U, 0U}) {
    std::vector<Triangle64> triangles;
    for (const auto& t : levels[level].triangles) triangles.push_back({t[0], t[1], t[2]});
    sinks[level]->append({levels[level].vertices, {}, {}, triangles});
    sinks[level]->finish();
  }
  const std::string bytes = files::read_bytes(folder / "a.glb");
  const Json scene = Json::parse(bytes.substr(20, word_at(bytes, 12)));
  EXPECT_EQ(scene["nodes"][1]["extensions"]["MSFT_lod"]["ids"].dump(), "[2]");
  EXPECT_EQ(scene["extensionsRequired"].size(), 2U) << "whoever does not know the levels sees the finest";
  for (std::size_t level = 0; level < 2; ++level) {
    const Json& level_node = scene["nodes"][1 + level];
    EXPECT_EQ(level_node["scale"], Json({1e-3, 1e-3, 1e-3}));
    const Json& node = scene["nodes"][level_node["children"][0].get<std::size_t>()];
    const Json& primitive = scene["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0];
    const auto view = [&](const Json& accessor) {
      return unpack(bytes, scene, scene["accessors"][accessor.get<std::size_t>()]["bufferView"].get<std::size_t>());
    };
    const auto positions = view(primitive["attributes"]["POSITION"]);
    const auto indices = view(primitive["indices"]);
    std::vector<Corners> found(levels[level].triangles.size());
    ASSERT_EQ(indices.size(), 12 * found.size());
    for (std::size_t n = 0; n < indices.size() / 4; ++n) {
      std::uint32_t index = 0;
      std::memcpy(&index, indices.data() + 4 * n, 4);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::uint16_t place = 0;
        std::memcpy(&place, positions.data() + 8 * index + 2 * axis, 2);
        found[n / 3][n % 3][axis] = node["translation"][axis].get<double>() + node["scale"][axis].get<double>() * place;
      }
    }
    expect_close(corners_of(levels[level]), sorted(found), 0.00027);
  }
}

// Both ends of the line between two parts are rounded alike: there is no gap.
TEST(WritePackedGlb, PartsAreInStepsOfOneGrid) {
  const files::Folder folder;
  const std::array<TriangleMesh, 3> meshes{sheet(), {}, meshes::grid(2)};
  std::vector<MeshPart> parts;
  for (const char* name : {"a", "empty", "b"}) parts.push_back({name, {0.5, 0.5, 0.5, 1}, packed_options()});
  const auto sinks = open_mesh_parts(folder / "a.glb", parts);
  for (std::size_t n = 0; n < 3; ++n) {
    std::vector<Triangle64> triangles;
    for (const auto& t : meshes[n].triangles) triangles.push_back({t[0], t[1], t[2]});
    sinks[n]->append({meshes[n].vertices, {}, {}, triangles});
    sinks[n]->finish();
  }
  EXPECT_EQ(sinks[2]->notes().size(), 1U);
  const std::string bytes = files::read_bytes(folder / "a.glb");
  const Json scene = Json::parse(bytes.substr(20, word_at(bytes, 12)));
  const Json& placed = scene["nodes"][1];
  EXPECT_EQ(placed["children"].dump(), "[2,3,4]");
  EXPECT_FALSE(scene["nodes"][3].contains("mesh"));
  for (const std::size_t n : {0U, 2U}) {
    const Json& node = scene["nodes"][2 + n];
    EXPECT_EQ(node["name"], parts[n].name);
    EXPECT_FALSE(node.contains("scale") || node.contains("translation"));
    const Json& mesh = scene["meshes"][node["mesh"].get<std::size_t>()];
    EXPECT_EQ(mesh["name"], parts[n].name);
    const Json& primitive = mesh["primitives"][0];
    EXPECT_EQ(primitive["material"], n);
    const auto view = [&](const Json& accessor) {
      return unpack(bytes, scene, scene["accessors"][accessor.get<std::size_t>()]["bufferView"].get<std::size_t>());
    };
    const auto positions = view(primitive["attributes"]["POSITION"]);
    const auto indices = view(primitive["indices"]);
    std::vector<Corners> found(meshes[n].triangles.size());
    ASSERT_EQ(indices.size(), 12 * found.size());
    for (std::size_t c = 0; c < indices.size() / 4; ++c) {
      std::uint32_t index = 0;
      std::memcpy(&index, indices.data() + 4 * c, 4);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::uint16_t place = 0;
        std::memcpy(&place, positions.data() + 8 * index + 2 * axis, 2);
        found[c / 3][c % 3][axis] =
            placed["translation"][axis].get<double>() + placed["scale"][axis].get<double>() * place;
      }
    }
    expect_close(corners_of(meshes[n]), sorted(found), scene["asset"]["extras"]["rounding_error"].get<double>());
  }
}

TEST(WritePackedGlb, AnEmptyMeshIsAnEmptyScene) {
  const files::Folder folder;
  write(folder / "a.glb", {}, packed_options());
  const std::string bytes = files::read_bytes(folder / "a.glb");
  EXPECT_EQ(bytes.size(), 20U + word_at(bytes, 12));
  EXPECT_EQ(Json::parse(bytes.substr(20))["scenes"].dump(), R"([{"name":"empty"}])");
}
#endif

TEST(WritePacked, ABuildWithoutTheLibrarySaysSo) {
  const files::Folder folder;
#ifndef ISOWEAVE_HAS_MESHOPTIMIZER
  EXPECT_THROW(open_mesh_file(folder / "a.glb", packed_options()), CannotWrite);
  EXPECT_THROW(open_mesh_levels(folder / "a.glb", std::array{packed_options()}), CannotWrite);
#endif
#ifndef ISOWEAVE_HAS_DRACO
  EXPECT_THROW(open_mesh_file(folder / "a.precomputed", packed_options()), CannotWrite);
  EXPECT_THROW(open_mesh_levels(folder / "a.precomputed", std::array{packed_options()}), CannotWrite);
#endif
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace isoweave::testing::write_mesh_packed_test
