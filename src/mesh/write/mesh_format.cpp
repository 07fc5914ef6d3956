#include "mesh/write/mesh_format.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "files/atomic_folder.hpp"
#include "isoweave/error.hpp"
#include "mesh/write/mesh_file_sink.hpp"

namespace isoweave {
namespace {

constexpr std::array<std::pair<std::string_view, MeshFormat>, 8> kEndings{{{".ply", MeshFormat::kPly},
                                                                           {".stl", MeshFormat::kStl},
                                                                           {".obj", MeshFormat::kObj},
                                                                           {".off", MeshFormat::kOff},
                                                                           {".glb", MeshFormat::kGlb},
                                                                           {".vtp", MeshFormat::kVtp},
                                                                           {".3mf", MeshFormat::k3mf},
                                                                           {".precomputed", MeshFormat::kPrecomputed}}};

std::string lower_case_ending(const std::string& path) {
  const std::size_t name = path.rfind('/') == std::string::npos ? 0 : path.rfind('/') + 1;
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos || dot < name) return "";
  std::string ending = path.substr(dot);
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

bool packs(MeshFormat format) { return format == MeshFormat::kGlb || format == MeshFormat::kPrecomputed; }

// Refuses options that the format has no place for.
void check_options(const std::string& path, MeshFormat format, const MeshFileOptions& options) {
  if (options.compress && !packs(format)) {
    throw CannotWrite(path + ": expected a name that ends in .glb or .precomputed for a compressed mesh");
  }
  if (options.segment != 1 && format != MeshFormat::kPrecomputed) {
    throw CannotWrite(path + ": expected a name that ends in .precomputed for an object with a number");
  }
  if (options.values && !holds_values(format)) {
    throw CannotWrite(path + ": expected a name that ends in .ply or .vtp for a mesh with values at its vertices");
  }
  if (options.segment == 0) throw CannotWrite(path + ": expected a number of 1 or more for the object, found 0");
}

// The size of a packed file, as measured on scans.
std::uint64_t packed_bytes(const std::string& path, MeshFormat format, std::uint64_t vertices, std::uint64_t triangles,
                           bool normals) {
  if (format == MeshFormat::kPrecomputed) return vertices * 2 + triangles;
  check_count_fits(path, "triangles", 0, triangles, kMostPackedTriangles);
  return vertices * (normals ? 8 : 4) + triangles * 3 / 2;
}

}  // namespace

MeshFormat mesh_format(const std::string& path) {
  const std::string ending = lower_case_ending(without_slashes(path));
  std::string names;
  for (const auto& [known, format] : kEndings) {
    // A folder may be named with a slash behind it, a file may not.
    if (ending == known && (format == MeshFormat::kPrecomputed || !path.ends_with('/'))) return format;
    names += (names.empty() ? "" : known == kEndings.back().first ? " or " : ", ") + std::string(known);
  }
  throw CannotWrite(path + ": expected a name that ends in " + names);
}

bool holds_values(MeshFormat format) { return format == MeshFormat::kPly || format == MeshFormat::kVtp; }

MeshFormat checked_mesh_format(const std::string& path, const MeshFileOptions& options) {
  const MeshFormat format = mesh_format(path);
  check_options(path, format, options);
  return format;
}

void check_count_fits(const std::string& path, const char* what, std::uint64_t have, std::uint64_t more,
                      std::uint64_t most) {
  if (have > most || more > most - have) {
    throw CannotWrite(path + ": the format holds at most " + std::to_string(most) + " " + what + ", the mesh has more");
  }
}

void check_glb_fits(const std::string& path, std::uint64_t vertices, std::uint64_t triangles, bool normals,
                    std::uint64_t other) {
  constexpr std::uint64_t kMost = 0xffffffffU;
  const std::uint64_t each = normals ? 24 : 12;
  const bool fits =
      other < kMost && vertices < kMost && triangles < kMost && vertices * each + triangles * 12 <= kMost - other;
  if (!fits) {
    throw CannotWrite(path +
                      ": a GLB file has at most 4294967295 bytes, the mesh needs more: simplify it further, or "
                      "write .ply or .vtp");
  }
}

std::unique_ptr<MeshSink> open_mesh_file(const std::string& path, const MeshFileOptions& options) {
  const MeshFormat format = checked_mesh_format(path, options);
  const MeshTarget file{path};
  switch (format) {
    case MeshFormat::kPly:
      return open_ply(file, options);
    case MeshFormat::kStl:
      return open_stl(file, options);
    case MeshFormat::kObj:
      return open_obj(file, options);
    case MeshFormat::kOff:
      return open_off(file, options);
    case MeshFormat::kGlb:
      return options.compress ? open_packed_glb(file, options) : open_glb(file, options);
    case MeshFormat::kVtp:
      return open_vtp(file, options);
    case MeshFormat::k3mf:
      return open_3mf(file, options);
    case MeshFormat::kPrecomputed:
      break;
  }
  if (options.compress) return std::move(open_mesh_levels(path, {&options, 1}).front());
  return open_precomputed({path, MeshTarget::Kind::kFolder}, options);
}

void write_mesh(const std::string& path, const TriangleMesh& mesh, const MeshFileOptions& options) {
  constexpr std::size_t kAtOnce = std::size_t{1} << 16;
  MeshFileOptions placed = options;
  placed.offset = mesh.offset;
  if (placed.unit.empty()) placed.unit = mesh.unit;
  if (placed.space.empty()) placed.space = mesh.space;
  const std::unique_ptr<MeshSink> sink = open_mesh_file(path, placed);
  sink->append({.vertices = mesh.vertices, .normals = mesh.normals, .values = mesh.values});
  std::vector<Triangle64> block;
  for (std::size_t first = 0; first < mesh.triangles.size(); first += kAtOnce) {
    block.clear();
    for (std::size_t t = first; t < std::min(first + kAtOnce, mesh.triangles.size()); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      block.push_back({a, b, c});
    }
    sink->append({.triangles = block});
  }
  sink->finish();
}

std::unique_ptr<MeshSink> open_mesh_stream(int descriptor, const std::string& name, const std::string& format,
                                           const MeshFileOptions& options) {
  const MeshTarget stream{name, MeshTarget::Kind::kStream, descriptor};
  if (format == "ply") return open_ply(stream, options);
  if (options.values)
    throw std::invalid_argument("expected ply as the format of a stream with values, found '" + format + "'");
  if (format == "stl") return open_stl(stream, options);
  throw std::invalid_argument("expected ply or stl as the format of a stream, found '" + format + "'");
}

std::uint64_t mesh_file_bytes(const std::string& path, std::uint64_t vertices, std::uint64_t triangles,
                              const MeshFileOptions& options) {
  // Lines of text, and what packing leaves of triangles: as measured on scans.
  constexpr std::uint64_t kTextVertex = 32, kObjFace = 24, kOffFace = 22, k3mfVertex = 14, k3mfTriangle = 7;
  const MeshFormat format = checked_mesh_format(path, options);
  if (options.compress) return packed_bytes(path, format, vertices, triangles, options.normals);
  const std::uint64_t raw_vertex = std::uint64_t{12} + (options.normals ? 12 : 0) + (options.values ? 4 : 0);
  const std::uint64_t placed_vertex = raw_vertex + (has_offset(options) ? 12 : 0);
  switch (format) {
    case MeshFormat::kPly:
      check_count_fits(path, "vertices", 0, vertices);
      return vertices * placed_vertex + triangles * 13;
    case MeshFormat::kStl:
      check_count_fits(path, "triangles", 0, triangles);
      return triangles * 50;
    case MeshFormat::kObj:
      return (vertices * kTextVertex + triangles * kObjFace) * (options.normals ? 2 : 1);
    case MeshFormat::kOff:
      return vertices * kTextVertex * (options.normals ? 2 : 1) + triangles * kOffFace;
    case MeshFormat::kGlb:
      check_glb_fits(path, vertices, triangles, options.normals, 0);
      return vertices * raw_vertex + triangles * 12;
    case MeshFormat::kVtp:
      return vertices * placed_vertex + triangles * 32;
    case MeshFormat::k3mf:
      check_count_fits(path, "vertices", 0, vertices, kMost3mfVertices);
      return vertices * k3mfVertex + triangles * k3mfTriangle;
    case MeshFormat::kPrecomputed:
      break;
  }
  check_count_fits(path, "vertices", 0, vertices);
  return vertices * 12 + triangles * 12;
}

std::uint64_t mesh_file_memory(const std::string& path, std::uint64_t vertices, std::uint64_t triangles,
                               const MeshFileOptions& options) {
  // Measured; for GLB as the packing of indices begins. For .precomputed: triangles that are sorted, vertices that are
  // kept, and one fragment; a small mesh is one, as Draco's tables of corners are built.
  constexpr std::uint64_t kGlbVertex = 44, kGlbNormal = 16, kGlbTriangle = 38, kDracoVertex = 50, kDracoTriangle = 62;
  constexpr std::uint64_t kOctree = 56'000'000;
  const MeshFormat format = mesh_format(path);
  if (format == MeshFormat::kStl) return vertices * 12;
  if (!options.compress) return 0;
  if (format == MeshFormat::kPrecomputed)
    return std::min(kOctree, vertices * kDracoVertex + triangles * kDracoTriangle);
  return vertices * (kGlbVertex + (options.normals ? kGlbNormal : 0)) + triangles * kGlbTriangle;
}

}  // namespace isoweave
