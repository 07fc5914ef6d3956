// Keeps a mesh in memory.
#pragma once

#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

#include "isoweave/mesh.hpp"

namespace isoweave::cli {

class MemorySink final : public MeshSink {
 public:
  void append(std::span<const Point> vertices, std::span<const Point> normals,
              std::span<const std::array<std::uint64_t, 3>> triangles) override {
    mesh_.vertices.insert(mesh_.vertices.end(), vertices.begin(), vertices.end());
    mesh_.normals.insert(mesh_.normals.end(), normals.begin(), normals.end());
    if (mesh_.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw std::length_error("more than 2^32 - 1 vertices");
    }
    for (const auto& t : triangles) {
      mesh_.triangles.push_back(
          {static_cast<std::uint32_t>(t[0]), static_cast<std::uint32_t>(t[1]), static_cast<std::uint32_t>(t[2])});
    }
  }

  void finish() override {}

  TriangleMesh take() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
};

}  // namespace isoweave::cli
