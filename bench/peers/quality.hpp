// How good a simplified mesh is, against the full surface.
#pragma once

#include "child.hpp"
#include "isoweave/mesh.hpp"

namespace bench {

// The full surface lies in a file, so that it does not count as memory of the runs that do not need it.
struct FullSurface {
  std::string path;
  double voxel = 1;  // unit of the distances
};

// Share of the triangles with an angle below 5 degrees.
double sliver_share(const isoweave::TriangleMesh& mesh);

Json quality(const isoweave::TriangleMesh& mesh, const FullSurface& full);

}  // namespace bench
