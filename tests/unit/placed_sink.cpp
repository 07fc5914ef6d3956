// Meshes that are scaled, centred and put on the plate on their way to a file.
#include "isoweave/placed_sink.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "isoweave/generate.hpp"
#include "isoweave/measure.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave::testing::placed_sink_test {
namespace {

struct Placed {
  TriangleMesh mesh;
  std::uint64_t digest = 0;
};

// Passes the pieces on to a mesh that outlives the sink.
class Passing final : public MeshSink {
 public:
  explicit Passing(MeshInMemory& mesh) : mesh_(mesh) {}
  void append(const MeshPiece& piece) override { mesh_.append(piece); }
  void finish() override {}
  std::array<double, 3> offset() const override { return mesh_.offset(); }

 private:
  MeshInMemory& mesh_;
};

Placed placed(const MeshPlacing& placing, const std::array<double, 3>& offset = {0, 0, 0}) {
  GenerateOptions volume;
  volume.kind = "torus";
  volume.dims = {20, 24, 16};
  MeshOptions options;
  options.iso = suggested_iso(volume.kind, volume.type);
  MeshInMemory target(placed_offset(offset, placing));
  PlacedSink sink(std::make_unique<Passing>(target), offset, placing);
  mesh_volume(*generate_volume(volume), sink, options);
  return {target.copy(), sink.digest()};
}

std::array<std::array<double, 2>, 3> box_of(const TriangleMesh& mesh) {
  std::array<std::array<double, 2>, 3> box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box[axis] = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Point& point : mesh.vertices) {
      const double at = mesh.offset[axis] + double{point[axis]};
      box[axis] = {std::min(box[axis][0], at), std::max(box[axis][1], at)};
    }
  }
  return box;
}

TEST(PlacedSink, ScalesEveryCoordinate) {
  const TriangleMesh plain = placed({}).mesh;
  const Placed half = placed({.scale = 0.5});
  ASSERT_GT(plain.vertices.size(), 100U);
  ASSERT_EQ(half.mesh.triangles, plain.triangles);
  for (std::size_t v = 0; v < plain.vertices.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(half.mesh.vertices[v][axis], plain.vertices[v][axis] / 2);
  }
  EXPECT_EQ(half.digest, check_mesh(half.mesh).digest);
}

TEST(PlacedSink, CentresAndGrounds) {
  const auto centred = box_of(placed({.scale = 3, .center = true}).mesh);
  for (const auto& [low, high] : centred) EXPECT_NEAR(low, -high, 1e-5);
  const Placed on_plate = placed({.center = true, .ground = true});
  const auto box = box_of(on_plate.mesh);
  EXPECT_NEAR(box[0][0], -box[0][1], 1e-5);
  EXPECT_EQ(box[2][0], 0);
  EXPECT_EQ(on_plate.digest, check_mesh(on_plate.mesh).digest);
  const auto plain = box_of(placed({}).mesh);
  const auto grounded = box_of(placed({.ground = true}).mesh);
  EXPECT_EQ(grounded[0], plain[0]) << "the ground is a matter of z";
  EXPECT_NEAR(grounded[2][1], plain[2][1] - plain[2][0], 1e-5);
}

// Far from the origin 32 bits hold the coordinates relative to an offset, which is scaled as well, or goes.
TEST(PlacedSink, KeepsTheShapeFarFromTheOrigin) {
  const std::array<double, 3> far{4e8, -3e8, 2e8};
  const Placed half = placed({.scale = 0.5}, far);
  EXPECT_EQ(half.mesh.offset, (std::array<double, 3>{2e8, -1.5e8, 1e8}));
  EXPECT_EQ(half.digest, check_mesh(half.mesh).digest);
  const Placed centred = placed({.center = true}, far);
  EXPECT_EQ(centred.mesh.offset, (std::array<double, 3>{0, 0, 0}));
  const Placed grounded = placed({.ground = true}, far);
  EXPECT_EQ(grounded.mesh.offset, (std::array<double, 3>{4e8, -3e8, 0}));
  EXPECT_EQ(box_of(grounded.mesh)[2][0], 0);
}

TEST(PlacedSink, UnitsHaveTheirRatios) {
  EXPECT_EQ(unit_ratio("mm", "um"), 1000);
  EXPECT_EQ(unit_ratio("", "mm"), 1) << "no unit is mm";
  EXPECT_EQ(unit_ratio("in", "mm"), 25.4);
  EXPECT_THROW(unit_ratio("mm", "parsec"), std::invalid_argument);
  EXPECT_THROW(placed({.scale = 0}), std::invalid_argument);
  EXPECT_THROW(placed({.scale = std::nan("")}), std::invalid_argument);
}

}  // namespace
}  // namespace isoweave::testing::placed_sink_test
