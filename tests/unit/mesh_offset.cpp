// Meshes far from the origin: the offset of a volume, and what files hold of it.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "files.hpp"
#include "isoweave/error.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "meshes.hpp"
#include "surfaces.hpp"

namespace isoweave::testing::mesh_offset_test {
namespace {

using Offset = std::array<double, 3>;

const Offset kNone{0, 0, 0};
const Offset kUtm{500000.1, 4649776.7, 120.3};

// A ball in 20 samples along each axis, somewhere.
testing::MemoryVolume ball(const Offset& origin, double spacing) {
  constexpr std::int64_t kSide = 20;
  std::vector<float> samples;
  for (std::int64_t n = 0; n < kSide * kSide * kSide; ++n) {
    const auto at = [](std::int64_t i) { return static_cast<double>(i) - 9.3; };
    const double x = at(n % kSide), y = at(n / kSide % kSide), z = at(n / (kSide * kSide));
    samples.push_back(static_cast<float>(7 - std::sqrt(x * x + y * y + z * z)));
  }
  testing::MemoryVolume volume({kSide, kSide, kSide}, std::move(samples));
  volume.info().geometry.origin = origin;
  volume.info().geometry.spacing = {spacing, spacing, spacing};
  volume.info().geometry.direction = {0, 1, 0, -1, 0, 0, 0, 0, 1};
  return volume;
}

MeshFileOptions at_offset(const Offset& offset) {
  MeshFileOptions options;
  options.offset = offset;
  return options;
}

MeshOptions at_error(double voxels) {
  MeshOptions options;
  options.error = Length::voxels(voxels);
  return options;
}

// The axes of the ball are turned: i runs along -y of the world, j along x.
TEST(MeshOffset, PlacesOfSamplesAreThoseOfTheMesh) {
  testing::MemoryVolume volume = ball(kUtm, 0.5);
  volume.info().geometry.space = Space::kRas;
  const VolumeInfo& info = volume.info();
  EXPECT_EQ(output_place(info, OutputSpace::kAsVolume, {0, 0, 0}), kUtm);
  EXPECT_EQ(output_place(info, OutputSpace::kAsVolume, {2, 4, -1}), (Offset{kUtm[0] + 2, kUtm[1] - 1, kUtm[2] - 0.5}));
  EXPECT_EQ(output_place(info, OutputSpace::kLps, {2, 4, -1}), (Offset{-kUtm[0] - 2, -kUtm[1] + 1, kUtm[2] - 0.5}));
  EXPECT_EQ(output_place(info, OutputSpace::kIndex, {2, 4, -1}), (Offset{1, 2, -0.5}));
}

TEST(MeshOffset, IsTheOriginOfAVolumeThatIsFarAway) {
  EXPECT_EQ(mesh_offset(ball(kUtm, 0.1).info(), OutputSpace::kAsVolume), kUtm);
  EXPECT_EQ(mesh_offset(ball(kUtm, 0.1).info(), OutputSpace::kIndex), kNone);
  EXPECT_EQ(mesh_offset(ball({-250, -250, -1200}, 0.5).info(), OutputSpace::kAsVolume), kNone);
  EXPECT_EQ(mesh_offset(ball({-250, -250, -1200}, 0.01).info(), OutputSpace::kAsVolume), (Offset{-250, -250, -1200}));
  VolumeInfo large = ball({1000, 0, 0}, 1).info();
  large.dims = {100000, 100000, 100000};
  EXPECT_EQ(mesh_offset(large, OutputSpace::kAsVolume), kNone) << "the size is what rounding comes from";
  VolumeInfo ras = ball(kUtm, 0.1).info();
  ras.geometry.space = Space::kRas;
  EXPECT_EQ(mesh_offset(ras, OutputSpace::kLps), (Offset{-kUtm[0], -kUtm[1], kUtm[2]}));
}

TEST(MeshOffset, AVolumeFarAwayGivesTheMeshOfTheSameAtTheOrigin) {
  for (const double spacing : {0.1, 0.01}) {
    for (const double error : {0.0, 0.3}) {
      testing::MemoryVolume near = ball(kNone, spacing);
      testing::MemoryVolume far = ball(kUtm, spacing);
      MeshInMemory at_origin;
      MeshInMemory at_place(mesh_offset(far.info(), OutputSpace::kAsVolume));
      mesh_volume(near, at_origin, at_error(error));
      const MeshReport report = mesh_volume(far, at_place, at_error(error));
      const TriangleMesh expected = at_origin.copy();
      const TriangleMesh found = at_place.copy();
      EXPECT_EQ(found.offset, kUtm);
      EXPECT_TRUE(found.vertices == expected.vertices) << spacing;
      EXPECT_TRUE(found.triangles == expected.triangles) << spacing;
      EXPECT_EQ(report.digest, check_mesh(found).digest);
      EXPECT_TRUE(report.warnings.empty());
    }
  }
}

TEST(MeshOffset, ASinkWithoutItIsWarnedOf) {
  testing::MemoryVolume far = ball(kUtm, 0.01);
  MeshInMemory sink;
  const MeshReport report = mesh_volume(far, sink, at_error(0));
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_EQ(
      report.warnings[0],
      "memory: lies so far from the origin that coordinates of 32 bits move vertices by up to 0.25, as the sink was "
      "opened without the offset of the volume");
  EXPECT_NEAR(double{sink.vertices()[0][1]}, kUtm[1], 1);
}

TEST(MeshOffset, SoIsAPlaceThat64BitsDoNotHold) {
  testing::MemoryVolume far = ball({1e15, 0, 0}, 0.01);
  MeshInMemory sink(mesh_offset(far.info(), OutputSpace::kAsVolume));
  const MeshReport report = mesh_volume(far, sink, at_error(0));
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("64 bits move vertices by up to 0.0625"), std::string::npos) << report.warnings[0];
}

TEST(MeshOffset, SinksOfOneRunHaveTheSame) {
  testing::MemoryVolume volume = ball(kNone, 1);
  MeshInMemory fine(Offset{1, 0, 0}), coarse;
  MeshSink* const sinks[] = {&fine, &coarse};
  MeshOptions options = at_error(0.3);
  options.levels = {{0.1, true}};
  EXPECT_THROW(mesh_volume(volume, sinks, options), std::invalid_argument);
}

TEST(MeshOffset, AnyThatASinkHasIsSubtracted) {
  testing::MemoryVolume volume = ball({2, 3, 4}, 1);
  testing::MemoryVolume again = ball({2, 3, 4}, 1);
  MeshInMemory plain, moved(Offset{16, 0, -8});
  mesh_volume(volume, plain, at_error(0));
  mesh_volume(again, moved, at_error(0));
  TriangleMesh back = moved.copy();
  move_to_offset(back, kNone);
  for (std::size_t v = 0; v < back.vertices.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(back.vertices[v][axis], plain.vertices()[v][axis], 4e-6);
    }
  }
}

