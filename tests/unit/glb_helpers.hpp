// Several meshes in one file: written piece by piece, and a GLB file taken apart by nothing of ours.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "files.hpp"
#include "isoweave/mesh.hpp"

namespace isoweave::glb_files {

using Json = nlohmann::json;

// A part of the triangles; the vertices come with the first.
inline void append(MeshSink& sink, const TriangleMesh& mesh, std::size_t first, std::size_t end) {
  std::vector<std::array<std::uint64_t, 3>> triangles;
  for (std::size_t n = first; n < std::min(end, mesh.triangles.size()); ++n) {
    const auto& [a, b, c] = mesh.triangles[n];
    triangles.push_back({a, b, c});
  }
  if (first > 0) return sink.append({.triangles = triangles});
  sink.append({mesh.vertices, mesh.normals, {}, triangles});
}

struct Glb {
  explicit Glb(const std::string& path) : bytes(files::read_bytes(path)) {
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    scene = Json::parse(bytes.substr(20, length));
    data = 28 + length;
  }

  template <class Item>
  std::vector<Item> array(const Json& accessor) const {
    const Json& view =
        scene["bufferViews"][scene["accessors"][accessor.get<std::size_t>()]["bufferView"].get<std::size_t>()];
    std::vector<Item> items(view["byteLength"].get<std::size_t>() / sizeof(Item));
    std::memcpy(items.data(), bytes.data() + data + view["byteOffset"].get<std::size_t>(), items.size() * sizeof(Item));
    return items;
  }

  std::string bytes;
  Json scene;
  std::size_t data = 0;
};

}  // namespace isoweave::glb_files
