// Many objects in one folder for neuroglancer: each is what a folder of its own would hold, in whatever order they
// come.
#ifdef ISOWEAVE_HAS_DRACO
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "octree_mesh.hpp"
#include "packed_meshes.hpp"

namespace isoweave::testing::write_objects_test {
namespace {

using namespace packed;
using Json = nlohmann::json;

constexpr std::uint64_t kObjects = 1500;  // more than go into one index

std::uint64_t segment_of(std::uint64_t n) { return n % 2 == 0 ? n * n + 1 : ~std::uint64_t{0} - 1000 * n; }

// A sheet of its own for each object. Number 7 is larger than what waits in memory.
TriangleMesh mesh_of(std::uint64_t n) {
  TriangleMesh mesh = meshes::grid(n == 7 ? 90U : 1U + static_cast<std::uint32_t>(n % 4));
  for (Point& p : mesh.vertices) p[2] = static_cast<float>(n);
  return mesh;
}

void append(MeshSink& sink, const TriangleMesh& mesh) {
  std::vector<Triangle64> triangles;
  for (const auto& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  sink.append({.vertices = mesh.vertices, .triangles = {}});
  sink.append({.triangles = triangles});
}

std::vector<std::string> write_all(const std::string& path, std::uint32_t seed) {
  std::vector<std::uint64_t> order(kObjects);
  for (std::uint64_t n = 0; n < kObjects; ++n) order[n] = n;
  std::mt19937 random(seed);
  std::shuffle(order.begin(), order.end(), random);
  const auto objects = open_mesh_objects(path, packed_options());
  for (std::size_t first = 0; first < order.size(); first += 50) {  // so many are open at a time
    std::map<std::uint64_t, std::unique_ptr<MeshSink>> open;
    for (std::size_t n = first; n < first + 50; ++n) {
      open[order[n]] = objects->begin({segment_of(order[n]), "object " + std::to_string(order[n]), order[n]});
    }
    for (auto& [n, sink] : open) append(*sink, mesh_of(n));
    for (auto& [n, sink] : open) sink->finish();
  }
  objects->finish();
  return objects->notes();
}

TEST(WriteObjects, AreThoseOfFoldersOfTheirOwn) {
  const files::Folder folder;
  const std::vector<std::string> notes = write_all(folder / "a.precomputed", 1);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("by at most"), std::string::npos) << notes[0];
  EXPECT_EQ(octree::objects(folder / "a.precomputed").size(), kObjects);
  for (const std::uint64_t n : {0U, 1U, 2U, 7U, 700U, 1499U}) {
    SCOPED_TRACE(n);
    MeshFileOptions options = packed_options();
    options.segment = segment_of(n);
    const std::string alone = folder / (std::to_string(n) + ".precomputed");
    write(alone, mesh_of(n), options);
    const octree::Mesh found = octree::read(folder / "a.precomputed", options.segment);
    const octree::Mesh expected = octree::read(alone, options.segment);
    EXPECT_EQ(found.origin, expected.origin);
    EXPECT_EQ(found.side, expected.side);
    EXPECT_EQ(found.scales, expected.scales);
    EXPECT_TRUE(octree::triangles_of(found, 0) == octree::triangles_of(expected, 0));
  }
}

TEST(WriteObjects, DoNotDependOnTheirOrder) {
  const files::Folder folder;
  write_all(folder / "a.precomputed", 2);
  write_all(folder / "b.precomputed", 3);
  for (const char* name : {"/info", "/0.shard", "/properties/info"}) {
    EXPECT_TRUE(files::read_bytes(folder / "a.precomputed" + name) ==
                files::read_bytes(folder / "b.precomputed" + name))
        << name;
  }
}

TEST(WriteObjects, AreListedWithNamesAndSizes) {
  const files::Folder folder;
  const auto objects = open_mesh_objects(folder / "a.precomputed", packed_options());
  const auto add = [&](const MeshObject& object, const TriangleMesh& mesh) {
    const auto sink = objects->begin(object);
    append(*sink, mesh);
    sink->finish();
  };
  add({9, "liver", 500}, sheet());
  add({4, "\xff", 20}, sheet());
  add({5, "nothing is left of it", 1}, {});
  objects->finish();
  const Json info = Json::parse(files::read_bytes(folder / "a.precomputed/properties/info"));
  EXPECT_EQ(info["@type"], "neuroglancer_segment_properties");
  EXPECT_EQ(info["inline"]["ids"], Json::array({"4", "9"}));
  EXPECT_EQ(info["inline"]["properties"][0]["type"], "label");
  EXPECT_EQ(info["inline"]["properties"][0]["values"], Json::array({"\xef\xbf\xbd", "liver"}));
  EXPECT_EQ(info["inline"]["properties"][1]["values"], Json::array({20.0, 500.0}));
  EXPECT_EQ(Json::parse(files::read_bytes(folder / "a.precomputed/info"))["segment_properties"], "properties");
}

TEST(WriteObjects, NothingIsLeftOfThoseThatCannotBe) {
  const files::Folder folder;
  const auto begin_twice = [&](std::uint64_t a, std::uint64_t b) {
    const auto objects = open_mesh_objects(folder / "a.precomputed", packed_options());
    for (const std::uint64_t segment : {a, b}) {
      const auto sink = objects->begin({segment});
      append(*sink, sheet());
      sink->finish();
    }
    objects->finish();
  };
  EXPECT_THROW(begin_twice(3, 3), std::invalid_argument);
  EXPECT_THROW(begin_twice(3, 0), CannotWrite);
  {
    const auto objects = open_mesh_objects(folder / "a.precomputed", packed_options());
    const auto sink = objects->begin({3});
    append(*sink, mesh_of(7));
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_THROW(open_mesh_objects(folder / "a.precomputed", {}), CannotWrite);
  EXPECT_THROW(open_mesh_objects(folder / "a.glb", packed_options()), CannotWrite);
  std::filesystem::create_directories(folder / "b.precomputed/c");
  EXPECT_THROW(open_mesh_objects(folder / "b.precomputed", packed_options()), CannotWrite);
}

TEST(WriteObjects, MayBeNone) {
  const files::Folder folder;
  open_mesh_objects(folder / "a.precomputed", packed_options())->finish();
  EXPECT_TRUE(octree::objects(folder / "a.precomputed").empty());
}

}  // namespace
}  // namespace isoweave::testing::write_objects_test
#endif
