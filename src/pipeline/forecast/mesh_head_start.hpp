// The head start of a run that simplifies a mesh to a number of triangles: samples of the mesh are simplified first.
#pragma once

#include "isoweave/mesh.hpp"
#include "isoweave/mesh_options.hpp"
#include "isoweave/run.hpp"
#include "parallel/parallel.hpp"
#include "pipeline/task.hpp"

namespace isoweave {

// An error that is expected to leave clearly more triangles than the number of the options; 0: none is known, as of a
// small mesh. Takes a tenth of the time of simplifying a small mesh, a twentieth of that of a large one. `measure` is
// that of the mesh, whose triangles have been checked. Of the control `stop` counts.
double mesh_head_start(const TriangleMesh& mesh, const SimplifyOptions& options, const SurfaceMeasure& measure,
                       const Executor& executor, const RunControl& control);

}  // namespace isoweave
