// The surfaces that a page holds, and how far they are from the one before simplification.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "isoweave/measure.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"

namespace isoweave::cli {

struct PageSurface {
  std::string name;  // "full"; "mesh" or "stand-in"; "level" for the coarser ones
  TriangleMesh mesh;
  std::vector<float> distances;  // of the vertices from the full surface, or none
};

// Distances of a mesh from the full surface.
struct PageErrors {
  std::uint64_t vertices = 0;
  double mean = 0, rms = 0, max = 0;  // at the vertices of the mesh
  std::vector<std::uint64_t> counts;  // of vertices, in bins of equal width from 0 to max
  MeshDistance sampled;               // between the surfaces, both ways
  std::uint64_t samples = 0;
};

struct PageSurfaces {
  std::vector<PageSurface> surfaces;  // in the order above; none for a mesh without triangles
  std::optional<PageErrors> errors;   // where there is a full surface
};

// A mesh of more triangles is replaced by a stand-in of about so many.
PageSurfaces page_surfaces(TriangleMesh mesh, std::optional<TriangleMesh> full, std::uint64_t most_triangles,
                           const RunControl& control);

}  // namespace isoweave::cli
