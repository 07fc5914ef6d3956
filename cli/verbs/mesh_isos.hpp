// mesh --iso with several values: a mesh for each, in a file of its own.
#pragma once

#include <vector>

#include "isoweave/pipeline.hpp"
#include "report/evidence.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// Whether --iso has several values, with commas between them.
bool has_several_isos(const MeshArguments& arguments);

// Refuses values and options that do not go with several values, before any file is looked at. The library refuses the
// rest: see require_possible.
void check_isos(const MeshArguments& arguments);

// Makes one mesh for each value in one pass over the volume, or says what that would take.
void mesh_iso_files(const MeshArguments& arguments, const MeshOptions& options, SliceSource& volume, RunControl control,
                    Evidence& evidence);

}  // namespace isoweave::cli
