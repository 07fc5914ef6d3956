// Stands in for the writers whose libraries the build lacks: an error that says which option brings them in.
#include "isoweave/error.hpp"
#include "mesh/write/joined_meshes.hpp"
#include "mesh/write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

#if !defined(ISOWEAVE_HAS_MESHOPTIMIZER) || !defined(ISOWEAVE_HAS_DRACO)
[[noreturn]] void not_built(const std::string& path, const std::string& library, const std::string& option) {
  throw CannotWrite(path + ": expected a build with " + library + " for a compressed mesh (CMake option " + option +
                    "=ON), this one has none");
}
#endif

}  // namespace

#ifndef ISOWEAVE_HAS_MESHOPTIMIZER
std::unique_ptr<MeshSink> open_packed_glb(const MeshTarget& target, const MeshFileOptions&) {
  not_built(target.path, "meshoptimizer", "ISOWEAVE_MESHOPTIMIZER");
}

std::unique_ptr<JoinedFile> open_packed_glb_levels(const std::string& path, std::span<const MeshFileOptions>) {
  not_built(path, "meshoptimizer", "ISOWEAVE_MESHOPTIMIZER");
}

std::unique_ptr<JoinedFile> open_packed_glb_parts(const std::string& path, std::span<const MeshPart>) {
  not_built(path, "meshoptimizer", "ISOWEAVE_MESHOPTIMIZER");
}
#endif

#ifndef ISOWEAVE_HAS_DRACO
std::unique_ptr<JoinedFile> open_packed_precomputed_levels(const std::string& path, std::span<const MeshFileOptions>) {
  not_built(path, "Draco", "ISOWEAVE_DRACO");
}

std::unique_ptr<MeshObjects> open_packed_precomputed_objects(const std::string& path, const MeshFileOptions&) {
  not_built(path, "Draco", "ISOWEAVE_DRACO");
}
#endif

}  // namespace isoweave
