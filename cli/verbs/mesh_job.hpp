// One run of isoweave mesh, from its command line to its files.
#pragma once

#include <memory>
#include <optional>

#include "isoweave/run.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// resume: the saved state to continue from, if there is one. lock: that of its folder, or null.
void run_mesh_job(const MeshArguments& arguments, std::optional<Checkpoint> resume,
                  std::shared_ptr<const CheckpointLock> lock);

}  // namespace isoweave::cli
