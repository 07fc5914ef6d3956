// Data of glTF that meshoptimizer has packed (EXT_meshopt_compression).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "mesh/read/mesh_input.hpp"

namespace isoweave::mesh_io {

struct PackedForm {
  std::uint64_t count = 0;   // items
  std::uint64_t stride = 0;  // bytes of an item
  std::string mode;          // ATTRIBUTES, TRIANGLES or INDICES
  std::string filter;        // NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL
};

// The items, one after another. Fails for damaged data, for a form that there is not, and in a build without
// meshoptimizer.
// @pre count * stride is a size that the caller wants to hold.
std::vector<std::byte> unpacked(const MeshInput& input, const PackedForm& form, std::span<const std::byte> packed);

}  // namespace isoweave::mesh_io