TEST(MeshOffset, SimplifiesAMeshInItsPlace) {
  const files::Folder folder;
  testing::MemoryVolume far = ball(kUtm, 0.01);
  MeshInMemory full(mesh_offset(far.info(), OutputSpace::kAsVolume));
  mesh_volume(far, full, at_error(0));
  const TriangleMesh mesh = full.copy();
  TriangleMesh near = mesh;
  near.offset = kNone;
  MeshInMemory small(mesh.offset), expected;
  const MeshReport report = simplify_mesh(mesh, small, {.error = Length::units(0.003)});
  simplify_mesh(near, expected, {.error = Length::units(0.003)});
  EXPECT_TRUE(small.copy().vertices == expected.copy().vertices);
  EXPECT_EQ(report.digest, check_mesh(small.copy()).digest);
  MeshInMemory without;
  EXPECT_EQ(simplify_mesh(mesh, without, {.error = Length::units(0.003)}).warnings.size(), 1U);
}

// A cube of 0.01 at a place that is not one of floats.
TriangleMesh far_cube() {
  TriangleMesh mesh = meshes::cube();
  for (Point& p : mesh.vertices) {
    for (float& coordinate : p) coordinate = 0.01F * (1 + 3 * coordinate);
  }
  mesh.offset = kUtm;
  mesh.unit = "m";
  return mesh;
}

TEST(MeshOffset, FilesGiveBackTheSamePlacesAndTheSameFile) {
  const files::Folder folder, again;
  const TriangleMesh mesh = far_cube();
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.glb", "a.vtp", "a.3mf"}) {
    write_mesh(folder / name, mesh);
    const TriangleMesh read = read_mesh(folder / name);
    EXPECT_EQ(read.offset, mesh.offset) << name;
    EXPECT_EQ(read.unit, "m") << name;
    EXPECT_EQ(check_mesh(read).digest, check_mesh(mesh).digest) << name;
    EXPECT_NEAR(check_mesh(read).volume, 27e-6, 1e-9) << name;
    write_mesh(again / name, read);
    EXPECT_EQ(files::read_bytes(folder / name), files::read_bytes(again / name)) << name;
  }
}

