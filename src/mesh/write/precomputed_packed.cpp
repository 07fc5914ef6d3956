// neuroglancer's multi-resolution meshes, packed by Draco: a folder with `info`, an object's manifest `ID.index`, and
// its fragments `ID`. A level of detail is one fragment: triangles of a level may not cross the borders of
// its fragments, so that more of them would need triangles that the mesh does not have. Coordinates are those of the
// volume, in steps of a grid of 16 bits; `transform` in `info` makes them nanometres.
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <nlohmann/json.hpp>

#include "files/atomic_folder.hpp"
#include "files/length_units.hpp"
#include "isoweave/error.hpp"
#include "lattice/triangles.hpp"
#include "mesh/write/joined_meshes.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/whole_mesh_sink.hpp"

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

// A level of detail with one fragment at (0, 0, 0), or with none.
struct PackedLevel {
  std::vector<std::byte> fragment;
  float scale = 0;  // the length that it shows
};

// The cell of the finest level, and all levels.
std::vector<std::byte> manifest(const Grid16& grid, std::span<const PackedLevel> levels) {
  const auto side = static_cast<float>(grid.step * kSteps);
  std::size_t fragments = 0;
  for (const PackedLevel& level : levels) fragments += level.fragment.empty() ? 0U : 1U;
  std::vector<std::byte> bytes(28 + 20 * levels.size() + 16 * fragments);
  std::byte* out = bytes.data();
  store_point(out, {side, side, side});
  store_point(out, {static_cast<float>(grid.origin[0]), static_cast<float>(grid.origin[1]),
                    static_cast<float>(grid.origin[2])});
  store_u32(out, static_cast<std::uint32_t>(levels.size()));
  for (const PackedLevel& level : levels) store_u32(out, std::bit_cast<std::uint32_t>(level.scale));
  for (std::size_t n = 0; n < levels.size(); ++n) store_point(out, {0, 0, 0});
  for (const PackedLevel& level : levels) store_u32(out, level.fragment.empty() ? 0 : 1);
  for (const PackedLevel& level : levels) {
    if (level.fragment.empty()) continue;
    for (int axis = 0; axis < 3; ++axis) store_u32(out, 0);
    store_u32(out, static_cast<std::uint32_t>(level.fragment.size()));
  }
  return bytes;
}

void write_folder(const std::string& path, const MeshFileOptions& options, const Grid16& grid,
                  std::span<const PackedLevel> levels) {
  const double scale = unit_in(unit_or_usual(options.unit), "nm").value_or(1);
  const nlohmann::ordered_json info{{"@type", "neuroglancer_multilod_draco"},
                                    {"vertex_quantization_bits", 16},
                                    {"transform",
                                     {scale, 0, 0, scale * options.offset[0], 0, scale, 0, scale * options.offset[1], 0,
                                      0, scale, scale * options.offset[2]}},
                                    {"lod_scale_multiplier", 1}};
  const std::string text = info.dump() + "\n";
  const std::string object = std::to_string(options.segment);
  std::vector<std::byte> fragments;
  for (const PackedLevel& level : levels) {
    check_count_fits(path, "bytes of a fragment", 0, level.fragment.size());
    fragments.insert(fragments.end(), level.fragment.begin(), level.fragment.end());
  }
  AtomicFolder folder(path);
  folder.write_file("info", std::as_bytes(std::span(text)));
  folder.write_file(object + ".index", manifest(grid, levels));
  folder.write_file(object, fragments);
  folder.commit();
}

std::string unit_note(const std::string& path) {
  return path + ": the unit is not said, coordinates were taken for mm";
}

class PackedPrecomputedSink final : public WholeMeshSink {
 public:
  PackedPrecomputedSink(const MeshTarget& target, const MeshFileOptions& options)
      : WholeMeshSink(target, without_normals(options), kMostPackedTriangles) {}

