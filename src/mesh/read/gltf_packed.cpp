#include "mesh/read/gltf_packed.hpp"

#include <meshoptimizer.h>

#include <optional>

namespace isoweave::mesh_io {
namespace {

using Bytes = std::vector<std::byte>;

constexpr int kUnknownHeader = -1;  // what meshoptimizer returns for the first byte of another mode or version

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

// The version of packed data, which is the lower half of their first byte. Nothing where the upper half is that of
// another mode.
std::optional<int> version_of(const PackedForm& form, std::span<const std::byte> packed) {
  const int mode = form.mode == "ATTRIBUTES" ? 0xa : form.mode == "TRIANGLES" ? 0xe : 0xd;
  const int first = packed.empty() ? 0 : std::to_integer<int>(packed.front());
  return first >> 4 == mode ? std::optional(first & 0xf) : std::nullopt;
}

[[noreturn]] void refuse(const MeshInput& input, const PackedForm& form, std::span<const std::byte> packed, int error) {
  const std::optional<int> version = error == kUnknownHeader ? version_of(form, packed) : std::nullopt;
  if (version) {
    constexpr int kMajor = MESHOPTIMIZER_VERSION / 1000, kMinor = MESHOPTIMIZER_VERSION % 1000 / 10;
    input.fail("expected " + form.mode + " packed in a version that meshoptimizer " + std::to_string(kMajor) + "." +
               std::to_string(kMinor) + " reads, found version " + std::to_string(*version) +
               ": a build with a later one may read it");
  }
  input.fail("expected " + std::to_string(form.count) + " items packed by meshoptimizer, found damaged data");
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
  const int error = unpack(form, {bytes, packed.size()}, items);
  if (error != 0) refuse(input, form, packed, error);
  apply_filter(form, items);
  return items;
}

}  // namespace isoweave::mesh_io
