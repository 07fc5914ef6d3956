// Connected components of a surface, and the rule which of them are kept.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isoweave/mesh.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// The rule by which components of a surface are kept. It counts triangles before simplification, so its choice does not
// depend on the error.
struct ComponentRule {
  std::uint64_t min_triangles = 0;  // those with fewer are dropped
  bool largest = false;  // all but the largest are dropped; of equal ones the first that the sweep meets stays

  bool keeps_all() const { return min_triangles <= 1 && !largest; }
};

// The components of a volume's surface that are kept: the result of choose_components, for SurfaceOptions::components.
// Copies are independent of the volume.
struct ComponentChoice {
  ComponentRule rule;
  std::uint64_t components = 0, triangles = 0;                  // kept
  std::uint64_t components_dropped = 0, triangles_dropped = 0;  // triangles before simplification

  // For mesh_volume: ids of vertices, 8 bytes each, in ascending order. A seed is the first vertex of a connected part
  // of a layer's surface that is not connected to anything below it. Every component has one.
  std::vector<std::uint64_t> seeds;
  bool seeds_are_kept = false;  // these are the seeds of kept components, else of dropped ones: the fewer of the two
  std::string surface;          // the surface in which they were found: volume, iso-value, caps
};

// The counts of what keep_components() has dropped.
struct DroppedComponents {
  std::uint64_t components = 0, triangles = 0;
  std::uint64_t vertices = 0;  // also those that no triangle used
};

// Drops components of a mesh in place. Triangles are connected where they share a vertex. The rest keeps its order;
// vertices that no triangle uses are dropped as well. Of equal components the one with the smallest vertex index is the
// largest.
// @pre Every triangle refers to vertices of the mesh; normals and values are empty or one per vertex. Not checked.
// @cost Passes over triangles and vertices, in the calling thread; about 16 bytes per vertex.
DroppedComponents keep_components(TriangleMesh& mesh, const ComponentRule& rule);

}  // namespace isoweave
#pragma GCC visibility pop