 private:
  void write_mesh(TriangleMesh mesh) override {
    if (options().unit.empty()) note(unit_note(path()));
    const Grid16 grid = Grid16::around(mesh.vertices);
    PackedLevel level;
    level.scale = static_cast<float>(grid.step * kSteps);  // the size below which there would be a finer level
    if (!mesh.triangles.empty()) {
      note(rounding_note(path(), grid, options().unit));
      level.fragment = draco_bytes(path(), std::move(mesh), grid);
    }
    write_folder(path(), options(), grid, {&level, 1});
  }
};

// Levels of detail. The cells of each level are twice as wide as those of the one before, and the mesh is in the first
// eighth of its cell: coarser levels are rounded to steps twice as long each time. Half a step of the first ones is
// left free, so that no coordinate of the next level is beyond that eighth.
class PackedPrecomputedLevels final : public JoinedFile {
 public:
  PackedPrecomputedLevels(const std::string& path, const std::vector<MeshFileOptions>& levels)
      : JoinedFile(path, levels) {
    AtomicFolder::check_free(path);
  }

  void check_room(const JoinedMesh& level, std::uint64_t vertices, std::uint64_t triangles) override {
    check_count_fits(path(), "vertices", level.vertices(), vertices);
    check_count_fits(path(), "triangles", level.triangles(), triangles, kMostPackedTriangles);
  }

 private:
  // A grid around all levels.
  Grid16 grid() {
    Grid16 grid = Grid16::around(corners());
    grid.step *= kSteps / (kSteps - 1);
    return grid;
  }

  void write() override {
    if (options().unit.empty()) note(unit_note(path()));
    const Grid16 finest = grid();
    std::vector<PackedLevel> packed;
    Grid16 grid = finest;
    for (JoinedMesh& level : meshes()) {
      if (level.triangles() == 0) break;  // as are all that follow
      if (!packed.empty()) grid.step *= 2;
      TriangleMesh mesh = level.load();
      const float before = packed.empty() ? static_cast<float>(grid.step) : packed.back().scale;
      packed.emplace_back().scale = std::max(before, static_cast<float>(mean_edge(mesh)));
      packed.back().fragment = draco_bytes(path(), std::move(mesh), grid);
    }
    if (packed.empty()) {
      packed.emplace_back().scale = 1;
    } else {
      note(rounding_note(path(), finest, options().unit) + "; level " + std::to_string(packed.size() - 1) +
           ", the coarsest, by " + std::to_string(1U << (packed.size() - 1)) + " times that");
    }
    write_folder(path(), options(), finest, packed);
  }

  // The length of an edge if all triangles were equilateral and had the area of the mesh. neuroglancer draws the
  // coarsest level in which that length spans few pixels.
  static double mean_edge(const TriangleMesh& mesh) {
    double area = 0;
    for (const auto& t : mesh.triangles) {
      area += measure::area_of({measure::vector_of(mesh.vertices[t[0]]), measure::vector_of(mesh.vertices[t[1]]),
                                measure::vector_of(mesh.vertices[t[2]])});
    }
    constexpr double kSquareOfSide = 2.3094010767585034;  // of an equilateral triangle, over its area: 4 / root of 3
    return std::sqrt(kSquareOfSide * area / static_cast<double>(mesh.triangles.size()));
  }
};

}  // namespace

std::unique_ptr<JoinedFile> open_packed_precomputed_levels(const std::string& path,
                                                           std::span<const MeshFileOptions> levels) {
  std::vector<MeshFileOptions> plain;
  for (const MeshFileOptions& options : levels) plain.push_back(without_normals(options));
  return std::make_unique<PackedPrecomputedLevels>(path, plain);
}

std::unique_ptr<MeshSink> open_packed_precomputed(const MeshTarget& target, const MeshFileOptions& options) {
  return std::make_unique<PackedPrecomputedSink>(target, options);
}

}  // namespace isoweave
