// One task of a mesh in blocks: from files to files.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files/file_lock.hpp"
#include "isoweave/error.hpp"
#include "isoweave/tasks.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/task_folder.hpp"
#include "pipeline/parts/task_work.hpp"

namespace isoweave {
namespace {

class TaskRun {
 public:
  TaskRun(const TaskMesh& mesh, std::uint64_t number, const RunControl& control)
      : mesh_(mesh),
        number_(number),
        control_(control),
        task_(resolve_blocks(RunKind::kBlocks, *mesh.open(), mesh.options, mesh.blocks, control, {0, 0, 0})),
        identity_(identity_of_tasks(mesh, task_)),
        stages_(task_, mesh.blocks),
        givers_(stages_.givers_of(number)),
        executor_(control.threads) {}

  TaskEnd run() {
    const auto is_done = [&](std::uint64_t giver) { return has_result(mesh_.folder, giver); };
    if (!std::all_of(givers_.begin(), givers_.end(), is_done)) return TaskEnd::kTooEarly;
    TaskResult result = work();
    require_unchanged(task_, identity_.run);
    write_result(mesh_.folder, identity_, number_, result);
    return TaskEnd::kDone;
  }

 private:
  TaskResult work() const {
    const CostBits limit = limit_of_tasks(task_.simplify, identity_.head_start);
    TaskWork work(task_, limit, stages_, number_, control_, executor_, [] {});
    if (givers_.empty()) return work.extract(mesh_.open);
    try {
      return work.glue(TaskFolder(mesh_.folder, identity_, task_.simplify).parts_for(number_, givers_));
    } catch (const UnfitParts& unfit) {
      throw BadInput(mesh_.folder + ": the files for task " + std::to_string(number_) +
                     " do not fit together: " + unfit.what());
    }
  }

  const TaskMesh& mesh_;
  const std::uint64_t number_;
  const RunControl& control_;
  const Task task_;
  const TaskIdentity identity_;
  const BlockStages stages_;
  const std::vector<std::uint64_t> givers_;  // tasks; none in the first stage
  const Executor executor_;
};

}  // namespace

TaskList list_tasks(const TaskMesh& mesh) {
  const Task task = resolve_blocks(RunKind::kBlocks, *mesh.open(), mesh.options, mesh.blocks, {}, {0, 0, 0});
  return BlockStages(task, mesh.blocks).tasks();
}

std::string facts_of_volume(const VolumeInfo& volume) { return volume_text(volume); }

TaskEnd do_task(const TaskMesh& mesh, std::uint64_t task, const RunControl& control) {
  const StandardFloats floats;
  // A worker that waits for others asks again and again. So the volume is opened only once the task is to be worked on.
  if (has_result(mesh.folder, task)) return TaskEnd::kDoneBefore;
  const std::optional<FileLock> lock = FileLock::take(mesh.folder + "/" + std::to_string(task) + ".lock");
  if (!lock) return TaskEnd::kElsewhere;
  if (has_result(mesh.folder, task)) return TaskEnd::kDoneBefore;
  return TaskRun(mesh, task, control).run();
}

bool is_done(const TaskMesh& mesh, std::uint64_t task) { return has_result(mesh.folder, task); }

}  // namespace isoweave
