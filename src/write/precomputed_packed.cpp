// neuroglancer's multi-resolution meshes, packed by Draco: a folder with `info`, an object's manifest `ID.index`, and
// its fragments `ID`. There is one level of detail with one fragment: triangles of a level may not cross the borders of
// its fragments, so that more of them would need triangles that the mesh does not have. Coordinates are those of the
// volume, in steps of a grid of 16 bits; `transform` in `info` makes them nanometres.
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <nlohmann/json.hpp>

#include "isoweave/error.hpp"
#include "write/atomic_folder.hpp"
#include "write/mesh_format.hpp"
#include "write/whole_mesh_sink.hpp"

namespace isoweave {
namespace {

constexpr double kSteps = 65535;

std::unique_ptr<draco::Mesh> draco_mesh(const TriangleMesh& mesh, const Grid16& grid) {
  auto result = std::make_unique<draco::Mesh>();
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
  result->set_num_points(count);
  draco::GeometryAttribute layout;
  layout.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_UINT32, false, 3 * sizeof(std::uint32_t), 0);
  draco::PointAttribute& positions = *result->attribute(result->AddAttribute(layout, true, count));
  for (std::uint32_t n = 0; n < count; ++n) {
    const std::array<std::uint16_t, 3> place = grid.place(mesh.vertices[n]);
    const std::array<std::uint32_t, 3> wide{place[0], place[1], place[2]};
    positions.SetAttributeValue(draco::AttributeValueIndex(n), wide.data());
  }
  result->SetNumFaces(mesh.triangles.size());
  for (std::uint32_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto& t = mesh.triangles[n];
    result->SetFace(draco::FaceIndex(n), {draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
  }
  return result;
}

std::vector<std::byte> draco_bytes(const std::string& path, TriangleMesh mesh, const Grid16& grid) {
  const std::unique_ptr<draco::Mesh> packed = draco_mesh(mesh, grid);
  mesh = {};
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(*packed, &buffer);
  if (!status.ok()) throw CannotWrite(path + ": Draco could not pack the mesh: " + status.error_msg_string());
  const auto bytes = std::as_bytes(std::span(buffer.data(), buffer.size()));
  return {bytes.begin(), bytes.end()};
}

// One level with one fragment at (0, 0, 0), or with none.
std::vector<std::byte> manifest(const Grid16& grid, std::uint64_t fragment_bytes) {
  const auto side = static_cast<float>(grid.step * kSteps);
  const bool empty = fragment_bytes == 0;
  std::vector<std::byte> bytes(empty ? 48 : 64);
  std::byte* out = bytes.data();
  store_point(out, {side, side, side});
  store_point(out, {static_cast<float>(grid.origin[0]), static_cast<float>(grid.origin[1]),
                    static_cast<float>(grid.origin[2])});
  store_u32(out, 1);
  store_u32(out, std::bit_cast<std::uint32_t>(side));  // the size below which there would be a finer level
  store_point(out, {0, 0, 0});
  store_u32(out, empty ? 0 : 1);
  if (empty) return bytes;
  for (int axis = 0; axis < 3; ++axis) store_u32(out, 0);
  store_u32(out, static_cast<std::uint32_t>(fragment_bytes));
  return bytes;
}

class PackedPrecomputedSink final : public WholeMeshSink {
 public:
  PackedPrecomputedSink(const MeshTarget& target, const MeshFileOptions& options)
      : WholeMeshSink(target, without_normals(options), kMostPackedTriangles) {}

 private:
  void write_mesh(TriangleMesh mesh) override {
    const std::optional<double> nanometres = unit_in(options().unit, "nm");
    if (!nanometres) note(path() + ": the unit is not known, coordinates were written as if they were nanometres");
    const Grid16 grid = Grid16::around(mesh.vertices);
    std::vector<std::byte> fragment;
    if (!mesh.triangles.empty()) {
      note(rounding_note(path(), grid, options().unit));
      fragment = draco_bytes(path(), std::move(mesh), grid);
    }
    check_count_fits(path(), "bytes of a fragment", 0, fragment.size());

    const double scale = nanometres.value_or(1);
    const nlohmann::ordered_json info{{"@type", "neuroglancer_multilod_draco"},
                                      {"vertex_quantization_bits", 16},
                                      {"transform", {scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0}},
                                      {"lod_scale_multiplier", 1}};
    const std::string text = info.dump() + "\n";
    const std::string object = std::to_string(options().segment);
    AtomicFolder folder(path());
    folder.write_file("info", std::as_bytes(std::span(text)));
    folder.write_file(object + ".index", manifest(grid, fragment.size()));
    folder.write_file(object, fragment);
    folder.commit();
  }
};

}  // namespace

std::unique_ptr<MeshSink> open_packed_precomputed(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<PackedPrecomputedSink>(target, options);
}

}  // namespace isoweave
