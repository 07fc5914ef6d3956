// The work of one task of a mesh in blocks, from a volume or from parts to final triangles and to parts for the tasks
// of the next stage.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/block_worker.hpp"
#include "pipeline/parts/kept_triangles.hpp"
#include "pipeline/parts/task_file.hpp"
#include "simplify/part_algebra.hpp"

namespace isoweave {

// The outcome of a task.
struct TaskResult {
  TaskFacts facts;
  std::vector<std::vector<FinalPiece>> pieces;  // per level
  std::vector<SplitPart> parts;                 // as in the facts: the owner is the task that gets the part
  std::optional<KeptTriangles> kept;            // of a run to a number of triangles, which has no pieces

  // Its part of the mesh: the pieces, or what is kept. Written, and read into an empty result; throws BadInput.
  void write_mesh(StateWriter& state);
  void read_mesh(StateReader& state, const PartShape& shape, bool to_number);
};

// The cost up to which tasks decide: that of the error, or that of the head start where the run is to a number.
CostBits limit_of_tasks(const SimplifyTask& task, CostBits head_start);

class TaskWork {
 public:
  // limit: that of all tasks. between: is called now and then while the work is going on. All arguments must outlive
  // the work.
  TaskWork(const Task& task, CostBits limit, const BlockStages& stages, std::uint64_t number, const RunControl& control,
           const Executor& executor, std::function<void()> between);

  // The result of a task of the first stage. open: opens the volume.
  TaskResult extract(const VolumeOpener& open);

  // The result of another task, from the parts that were left to it. Throws UnfitParts.
  TaskResult glue(std::vector<ZonePart> parts);

 private:
  void take(Simplifier& simplifier, std::size_t level);
  void keep_final(Simplifier& simplifier, std::size_t level);
  TaskResult result_of(ZonePart rest);
  std::vector<SplitPart> split(ZonePart rest) const;
  void count();

  const Task& task_;
  const BlockStages& stages_;
  const std::uint64_t number_;
  const TaskList tasks_;
  const std::size_t stage_;
  const std::function<void()> between_;
  MeshReport report_;
  BlockWorker worker_;
  TaskResult result_;
};

}  // namespace isoweave
