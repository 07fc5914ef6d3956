// Parts of a surface that are not connected, and which of them are kept.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// Which components of a surface are kept, by their triangles before anything is simplified, so whatever the error.
struct ComponentRule {
  std::uint64_t min_triangles = 0;  // those with fewer are dropped
  bool largest = false;  // all but the largest are dropped; of equal ones the first that the sweep meets stays

  bool keeps_all() const { return min_triangles <= 1 && !largest; }
};

// The components of a volume's surface that are kept: what choose_components found, for MeshOptions::components.
struct ComponentChoice {
  ComponentRule rule;
  std::uint64_t components = 0, triangles = 0;                  // kept
  std::uint64_t components_dropped = 0, triangles_dropped = 0;  // triangles before simplification

  // For mesh_volume. A seed is a vertex with which a part of a layer's surface begins that nothing below it is
  // connected to; every component has one. 8 bytes each, in ascending order.
  std::vector<std::uint64_t> seeds;
  bool seeds_are_kept = false;  // seeds of what is kept, else of what is dropped: of which there are fewer
  std::string surface;          // in which they were found: volume, iso-value, caps
};

// What keep_components() has dropped.
struct DroppedComponents {
  std::uint64_t components = 0, triangles = 0;
  std::uint64_t vertices = 0;  // those that no triangle used as well
};

// Drops components of a mesh: triangles are connected where they share a vertex. What is left keeps its order; vertices
// that no triangle uses go as well. Of equal components the one with the smallest vertex index is the largest.
DroppedComponents keep_components(TriangleMesh& mesh, const ComponentRule& rule);

}  // namespace isoweave
#pragma GCC visibility pop
