// The options of runs, from the structs of the C interface.
#pragma once

#include <cstdint>
#include <string>

#include "capi/handles.hpp"
#include "isoweave/isoweave.h"
#include "isoweave/mesh_options.hpp"
#include "isoweave/run.hpp"

namespace isoweave::capi {

// The unit of a volume or mesh, and the diagonal of its box, of which a length may be a percentage.
struct LengthBasis {
  std::string unit;
  double diagonal = 0;
};

// How a run ends, with lengths in the unit of the input. usual: the error where the caller names nothing to stop at;
// empty: that is refused.
// @throws std::invalid_argument
SimplifyOptions simplify_options(const iw_simplify_options& given, const LengthBasis& basis, const std::string& usual);

ComponentRule component_rule(const iw_simplify_options& given);

// Everything but the choice of components, which takes a pass over the volume.
MeshOptions mesh_options(const iw_mesh_options& given, const iw_simplify_options& simplify, const VolumeInfo& info);

RunControl run_control(const iw_run& given);

}  // namespace isoweave::capi
