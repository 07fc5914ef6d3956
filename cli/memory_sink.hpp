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
  void append(const MeshPiece& piece) override {
    mesh_.vertices.insert(mesh_.vertices.end(), piece.vertices.begin(), piece.vertices.end());
    mesh_.normals.insert(mesh_.normals.end(), piece.normals.begin(), piece.normals.end());
    mesh_.values.insert(mesh_.values.end(), piece.values.begin(), piece.values.end());
    if (mesh_.vertices.size() > std::numeric_limits<std::uint32_t>::max()) {
      throw std::length_error("more than 2^32 - 1 vertices");
    }
    for (const auto& t : piece.triangles) {
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
