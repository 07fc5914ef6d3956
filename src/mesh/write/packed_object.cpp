#include "mesh/write/packed_object.hpp"

#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "isoweave/error.hpp"
#include "lattice/triangles.hpp"
#include "mesh/write/mesh_file_sink.hpp"
#include "mesh/write/mesh_format.hpp"
#include "mesh/write/octree_manifest.hpp"
#include "mesh/write/triangle_sorter.hpp"
#include "mesh/write/waiting_vertices.hpp"
#include "parallel/size.hpp"

namespace isoweave {
namespace {

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

// Cuts a level, and writes its fragments in the order of their nodes.
class LevelPacker {
 public:
  LevelPacker(const std::string& path, const WaitingLevel& mesh, const NodeGrid& grid, std::size_t level,
              const ByteWriter& write)
      : path_(path), mesh_(mesh), grid_(grid), level_(level), write_(write) {}

  OctreeLevel pack() {
    TriangleSorter sorter(path_);
    cut(sorter);
    sorter.take_all([this](const NodeTriangle& triangle) { take(triangle); });
    finish_node();
    result_.scale = static_cast<float>(mean_edge());
    return std::move(result_);
  }

 private:
  void cut(TriangleSorter& sorter) {
    constexpr std::uint64_t kAtOnce = std::uint64_t{1} << 14;
    WaitingVertices vertices(mesh_.positions, mesh_.vertices);
    NodeCutter cutter(level_);
    std::vector<Triangle64> triangles;
    const auto place = [&](std::uint64_t vertex) { return grid_.place(vertices.at(vertex), level_); };
    for (std::uint64_t first = 0; first < mesh_.triangles; first += kAtOnce) {
      triangles.resize(to_size(std::min(kAtOnce, mesh_.triangles - first)));
      mesh_.faces(first * sizeof(Triangle64), std::as_writable_bytes(std::span(triangles)));
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
    write_(bytes);
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
    return grid_.step(level_) * std::sqrt(kSquareOfSide * area_ / static_cast<double>(mesh_.triangles));
  }

  const std::string& path_;
  const WaitingLevel& mesh_;
  const NodeGrid& grid_;
  std::size_t level_;
  const ByteWriter& write_;
  Fragment fragment_;
  std::uint64_t node_ = 0;
  unsigned eighths_ = 0;  // a bit each
  double area_ = 0;       // in steps
  OctreeLevel result_;
};

}  // namespace

std::vector<std::byte> pack_object(const std::string& path, const NodeGrid& grid, std::span<const WaitingLevel> meshes,
                                   const ByteWriter& write) {
  std::vector<OctreeLevel> levels;
  for (std::size_t level = 0; level < meshes.size(); ++level) {
    levels.push_back(LevelPacker(path, meshes[level], grid, level, write).pack());
    if (level > 0) levels[level].scale = std::max(levels[level - 1].scale, levels[level].scale);
  }
  if (levels.empty()) levels.emplace_back().scale = 1;
  complete_octree(levels);
  return octree_manifest(grid, levels);
}

}  // namespace isoweave
