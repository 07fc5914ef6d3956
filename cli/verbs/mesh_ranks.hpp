// isoweave-mpi mesh: one mesh by all ranks.
#pragma once

#include "isoweave/ranks.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// Meshes the volume by the ranks of a link. The first one writes all outputs.
void run_mesh_in_ranks(MeshArguments arguments, RankLink& link);

}  // namespace isoweave::cli
