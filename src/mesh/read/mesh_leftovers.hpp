// The parts of a mesh file that a TriangleMesh does not keep.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "isoweave/mesh.hpp"

namespace isoweave::mesh_io {

// Points and lines, as some programs write them.
inline constexpr std::string_view kFewCorners = "faces of fewer than three corners";

class MeshLeftovers {
 public:
  // A property of vertices or faces, named once however often it comes.
  void not_kept(std::string_view what);

  // Elements, counted: "3 lines".
  void left_out(std::uint64_t count, std::string_view what);

  // Adds the leftovers to the notes: one line for properties, and one for elements.
  void note(TriangleMesh& mesh) const;

 private:
  std::vector<std::string> not_kept_;
  std::vector<std::pair<std::string, std::uint64_t>> left_out_;
};

}  // namespace isoweave::mesh_io
