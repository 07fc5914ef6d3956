// A mesh in neuroglancer's multi-resolution format, read as the page of the format says, with Draco's own decoder. And
// what can be told of its triangles in whole steps.
#pragma once

#include <draco/compression/decode.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files.hpp"

namespace isoweave::octree {

using Place = std::array<std::int64_t, 3>;
using Triangle = std::array<Place, 3>;
inline constexpr std::int64_t kSteps = 65535;
inline constexpr std::int64_t kMiddle = 32768;

struct Fragment {
  std::array<std::uint32_t, 3> node{};
  std::size_t bytes = 0;
  std::vector<Triangle> triangles{};  // in steps from the corner of the node
};

struct Mesh {
  std::array<float, 3> side{}, origin{};
  std::vector<float> scales{};
  std::vector<std::vector<Fragment>> levels{};

  double step(std::size_t level) const { return double{side[0]} * static_cast<double>(1U << level) / kSteps; }
};

class Bytes {
 public:
  Bytes(const std::string& bytes, std::size_t at) : bytes_(bytes), at_(at) {}

  template <class Number>
  Number next() {
    Number number{};
    if (at_ + sizeof(number) > bytes_.size()) throw std::runtime_error("the file ends too early");
    std::memcpy(&number, bytes_.data() + at_, sizeof(number));
    at_ += sizeof(number);
    return number;
  }

  template <class Number, std::size_t kCount>
  std::array<Number, kCount> several() {
    std::array<Number, kCount> numbers{};
    for (Number& number : numbers) number = next<Number>();
    return numbers;
  }

  std::size_t at() const { return at_; }

 private:
  const std::string& bytes_;
  std::size_t at_;
};

// The triangles of a fragment, decoded as neuroglancer does.
inline std::vector<Triangle> unpacked(const char* bytes, std::size_t size) {
  draco::DecoderBuffer buffer;
  buffer.Init(bytes, size);
  draco::Decoder decoder;
  decoder.SetSkipAttributeTransform(draco::GeometryAttribute::POSITION);
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) throw std::runtime_error(decoded.status().error_msg_string());
  const draco::Mesh& mesh = *decoded.value();
  const draco::PointAttribute& places = *mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  // neuroglancer refuses anything else.
  EXPECT_EQ(places.data_type(), draco::DT_INT32);
  EXPECT_EQ(mesh.GetAttributeElementType(static_cast<int>(places.unique_id())), draco::MESH_CORNER_ATTRIBUTE);
  EXPECT_EQ(places.size(), mesh.num_points());
  std::vector<Triangle> triangles(mesh.num_faces());
  for (std::uint32_t f = 0; f < mesh.num_faces(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<std::uint32_t, 3> place{};
      places.GetMappedValue(mesh.face(draco::FaceIndex(f))[c], place.data());
      triangles[f][c] = {place[0], place[1], place[2]};
    }
  }
  return triangles;
}

// Where the manifest of an object lies in a shard.
struct Entry {
  std::uint64_t first = 0, bytes = 0;
};

// The objects of a folder with one shard whose indices are not packed.
inline std::map<std::uint64_t, Entry> objects(const std::string& folder) {
  const auto info = nlohmann::json::parse(files::read_bytes(folder + "/info"));
  EXPECT_EQ(info["@type"], "neuroglancer_multilod_draco");
  EXPECT_EQ(info["vertex_quantization_bits"], 16);
  EXPECT_EQ(info["sharding"]["@type"], "neuroglancer_uint64_sharded_v1");
  for (const char* bits : {"preshift_bits", "shard_bits"}) EXPECT_EQ(info["sharding"][bits], 0);
  const std::string shard = files::read_bytes(folder + "/0.shard");
  const std::uint64_t minishards = std::uint64_t{1} << info["sharding"]["minishard_bits"].get<unsigned>();
  std::map<std::uint64_t, Entry> found;
  std::uint64_t end = 0;
  for (std::uint64_t n = 0; n < minishards; ++n) {
    const auto place = Bytes(shard, 16 * n).several<std::uint64_t, 2>();
    const std::uint64_t count = (place[1] - place[0]) / 24;
    std::uint64_t segment = 0, at = 0;
    for (std::uint64_t entry = 0; entry < count; ++entry) {
      const auto number = [&](std::uint64_t row) {
        return Bytes(shard, 16 * minishards + place[0] + 8 * (row * count + entry)).next<std::uint64_t>();
      };
      segment += number(0);
      at += number(1);
      EXPECT_TRUE(found.emplace(segment, Entry{16 * minishards + at, number(2)}).second) << segment;
      at += number(2);
    }
    end = 16 * minishards + place[1];
  }
  EXPECT_EQ(end, shard.size());
  return found;
}

