// The surfaces that a page holds, and their distances from the full surface.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "isoweave/measure.hpp"
#include "isoweave/mesh.hpp"
#include "isoweave/pipeline.hpp"
#include "page/page.hpp"

namespace isoweave::cli {

struct PageSurface {
  std::string name;  // "full"; "finer" for levels of detail; "mesh" or "stand-in"; "level" for coarser ones of our
                     // own; "iso" for several iso-values
  TriangleMesh mesh;
  std::vector<float> distances{};      // of the vertices from the full surface, or none yet
  std::optional<std::size_t> level{};  // number among the levels of detail of the run
  std::optional<std::size_t> iso{};    // number among the iso-values of the run
  bool stands_in = false;              // has fewer triangles than the mesh that it is shown for
};

// Distances of a mesh from the full surface.
struct PageErrors {
  std::uint64_t vertices = 0;
  double mean = 0, rms = 0, max = 0;      // at the vertices of the mesh
  std::vector<std::uint64_t> counts;      // of vertices, in bins of equal width from 0 to max
  std::optional<MeshDistance> sampled{};  // between the surfaces, both ways; where the full one is held
  std::uint64_t samples = 0;
};

struct PageSurfaces {
  std::vector<PageSurface> surfaces;  // in the order above; none for a mesh without triangles
  std::optional<PageErrors> errors;   // where there is a full surface
  bool lacks_finer = false;           // some levels of detail have more triangles than a page shows
  std::uint64_t full_triangles = 0;   // of the surface that "full" stands in for, or 0
};

// Makes the surfaces of a page. A mesh of more triangles is replaced by a stand-in of about so many. Coarser levels are
// made where the run made none.
PageSurfaces page_surfaces(PageContents contents, std::uint64_t most_triangles, const RunControl& control);

// Makes the surfaces of several iso-values, all at one offset. Values without triangles have none. Stand-ins take the
// place of surfaces so that all have about most_triangles together.
PageSurfaces iso_surfaces(std::vector<TriangleMesh> isos, std::uint64_t most_triangles, const RunControl& control);

}  // namespace isoweave::cli
