// A mesh in blocks by many processes, on one machine or several, that share a folder.
//
// Every block of every stage of a run in blocks (blocks.hpp) is a task. A task reads the volume, or what tasks of the
// stage before have left, and writes two files: what is final, and what is left. Files are complete or absent. Tasks of
// a stage may be done in any order, at the same time, and again after a crash. The mesh is that of mesh_volume.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "isoweave/blocks.hpp"
#include "isoweave/error.hpp"

#pragma GCC visibility push(default)
namespace isoweave {

// The tasks of a mesh. They are numbered from 0 on, stage by stage.
struct TaskList {
  std::vector<std::uint64_t> stages;  // the number of tasks of each

  std::uint64_t count() const;
  std::uint64_t first_of(std::size_t stage) const;
  // The stage of a task.
  // @throws std::invalid_argument for a number beyond the last task
  std::size_t stage_of(std::uint64_t task) const;
};

// All that the tasks of a mesh have in common. Every process must be given the same.
struct TaskMesh {
  std::string folder;  // of the tasks' files; an existing one
  VolumeOpener open;
  MeshOptions options;
  BlockOptions blocks;  // without a folder
  // With a number of triangles: the error, in the unit of the volume, up to which tasks decide everything, as
  // Forecast::head_start. Whoever plans finds it. With 0 nothing is decided before the mesh is collected.
  double head_start = 0;
};

// The tasks of a mesh to a number of triangles have decided up to an error that leaves fewer. All of them have to be
// done again, with a lower TaskMesh::head_start.
class HeadStartTooHigh : public BadInput {
 public:
  HeadStartTooHigh(const std::string& what, double lower) : BadInput(what), lower_(lower) {}

  // The head start with which more triangles than the number are left, by the counts of the tasks.
  double lower() const { return lower_; }

 private:
  double lower_;
};

// The tasks of a mesh.
// @throws what mesh_in_blocks throws for its options
TaskList list_tasks(const TaskMesh& mesh);

// The header of a volume with the sizes and times of change of its files, as text. Tasks of volumes that differ in it
// do not go together, so whoever plans keeps it.
std::string facts_of_volume(const VolumeInfo& volume);

// The end of a call of do_task: the task is done; it was done before; another process works on it; a task of an earlier
// stage is not done yet.
enum class TaskEnd : std::uint8_t { kDone, kDoneBefore, kElsewhere, kTooEarly };

// Works on a task. Two processes never work on the same one, as files are locked.
// @throws what mesh_in_blocks throws; BadInput for a file of the folder that is damaged or of another mesh, by its
// name;
//   CannotWrite where files cannot be written or locked
// @cost As one block of mesh_in_blocks, and the final triangles of a block in memory.
TaskEnd do_task(const TaskMesh& mesh, std::uint64_t task, const RunControl& control = {});

// Whether a task is done: both of its files are there.
bool is_done(const TaskMesh& mesh, std::uint64_t task);

// Puts the results of all tasks together into sinks, one for each level and one more, and finishes the sinks.
// @throws BadInput where a task is not done, where a file is damaged or of another mesh, and where the counts of all
//   tasks do not add up; HeadStartTooHigh; and what mesh_volume throws
// @cost Memory: the final triangles of a block, and 4 bytes for each vertex of the mesh with RunControl::measure. To a
//   number of triangles, what the tasks leave becomes one surface, which ends at the number here: 350 bytes for each
//   triangle of 1.5 times the number.
MeshReport collect_tasks(const TaskMesh& mesh, std::span<MeshSink* const> sinks, const RunControl& control = {});

}  // namespace isoweave
#pragma GCC visibility pop
