// Stands in for the readers of packed meshes whose library the build lacks: an error that says which option brings it
// in.
#include "mesh/read/gltf_packed.hpp"

#ifndef ISOWEAVE_HAS_MESHOPTIMIZER
namespace isoweave::mesh_io {

std::vector<std::byte> unpacked(const MeshInput& input, const PackedForm&, std::span<const std::byte>) {
  input.fail(
      "expected a build with meshoptimizer for a packed mesh (CMake option ISOWEAVE_MESHOPTIMIZER=ON), this one has "
      "none");
}

}  // namespace isoweave::mesh_io
#endif
