// The part of the command line that isoweave mesh saves, and the folders of saved states.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "isoweave/pipeline.hpp"
#include "report/print.hpp"
#include "report/report.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// The command line in a saved state: the task, with paths that hold wherever it is resumed.
Json task_json(const MeshArguments& arguments, const MeshOptions& options);

// Sets the task of a saved command line, and the way to run where the present one does not set it. Throws
// Json::exception for another text.
void set_task(MeshArguments& arguments, const MeshArguments& now, const Json& task);

// The arguments of a resumed run: the saved task, and the way to run of the present command line. Throws BadInput for a
// state with another task.
MeshArguments resumed_arguments(const MeshArguments& now, const Checkpoint& checkpoint);

// Throws BadInput.
[[noreturn]] void refuse_state(const Checkpoint& checkpoint);

// "16layers", "90s", "5min" or "2h".
void parse_every(std::string_view text, CheckpointOptions& checkpoint);

// Makes the folder for the states of a new run, and locks it. States of another run are never overwritten.
std::shared_ptr<const CheckpointLock> begin_checkpoints(const std::string& folder);

}  // namespace isoweave::cli
