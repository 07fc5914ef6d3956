// neuroglancer's multi-resolution meshes, packed by Draco: a folder with `info` and one shard, `0.shard`. Levels of
// detail are cut along an octree, and what lies in a node is a fragment. Coordinates are those of the volume;
// `transform` in `info` makes them nanometres.
//
// Levels wait in files until they are complete. Their box and their counts say how large nodes are, so a folder does
// not depend on the order in which pieces came. Then each level is cut triangle by triangle, the triangles are sorted
// by nodes, and one fragment at a time is packed.
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "files/atomic_folder.hpp"
#include "files/length_units.hpp"
#include "isoweave/error.hpp"
#include "lattice/triangles.hpp"
#include "mesh/write/joined_meshes.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/octree_manifest.hpp"
#include "mesh/write/triangle_sorter.hpp"
#include "mesh/write/waiting_vertices.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

constexpr std::uint64_t kShardIndexBytes = 16;

// The triangles of one node. Corners in one place become one vertex.
class Fragment {
 public:
  void add(const NodeTriangle& triangle) {
    for (std::size_t corner = 3; corner < triangle.size(); corner += 3) {
      corners_.push_back({triangle[corner], triangle[corner + 1], triangle[corner + 2]});
    }
  }

  bool empty() const { return corners_.empty(); }

  // Packs the triangles, and forgets them.
  std::vector<std::byte> pack(const std::string& path) {
    check_count_fits(path, "triangles of a fragment", 0, corners_.size() / 3, kMostPackedTriangles);
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(*mesh(), &buffer);
    if (!status.ok()) throw CannotWrite(path + ": Draco could not pack the mesh: " + status.error_msg_string());
    check_count_fits(path, "bytes of a fragment", 0, buffer.size());
    const auto bytes = std::as_bytes(std::span(buffer.data(), buffer.size()));
    corners_.clear();
    return {bytes.begin(), bytes.end()};
  }

 private:
  using Corner = std::array<std::uint16_t, 3>;

  std::unique_ptr<draco::Mesh> mesh() const {
    std::vector<Corner> places = corners_;
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    auto result = std::make_unique<draco::Mesh>();
    set_places(*result, places);
    const auto point = [&](const Corner& corner) {
      const auto found = std::lower_bound(places.begin(), places.end(), corner);
      return draco::PointIndex(static_cast<std::uint32_t>(found - places.begin()));
    };
    result->SetNumFaces(corners_.size() / 3);
    for (std::uint32_t n = 0; n < corners_.size() / 3; ++n) {
      const Corner* const t = &corners_[std::size_t{3} * n];
      result->SetFace(draco::FaceIndex(n), {point(t[0]), point(t[1]), point(t[2])});
    }
    return result;
  }

  static void set_places(draco::Mesh& mesh, const std::vector<Corner>& places) {
    const auto count = static_cast<std::uint32_t>(places.size());
    mesh.set_num_points(count);
    draco::GeometryAttribute layout;
    layout.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_UINT32, false, 3 * sizeof(std::uint32_t), 0);
    draco::PointAttribute& positions = *mesh.attribute(mesh.AddAttribute(layout, true, count));
    for (std::uint32_t n = 0; n < count; ++n) {
      const std::array<std::uint32_t, 3> wide{places[n][0], places[n][1], places[n][2]};
      positions.SetAttributeValue(draco::AttributeValueIndex(n), wide.data());
    }
  }

  std::vector<Corner> corners_;
};

// Cuts a level, and appends its fragments to the shard in the order of their nodes.
class LevelPacker {
 public:
  LevelPacker(const std::string& path, JoinedMesh& mesh, const NodeGrid& grid, std::size_t level, AtomicFile& shard)
      : path_(path), mesh_(mesh), grid_(grid), level_(level), shard_(shard) {}

  OctreeLevel pack() {
    TriangleSorter sorter(OutputDescriptor(open_scratch_in(folder_of(without_slashes(path_)), path_), path_));
    cut(sorter);
    sorter.take_all([this](const NodeTriangle& triangle) { take(triangle); });
    finish_node();
    result_.scale = static_cast<float>(mean_edge());
    return std::move(result_);
  }

 private:
  void cut(TriangleSorter& sorter) {
    constexpr std::uint64_t kAtOnce = std::uint64_t{1} << 14;
    WaitingVertices vertices(mesh_.positions(), mesh_.vertices());
    NodeCutter cutter(level_);
    std::vector<Triangle64> triangles;
    const auto place = [&](std::uint64_t vertex) { return grid_.place(vertices.at(vertex), level_); };
    for (std::uint64_t first = 0; first < mesh_.triangles(); first += kAtOnce) {
      triangles.resize(to_size(std::min(kAtOnce, mesh_.triangles() - first)));
      mesh_.faces().read_back(first * sizeof(Triangle64), std::as_writable_bytes(std::span(triangles)));
      for (const Triangle64& t : triangles) sorter.add(cutter.cut({place(t[0]), place(t[1]), place(t[2])}));
    }
  }

  void take(const NodeTriangle& triangle) {
    if (node_of(triangle) != node_) finish_node();
    node_ = node_of(triangle);
    eighths_ |= 1U << eighth_of(triangle);
    fragment_.add(triangle);
    const auto corner = [&](std::size_t at) {
      return measure::Vector{double(triangle[at]), double(triangle[at + 1]), double(triangle[at + 2])};
    };
    area_ += measure::area_of({corner(3), corner(6), corner(9)});
  }

  void finish_node() {
    if (fragment_.empty()) return;
    const std::vector<std::byte> bytes = fragment_.pack(path_);
    shard_.write(bytes);
    result_.nodes.push_back({node_, static_cast<std::uint32_t>(bytes.size())});
    for (std::uint64_t eighth = 0; eighth < 8; ++eighth) {
      if ((eighths_ >> eighth & 1U) != 0) result_.eighths.push_back(node_ << 3 | eighth);
    }
    eighths_ = 0;
  }

