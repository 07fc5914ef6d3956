// What isoweave mesh saves to be resumed with, and the folders that it is kept in.
#pragma once

#include <string>
#include <string_view>

#include "isoweave/pipeline.hpp"
#include "mesh_arguments.hpp"
#include "output.hpp"

namespace isoweave::cli {

// What a saved state keeps of the command line: the task, with paths that hold wherever it is resumed.
Json task_json(const MeshArguments& arguments, const MeshOptions& options);

// The arguments of a run that goes on: the task as it was, and how to run as it is said now. Throws BadInput for a
// state with another task.
MeshArguments resumed_arguments(const MeshArguments& now, const Checkpoint& checkpoint);

// Throws BadInput.
[[noreturn]] void refuse_state(const Checkpoint& checkpoint);

// "16layers", "90s", "5min" or "2h".
void parse_every(std::string_view text, CheckpointOptions& checkpoint);

// Makes the folder for the states of a new run, and holds it. Another run's are never overwritten.
CheckpointLock make_checkpoint_folder(const std::string& folder);

// Makes the folder of the parts of a mesh. Without a state there is nothing to go on with: what is there is of a run
// that ended before its first one.
void make_part_folder(const std::string& folder);

}  // namespace isoweave::cli
