// The header of a PLY file, as it is read.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mesh/read/mesh_input.hpp"
#include "mesh/read/mesh_place.hpp"

namespace isoweave::mesh_io {

enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kInt64, kUint64, kFloat32, kFloat64 };
enum class PlyEncoding { kAscii, kLittleEndian, kBigEndian };

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;
  std::optional<PlyType> length_type;  // of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::kAscii;
  std::vector<PlyElement> elements;
  std::uint64_t vertices = 0;
  bool has_normals = false;
  std::string values;  // the property of vertices that is their value; empty: none is
  MeshPlace place;
};

std::size_t bytes_of(PlyType type);

// The fewest bytes that one record of the element takes: its lists empty, its ascii numbers one digit and a blank.
std::uint64_t least_bytes(const PlyElement& element, PlyEncoding encoding);

bool has_lists(const PlyElement& element);

// Whether its records are faces or strips of triangles.
bool is_surface(const PlyElement& element);
bool is_corner_list(const PlyProperty& property);

// Reads up to and with the line "end_header" and checks that vertices have x, y, z, and faces and strips
// their corners.
PlyHeader read_ply_header(MeshInput& input);

}  // namespace isoweave::mesh_io
