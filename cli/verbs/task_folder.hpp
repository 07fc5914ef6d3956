// The folder that isoweave plan, work, status and collect share.
#pragma once

#include <string>

#include "isoweave/tasks.hpp"
#include "verbs/mesh_arguments.hpp"

namespace isoweave::cli {

// A mesh that was planned.
struct PlannedMesh {
  MeshArguments arguments;  // of isoweave mesh
  TaskMesh mesh;
  VolumeInfo volume;
};

// Makes the folder and its plan. To a number of triangles, reads some of the volume, under the control of a run. Throws
// CannotWrite where the folder holds anything.
PlannedMesh make_plan(const MeshArguments& arguments, std::int64_t block, const std::string& folder,
                      const RunControl& control);

// Gives the plan of a folder a lower head start, and removes the results of all tasks, which had a higher one.
void lower_head_start(const std::string& folder, double lower);

// Reads the plan of a folder, and opens its volume. Throws BadInput.
PlannedMesh read_plan(const std::string& folder);

// Writes the files with which make and SLURM work on the tasks.
void write_job_files(const std::string& folder, const TaskList& tasks);

}  // namespace isoweave::cli