TEST(MeshOffset, ARunThatIsResumedHasIt) {
  const files::Folder folder, state;
  MeshOptions options = at_error(0.3);
  testing::MemoryVolume whole = ball(kUtm, 0.01);
  MeshFileOptions file = at_offset(mesh_offset(whole.info(), options.space));
  const MeshReport expected = mesh_volume(whole, *open_mesh_file(folder / "whole.ply", file), options, {.slab = 3});

  std::atomic<bool> stop{false};
  RunControl control;
  control.stop = borrow(stop);
  control.slab = 3;
  control.checkpoint.folder = state.path();
  control.progress = [&](const Progress& progress) { stop = progress.layer > 8; };
  file.parts = state.path();
  {
    testing::MemoryVolume volume = ball(kUtm, 0.01);
    const auto sink = open_mesh_file(folder / "cut.ply", file);
    EXPECT_THROW(mesh_volume(volume, *sink, options, control), Interrupted);
  }
  const Checkpoint checkpoint = read_checkpoint(state.path());
  control.stop = nullptr;
  control.resume = checkpoint;
  testing::MemoryVolume volume = ball(kUtm, 0.01);
  MeshInMemory elsewhere;
  EXPECT_THROW(mesh_volume(volume, elsewhere, options, control), BadInput) << "a sink without the offset";
  file.mark = checkpoint.marks.front();
  const MeshReport report = mesh_volume(volume, *open_mesh_file(folder / "cut.ply", file), options, control);
  EXPECT_EQ(report.digest, expected.digest);
  EXPECT_EQ(check_mesh(read_mesh(folder / "cut.ply")).digest, expected.digest);
}

TEST(MeshOffset, PlyAndVtpSayDouble) {
  const files::Folder folder;
  write_mesh(folder / "a.ply", far_cube());
  write_mesh(folder / "a.vtp", far_cube());
  const std::string ply = files::read_bytes(folder / "a.ply");
  EXPECT_NE(ply.find("comment OFFSET=500000.1,4649776.7,120.3\n"), std::string::npos);
  EXPECT_NE(ply.find("property double x\nproperty double y\nproperty double z\n"), std::string::npos);
  double x = 0;
  std::memcpy(&x, ply.data() + ply.find("end_header\n") + 11, sizeof x);
  EXPECT_EQ(x, kUtm[0] + double{0.01F});
  EXPECT_NE(files::read_bytes(folder / "a.vtp").find("type=\"Float64\" Name=\"Points\""), std::string::npos);
  EXPECT_EQ(mesh_file_bytes("a.ply", 8, 12, at_offset(kUtm)), mesh_file_bytes("a.ply", 8, 12) + 8 * 12);
}

TEST(MeshOffset, StlRoundsAndSaysHowFar) {
  const files::Folder folder;
  MeshFileOptions options = at_offset(kUtm);
  options.unit = "m";
  const auto sink = open_mesh_file(folder / "a.stl", options);
  sink->append({.vertices = far_cube().vertices, .triangles = std::vector<Triangle64>{{0, 1, 2}}});
  sink->finish();
  ASSERT_EQ(sink->notes().size(), 1U);
  EXPECT_NE(sink->notes()[0].find("move vertices by up to 0.24 m"), std::string::npos) << sink->notes()[0];
  float y = 0;
  std::memcpy(&y, files::read_bytes(folder / "a.stl").data() + 84 + 12 + 4, sizeof y);
  EXPECT_EQ(y, 4649776.5F);
  options.offset = {1e39, 0, 0};
  const auto beyond = open_mesh_file(folder / "b.stl", options);
  EXPECT_THROW(beyond->append({.vertices = far_cube().vertices, .triangles = std::vector<Triangle64>{{0, 1, 2}}}),
               CannotWrite);
}

TEST(MeshOffset, GlbPutsItIntoANode) {
  const files::Folder folder;
  write_mesh(folder / "a.glb", far_cube());
  const std::string bytes = files::read_bytes(folder / "a.glb");
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, sizeof length);
  const auto scene = nlohmann::json::parse(bytes.substr(20, length));
  EXPECT_EQ(scene["nodes"][0]["children"], (std::vector<int>{1}));
  EXPECT_FALSE(scene["nodes"][0].contains("mesh"));
  EXPECT_EQ(scene["nodes"][1]["mesh"], 0);
  EXPECT_EQ(scene["nodes"][1]["translation"], kUtm);
}

}  // namespace
}  // namespace isoweave::testing::mesh_offset_test
