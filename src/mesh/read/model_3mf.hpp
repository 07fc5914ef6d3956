// The part of a 3MF package that has a model: objects, and the items that are to be built from them.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh/read/mesh_input.hpp"
#include "mesh/read/placement.hpp"
#include "mesh/read/zip_input.hpp"

namespace isoweave::mesh_io {

// An object that is placed, in this part or in another one (production extension).
struct PlacedObject {
  std::string part;  // empty: this one
  std::uint32_t id = 0;
  Placement placement;
};

// A mesh, or other objects.
struct ModelObject {
  std::string type;
  std::vector<WidePoint> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<PlacedObject> components;
};

struct Model {
  std::string unit = "millimeter";
  std::string application, description;  // metadata
  bool has_materials = false;
  std::map<std::uint32_t, ModelObject> objects;
  std::vector<PlacedObject> items;
};

// Fails on everything that differs from the core specification, and on required extensions that change the shape.
Model read_model(MeshInput& input, const ZipRecord& record);

}  // namespace isoweave::mesh_io
