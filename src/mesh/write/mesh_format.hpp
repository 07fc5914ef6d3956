// The limits of the mesh formats: options and counts.
#pragma once

#include <cstdint>
#include <string>

#include "isoweave/mesh.hpp"

namespace isoweave {

// mesh_format() of a path. Throws as well for options that the format does not have.
MeshFormat checked_mesh_format(const std::string& path, const MeshFileOptions& options);

// Throws CannotWrite when `have` + `more` is more than the most that a format holds.
void check_count_fits(const std::string& path, const char* what, std::uint64_t have, std::uint64_t more,
                      std::uint64_t most = 0xffffffffU);

// Throws CannotWrite when the sections of a GLB file with `other` bytes beside them would pass 4 GiB.
void check_glb_fits(const std::string& path, std::uint64_t vertices, std::uint64_t triangles, bool normals,
                    std::uint64_t other);

// 3MF numbers vertices below this. Packed meshes: the libraries count corners in 32 bits.
inline constexpr std::uint64_t kMost3mfVertices = std::uint64_t{1} << 31;
inline constexpr std::uint64_t kMostPackedTriangles = std::uint64_t{1} << 29;

}  // namespace isoweave
