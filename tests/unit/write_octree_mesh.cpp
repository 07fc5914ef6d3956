// neuroglancer's multi-resolution meshes, as Draco unpacks them: what lies in the fragments is the mesh, whatever way
// it came.
#ifdef ISOWEAVE_HAS_DRACO
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "block_scenes.hpp"
#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/pipeline.hpp"
#include "meshes.hpp"
#include "octree_mesh.hpp"
#include "packed_meshes.hpp"

namespace isoweave::testing::write_octree_mesh_test {
namespace {

using namespace packed;
using Json = nlohmann::json;

// A level in the coordinates of the volume.
std::vector<Corners> placed(const octree::Mesh& mesh, std::size_t level) {
  std::vector<Corners> all;
  for (const octree::Triangle& t : octree::triangles_of(mesh, level)) {
    Corners& corners = all.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        corners[c][axis] = double{mesh.origin[axis]} + mesh.step(level) * static_cast<double>(t[c][axis]);
      }
    }
  }
  return sorted(all);
}

// The corners of a mesh in the nearest steps of a level.
std::vector<octree::Triangle> in_steps(const TriangleMesh& whole, const octree::Mesh& mesh, std::size_t level) {
  std::vector<octree::Triangle> all;
  for (const auto& t : whole.triangles) {
    octree::Triangle& triangle = all.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double at = double{whole.vertices[t[c]][axis]} - double{mesh.origin[axis]};
        triangle[c][axis] = std::lround(at / mesh.step(level));
      }
    }
    triangle = octree::begun_at_least(triangle);
  }
  return all;
}

bool is_flat(const octree::Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

TEST(WriteOctreeMesh, ASmallMeshIsOneFragment) {
  const files::Folder folder;
  const TriangleMesh mesh = sheet();
  MeshFileOptions options = packed_options();
  options.segment = 0x8000'0000'0000'0007;
  const std::vector<std::string> notes = write(folder / "a.precomputed", mesh, options);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("rounded to 1/65535 of the side of a fragment, by at most 0.00027 mm"), std::string::npos)
      << notes[0];
  EXPECT_EQ(Json::parse(files::read_bytes(folder / "a.precomputed/info"))["transform"][0], 1e6)
      << "millimetres to nanometres";
  const octree::Mesh found = octree::read(folder / "a.precomputed", options.segment);
  ASSERT_EQ(found.levels.size(), 1U);
  ASSERT_EQ(found.levels[0].size(), 1U);
  EXPECT_EQ(found.levels[0][0].node, (std::array<std::uint32_t, 3>{0, 0, 0}));
  expect_close(corners_of(mesh), placed(found, 0), 0.00027);
}

// Two levels and one that has vanished.
TEST(WriteOctreeMesh, LevelsHaveNodesTwiceAsWide) {
  const files::Folder folder;
  TriangleMesh fine = sheet();
  fine.vertices.pop_back();
  TriangleMesh coarse = meshes::grid(2);
  for (Point& p : coarse.vertices) p = {p[0] * 10 + 100, p[1] * 7 - 50, 0.5F};
  const std::array<MeshFileOptions, 3> options{packed_options(), packed_options(), packed_options()};
  std::vector<std::string> notes;
  {
    const auto sinks = open_mesh_levels(folder / "a.precomputed", options);
    for (std::size_t level = 0; level < 3; ++level) {
      const TriangleMesh mesh = level == 0 ? fine : level == 1 ? coarse : TriangleMesh{};
      std::vector<Triangle64> triangles;
      for (const auto& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
      sinks[level]->append({mesh.vertices, {}, {}, triangles});
      EXPECT_TRUE(folder.entries().empty());
      sinks[level]->finish();
    }
    notes = sinks[2]->notes();
  }
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("level 1, the coarsest, by 2 times that"), std::string::npos) << notes[0];
  const octree::Mesh found = octree::read(folder / "a.precomputed", 1);
  ASSERT_EQ(found.levels.size(), 2U);
  EXPECT_GT(found.scales[0], 0.5);
  EXPECT_GT(found.scales[1], 5 * found.scales[0]);
  for (std::size_t level = 0; level < 2; ++level) {
    ASSERT_EQ(found.levels[level].size(), 1U);
    expect_close(corners_of(level == 0 ? fine : coarse), placed(found, level), level == 0 ? 0.00027 : 0.00054);
  }
}

TEST(WriteOctreeMesh, AnEmptyMeshHasNoFragment) {
  const files::Folder folder;
  write(folder / "a.precomputed", {}, packed_options());
  const octree::Mesh found = octree::read(folder / "a.precomputed", 1);
  ASSERT_EQ(found.levels.size(), 1U);
  EXPECT_TRUE(found.levels[0].empty());
}

