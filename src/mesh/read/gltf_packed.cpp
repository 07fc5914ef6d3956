#include "mesh/read/gltf_packed.hpp"

#include <meshoptimizer.h>

namespace isoweave::mesh_io {
namespace {

using Bytes = std::vector<std::byte>;

// Returns 0, or another number for damaged data.
int unpack(const PackedForm& form, std::span<const unsigned char> packed, Bytes& items) {
  const auto count = static_cast<std::size_t>(form.count), stride = static_cast<std::size_t>(form.stride);
  if (form.mode == "ATTRIBUTES") {
    return meshopt_decodeVertexBuffer(items.data(), count, stride, packed.data(), packed.size());
  }
  if (form.mode == "TRIANGLES") {
    return meshopt_decodeIndexBuffer(items.data(), count, stride, packed.data(), packed.size());
  }
  return meshopt_decodeIndexSequence(items.data(), count, stride, packed.data(), packed.size());
}

// Whether meshoptimizer takes the form: it checks what it unpacks, and not what it is asked for.
bool is_possible(const PackedForm& form) {
  if (form.mode == "TRIANGLES" || form.mode == "INDICES") {
    const bool whole = form.mode == "INDICES" || form.count % 3 == 0;
    return whole && (form.stride == 2 || form.stride == 4) && form.filter == "NONE";
  }
  if (form.mode != "ATTRIBUTES" || form.stride == 0 || form.stride > 256 || form.stride % 4 != 0) return false;
  if (form.filter == "OCTAHEDRAL") return form.stride == 4 || form.stride == 8;
  if (form.filter == "QUATERNION") return form.stride == 8;
  return form.filter == "NONE" || form.filter == "EXPONENTIAL";
}

void apply_filter(const PackedForm& form, Bytes& items) {
  const auto count = static_cast<std::size_t>(form.count), stride = static_cast<std::size_t>(form.stride);
  if (form.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(items.data(), count, stride);
  if (form.filter == "QUATERNION") meshopt_decodeFilterQuat(items.data(), count, stride);
  if (form.filter == "EXPONENTIAL") meshopt_decodeFilterExp(items.data(), count, stride);
}

}  // namespace

Bytes unpacked(const MeshInput& input, const PackedForm& form, std::span<const std::byte> packed) {
  if (!is_possible(form)) {
    input.fail("expected packed data of a mode, a stride and a filter of EXT_meshopt_compression, found '" +
               form.mode.substr(0, 20) + "', " + std::to_string(form.stride) + " and '" + form.filter.substr(0, 20) +
               "'");
  }
  Bytes items(static_cast<std::size_t>(form.count * form.stride));
  if (form.count == 0) return items;
  const auto* const bytes = reinterpret_cast<const unsigned char*>(packed.data());
  if (unpack(form, {bytes, packed.size()}, items) != 0) {
    input.fail("expected " + std::to_string(form.count) + " items packed by meshoptimizer, found damaged data");
  }
  apply_filter(form, items);
  return items;
}

}  // namespace isoweave::mesh_io
