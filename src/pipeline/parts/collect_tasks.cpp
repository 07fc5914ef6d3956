// The meshes out of the files of all tasks.
#include <cstdint>
#include <span>
#include <string>

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
        task_(resolve_blocks(RunKind::kProcesses, *mesh.open(), mesh.options, mesh.blocks, control, {0, 0, 0})),
        identity_{identity_of(task_), mesh.blocks.size, mesh.blocks.first},
        stages_(task_, mesh.blocks),
        executor_(control.threads),
        collector_(task_, stages_, sinks, control_, executor_, mesh.folder) {}

  MeshReport run() {
    Stopwatch total;
    const std::uint64_t count = stages_.tasks().count();
    for (std::uint64_t task = 0; task < count; ++task) collector_.count(task, facts_of(task, count));
    collector_.check_counts();
    for (std::uint64_t task = 0; task < count; ++task) {
      check_stop(control_);
      collector_.write(task, read_finals(mesh_.folder, identity_, task, task_.simplify.level_costs.size() + 1));
    }
    MeshReport report = collector_.finish();
    total.lap(report.seconds_total);
    return report;
  }

 private:
  TaskFacts facts_of(std::uint64_t task, std::uint64_t count) const {
    if (has_result(mesh_.folder, task)) {
      return read_facts(mesh_.folder, identity_, task, task_.simplify.level_costs.size() + 1);
    }
    throw BadInput(mesh_.folder + ": expected all " + std::to_string(count) + " tasks to be done, found task " +
                   std::to_string(task) + " undone");
  }

  const TaskMesh& mesh_;
  const RunControl& control_;
  const Task task_;
  const TaskIdentity identity_;
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
