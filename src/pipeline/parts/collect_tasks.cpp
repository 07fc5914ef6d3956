// The meshes out of the files of all tasks.
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "isoweave/error.hpp"
#include "isoweave/tasks.hpp"
#include "parallel/float_environment.hpp"
#include "pipeline/loop.hpp"
#include "pipeline/parts/task_collector.hpp"
#include "pipeline/parts/task_folder.hpp"
#include "pipeline/run_report.hpp"

namespace isoweave {
namespace {

class CollectRun {
 public:
  CollectRun(const TaskMesh& mesh, std::span<MeshSink* const> sinks, const RunControl& control)
      : mesh_(mesh),
        control_(control),
        task_(resolve_blocks(RunKind::kBlocks, *mesh.open(), mesh.options, mesh.blocks, control, {0, 0, 0})),
        identity_(identity_of_tasks(mesh, task_)),
        folder_(mesh.folder, identity_, task_.simplify),
        stages_(task_, mesh.blocks),
        executor_(control.threads),
        collector_(task_, identity_.head_start, stages_, sinks, control_, executor_, mesh.folder, "") {}

  MeshReport run() {
    Stopwatch total;
    const std::uint64_t count = stages_.tasks().count();
    for (std::uint64_t task = 0; task < count; ++task) collector_.count(task, facts_of(task, count));
    task_.simplify.goal.given() ? end_at_number(count) : write(count);
    MeshReport report = collector_.finish();
    total.lap(report.seconds_total);
    return report;
  }

 private:
  void write(std::uint64_t count) {
    collector_.check_counts();
    for (std::uint64_t task = 0; task < count; ++task) {
      check_stop(control_);
      collector_.write(task, folder_.mesh(task).pieces);
    }
  }

  void end_at_number(std::uint64_t count) {
    for (std::uint64_t task = 0; task < count; ++task) {
      check_stop(control_);
      collector_.keep(std::move(*folder_.mesh(task).kept));
    }
    collector_.check_counts();
    const std::optional<CostBits> lower = collector_.end_at_number();
    if (!lower) return;
    throw HeadStartTooHigh(mesh_.folder + ": expected tasks that leave more than " +
                               std::to_string(collector_.number()) + " triangles, found " +
                               std::to_string(collector_.kept()),
                           head_start_within(*lower, task_.volume));
  }

  TaskFacts facts_of(std::uint64_t task, std::uint64_t count) const {
    if (has_result(mesh_.folder, task)) {
      return folder_.facts(task);
    }
    throw BadInput(mesh_.folder + ": expected all " + std::to_string(count) + " tasks to be done, found task " +
                   std::to_string(task) + " undone");
  }

  const TaskMesh& mesh_;
  const RunControl& control_;
  const Task task_;
  const TaskIdentity identity_;
  const TaskFolder folder_;
  const BlockStages stages_;
  const Executor executor_;
  TaskCollector collector_;
};

}  // namespace

MeshReport collect_tasks(const TaskMesh& mesh, std::span<MeshSink* const> sinks, const RunControl& control) {
  const StandardFloats floats;
  check_sinks(sinks, mesh.options.levels.size());
  return CollectRun(mesh, sinks, control).run();
}

}  // namespace isoweave