// Checks the rules that readers of an octree rely on: nodes are in order, and each has one above it and below it.
void expect_sound_octree(const octree::Mesh& mesh) {
  const auto code = [](const std::array<std::uint32_t, 3>& node) {
    std::uint64_t bits = 0;
    for (unsigned bit = 21; bit-- > 0;) {
      for (unsigned axis = 3; axis-- > 0;) bits = bits << 1 | (node[axis] >> bit & 1U);
    }
    return bits;
  };
  for (std::size_t level = 0; level < mesh.levels.size(); ++level) {
    const auto& nodes = mesh.levels[level];
    std::set<std::uint64_t> codes;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      EXPECT_TRUE(n == 0 || code(nodes[n - 1].node) < code(nodes[n].node)) << "level " << level;
      codes.insert(code(nodes[n].node));
    }
    if (level == 0) continue;
    for (const octree::Fragment& below : mesh.levels[level - 1]) {
      EXPECT_TRUE(codes.contains(code(below.node) >> 3)) << "a node of level " << level - 1 << " hangs in the air";
    }
  }
}

// The fragments of a level are the level: every triangle that need not be cut is there once, the cut ones close the
// surface again, and nothing is beside them.
void expect_level(const octree::Mesh& mesh, std::size_t level, const TriangleMesh& whole) {
  for (const octree::Fragment& fragment : mesh.levels[level]) {
    for (const octree::Triangle& t : fragment.triangles) {
      for (const octree::Place& place : t) {
        EXPECT_LE(*std::max_element(place.begin(), place.end()), octree::kSteps);
      }
      EXPECT_TRUE(octree::is_whole(t, level > 0)) << "crosses the middle of its node";
    }
  }
  std::map<octree::Triangle, int> uncut;
  const std::vector<octree::Triangle> expected = in_steps(whole, mesh, level);
  const std::vector<octree::Triangle> found = octree::triangles_of(mesh, level);
  EXPECT_EQ(octree::count_open_edges(found), 0U) << "level " << level;
  EXPECT_NEAR(octree::six_volumes(found) / octree::six_volumes(expected), 1, 1e-6);
  std::size_t whole_ones = 0;
  for (const octree::Triangle& t : expected) {
    if (is_flat(t) || !octree::is_whole(t, level > 0)) continue;
    ++uncut[t];
    ++whole_ones;
  }
  EXPECT_GT(whole_ones, expected.size() / 4);
  for (const octree::Triangle& t : found) {
    const auto at = uncut.find(t);
    if (at != uncut.end()) --at->second;
  }
  EXPECT_TRUE(std::ranges::all_of(uncut, [](const auto& entry) { return entry.second == 0; })) << "level " << level;
}

struct LevelFiles {
  std::vector<std::unique_ptr<MeshSink>> files{};

  explicit LevelFiles(const std::string& path)
      : files(open_mesh_levels(path, std::array{packed_options(), packed_options(), packed_options()})) {}

  std::vector<MeshSink*> sinks() {
    std::vector<MeshSink*> all;
    for (const auto& file : files) all.push_back(file.get());
    return all;
  }
};

// A closed surface with caps, whose levels have several fragments each.
TEST(WriteOctreeMesh, FragmentsAreTheLevelsInSlabsAndInBlocks) {
  const std::int64_t side = testing::kSanitized ? 64 : 88;
  GenerateOptions volume;
  volume.kind = "gyroid";
  volume.dims = {side, side, side - 16};
  volume.type = SampleType::kUint8;
  MeshOptions options;
  options.iso = 127.5;
  options.levels = {Length::voxels(0), Length::voxels(0.3)};
  options.error = Length::voxels(1);
  const files::Folder folder;
  std::vector<MeshInMemory> levels(3);
  const std::array<MeshSink*, 3> in_memory{&levels[0], &levels[1], &levels[2]};
  mesh_volume(*generate_volume(volume), in_memory, options);
  {
    LevelFiles run(folder / "slabs.precomputed");
    mesh_volume(*generate_volume(volume), run.sinks(), options);
  }
  for (const std::int64_t size : {24, 50}) {
    LevelFiles run(folder / ("blocks" + std::to_string(size) + ".precomputed"));
    mesh_in_blocks([&] { return generate_volume(volume); }, run.sinks(), options, {size});
  }
  const octree::Mesh mesh = octree::read(folder / "slabs.precomputed", 1);
  ASSERT_EQ(mesh.levels.size(), 3U);
  expect_sound_octree(mesh);
  for (std::size_t level = 0; level < 3; ++level) expect_level(mesh, level, levels[level].copy());
  EXPECT_GE(mesh.levels[0].size(), 8U);
  EXPECT_TRUE(std::ranges::is_sorted(mesh.scales));
  for (const char* name : {"info", "0.shard"}) {
    const std::string expected = files::read_bytes(folder / (std::string("slabs.precomputed/") + name));
    for (const char* blocks : {"blocks24", "blocks50"}) {
      EXPECT_TRUE(files::read_bytes(folder / (std::string(blocks) + ".precomputed/" + name)) == expected) << blocks;
    }
  }
}

TEST(WriteOctreeMesh, NothingIsLeftOfOneThatIsNotFinished) {
  const files::Folder folder;
  {
    const LevelFiles run(folder / "a.precomputed");
    run.files[0]->append({.vertices = sheet().vertices});
    run.files[0]->finish();
    run.files[2]->finish();
  }
  EXPECT_TRUE(folder.entries().empty());
}

}  // namespace
}  // namespace isoweave::testing::write_octree_mesh_test
#endif