  // The length of an edge if all triangles were equilateral and had the area of the mesh. neuroglancer draws the
  // coarsest level in which that length spans few pixels. The area is summed in the order of nodes, so it has the same
  // bits however the mesh came.
  double mean_edge() const {
    constexpr double kSquareOfSide = 2.3094010767585034;  // of an equilateral triangle, over its area: 4 / root of 3
    return grid_.step(level_) * std::sqrt(kSquareOfSide * area_ / static_cast<double>(mesh_.triangles()));
  }

  const std::string& path_;
  JoinedMesh& mesh_;
  const NodeGrid& grid_;
  std::size_t level_;
  AtomicFile& shard_;
  Fragment fragment_;
  std::uint64_t node_ = 0;
  unsigned eighths_ = 0;  // a bit each
  double area_ = 0;       // in steps
  OctreeLevel result_;
};

void store_u64(std::byte*& out, std::uint64_t value) {
  store_u32(out, static_cast<std::uint32_t>(value));
  store_u32(out, static_cast<std::uint32_t>(value >> 32));
}

// Appends the manifest behind the fragments, and the two indices of the shard: the one of its only minishard at the
// end, and the place of that one at the beginning. Offsets count from behind the index at the beginning.
void finish_shard(AtomicFile& shard, std::uint64_t segment, std::span<const std::byte> manifest) {
  const std::uint64_t fragments = shard.size() - kShardIndexBytes;
  shard.write(manifest);
  std::array<std::byte, 24> minishard{};
  std::byte* out = minishard.data();
  for (const std::uint64_t value : {segment, fragments, std::uint64_t{manifest.size()}}) store_u64(out, value);
  shard.write(minishard);
  std::array<std::byte, kShardIndexBytes> index{};
  out = index.data();
  store_u64(out, fragments + manifest.size());
  store_u64(out, fragments + manifest.size() + minishard.size());
  shard.overwrite(0, index);
}

std::string info_of(const MeshFileOptions& options) {
  const double scale = unit_in(unit_or_usual(options.unit), "nm").value_or(1);
  const nlohmann::ordered_json info{{"@type", "neuroglancer_multilod_draco"},
                                    {"vertex_quantization_bits", 16},
                                    {"transform",
                                     {scale, 0, 0, scale * options.offset[0], 0, scale, 0, scale * options.offset[1], 0,
                                      0, scale, scale * options.offset[2]}},
                                    {"lod_scale_multiplier", 1},
                                    {"sharding",
                                     {{"@type", "neuroglancer_uint64_sharded_v1"},
                                      {"preshift_bits", 0},
                                      {"hash", "identity"},
                                      {"minishard_bits", 0},
                                      {"shard_bits", 0},
                                      {"minishard_index_encoding", "raw"},
                                      {"data_encoding", "raw"}}}};
  return info.dump() + "\n";
}

class PackedPrecomputedLevels final : public JoinedFile {
 public:
  PackedPrecomputedLevels(const std::string& path, const std::vector<MeshFileOptions>& levels)
      : JoinedFile(path, levels, JoinedForm::kWide) {}

  void check_room(const JoinedMesh&, std::uint64_t, std::uint64_t) override {}  // fragments are checked one by one

 private:
  // The levels before the first one of which nothing is left, as nothing is left of those behind it.
  std::vector<std::uint64_t> counts() {
    std::vector<std::uint64_t> triangles;
    for (const JoinedMesh& level : meshes()) {
      if (level.triangles() == 0) break;
      triangles.push_back(level.triangles());
    }
    return triangles;
  }

  void write() override {
    if (options().unit.empty()) note(path() + ": the unit is not said, coordinates were taken for mm");
    const std::vector<std::uint64_t> triangles = counts();
    const NodeGrid grid(corners(), triangles);
    AtomicFolder folder(path());
    AtomicFile shard(folder.file("0.shard"));
    shard.write(std::array<std::byte, kShardIndexBytes>{});
    std::vector<OctreeLevel> levels;
    for (std::size_t level = 0; level < triangles.size(); ++level) {
      levels.push_back(LevelPacker(path(), meshes()[level], grid, level, shard).pack());
      if (level > 0) levels[level].scale = std::max(levels[level - 1].scale, levels[level].scale);
    }
    if (levels.empty()) {
      levels.emplace_back().scale = 1;
    } else {
      note(rounding(grid, levels.size() - 1));
    }
    complete_octree(levels);
    finish_shard(shard, options().segment, octree_manifest(grid, levels));
    shard.commit();
    const std::string info = info_of(options());
    folder.write_file("info", std::as_bytes(std::span(info)));
    folder.commit();
  }

  std::string rounding(const NodeGrid& grid, std::size_t coarsest) {
    std::ostringstream text;
    text.precision(3);
    text << path() << ": positions were rounded to 1/65535 of the side of a fragment, by at most " << grid.error(0);
    if (!options().unit.empty()) text << ' ' << options().unit;
    if (coarsest > 0) {
      text << "; level " << coarsest << ", the coarsest, by " << (std::uint64_t{1} << coarsest) << " times that";
    }
    return text.str();
  }
};

}  // namespace

std::unique_ptr<JoinedFile> open_packed_precomputed_levels(const std::string& path,
                                                           std::span<const MeshFileOptions> levels) {
  AtomicFolder::check_free(path);
  std::vector<MeshFileOptions> plain;
  for (const MeshFileOptions& options : levels) plain.push_back(without_normals(options));
  return std::make_unique<PackedPrecomputedLevels>(path, plain);
}

}  // namespace isoweave
