// mesh --preview: a quick look at a volume's surface.
#pragma once

#include "isoweave/pipeline.hpp"
#include "report/evidence.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// Makes the preview in place of the mesh that the other options ask for.
void mesh_preview(const MeshArguments& arguments, const MeshOptions& options, SliceSource& volume, RunControl control,
                  Evidence& evidence);

}  // namespace isoweave::cli
