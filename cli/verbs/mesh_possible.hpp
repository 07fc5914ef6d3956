// The options of isoweave mesh that do not go together.
#pragma once

#include <optional>

#include "isoweave/pipeline.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// Refuses options that do not go together, before any file is looked at. resume: the state to go on from, if any.
void check_possible(const MeshArguments& arguments, const MeshOptions& options, const RunControl& control,
                    const std::optional<Checkpoint>& resume);

}  // namespace isoweave::cli