// An object of such a folder.
inline Mesh read(const std::string& folder, std::uint64_t segment) {
  const std::map<std::uint64_t, Entry> all = objects(folder);
  const auto [first, size] = all.at(segment);
  const std::string shard = files::read_bytes(folder + "/0.shard");
  Mesh mesh;
  Bytes manifest(shard, first);
  mesh.side = manifest.several<float, 3>();
  mesh.origin = manifest.several<float, 3>();
  mesh.levels.resize(manifest.next<std::uint32_t>());
  for (std::size_t n = 0; n < mesh.levels.size(); ++n) mesh.scales.push_back(manifest.next<float>());
  for (std::size_t n = 0; n < 3 * mesh.levels.size(); ++n) EXPECT_EQ(manifest.next<float>(), 0) << "offsets";
  for (auto& level : mesh.levels) level.resize(manifest.next<std::uint32_t>());
  std::size_t bytes = 0;
  for (auto& level : mesh.levels) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (Fragment& fragment : level) fragment.node[axis] = manifest.next<std::uint32_t>();
    }
    for (Fragment& fragment : level) bytes += fragment.bytes = manifest.next<std::uint32_t>();
  }
  EXPECT_EQ(manifest.at(), first + size);
  std::size_t at = first - bytes;
  if (all.size() == 1) {
    EXPECT_EQ(at, 16U) << "the fragments lie before the manifest";
  }
  for (auto& level : mesh.levels) {
    for (Fragment& fragment : level) {
      if (fragment.bytes > 0) fragment.triangles = unpacked(shard.data() + at, fragment.bytes);
      at += fragment.bytes;
    }
  }
  return mesh;
}

// The triangle begun at its least corner.
inline Triangle begun_at_least(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// All triangles of a level in steps from the corner of the octree.
inline std::vector<Triangle> triangles_of(const Mesh& mesh, std::size_t level) {
  std::vector<Triangle> all;
  for (const Fragment& fragment : mesh.levels[level]) {
    for (Triangle t : fragment.triangles) {
      for (Place& place : t) {
        for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += kSteps * fragment.node[axis];
      }
      all.push_back(begun_at_least(t));
    }
  }
  return all;
}

// How many edges are not gone through as often one way as the other: none of a closed mesh.
inline std::size_t count_open_edges(const std::vector<Triangle>& triangles) {
  struct Edge {
    std::array<Place, 2> ends{};
    int way = 0;
  };
  std::vector<Edge> edges;
  for (const Triangle& t : triangles) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Place &a = t[c], &b = t[(c + 1) % 3];
      a < b ? edges.push_back({{a, b}, 1}) : edges.push_back({{b, a}, -1});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.ends < b.ends; });
  std::size_t open = 0;
  for (std::size_t n = 0; n < edges.size();) {
    int balance = 0;
    const std::size_t first = n;
    for (; n < edges.size() && edges[n].ends == edges[first].ends; ++n) balance += edges[n].way;
    open += balance == 0 ? 0U : 1U;
  }
  return open;
}

// Six times the signed volume, in cubic steps.
inline double six_volumes(const std::vector<Triangle>& triangles) {
  long double sum = 0;
  for (const Triangle& t : triangles) {
    std::array<std::array<long double, 3>, 3> p{};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t axis = 0; axis < 3; ++axis) p[c][axis] = static_cast<long double>(t[c][axis]);
    }
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
      sum += p[0][a] * (p[1][b] * p[2][c] - p[1][c] * p[2][b]);
    }
  }
  return static_cast<double>(sum);
}

// Whether a triangle lies in one node, or, of coarser levels, in one eighth of one.
inline bool is_whole(const Triangle& t, bool eighths) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
    for (std::int64_t side = low / kSteps * kSteps; side < high; side += kSteps) {
      if (side > low) return false;
      if (eighths && side + kMiddle > low && side + kMiddle < high) return false;
    }
  }
  return true;
}

}  // namespace isoweave::octree
