// Puts the results of all tasks of a mesh together: their final triangles into sinks, their counts into a report.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "output/final_output.hpp"
#include "output/world.hpp"
#include "pipeline/parts/block_mesh.hpp"
#include "pipeline/parts/blocks_to_number.hpp"
#include "pipeline/parts/task_file.hpp"

namespace isoweave {

class TaskCollector {
 public:
  // head_start: that of the tasks. sinks: one for each level and one more. name: the folder or the volume, for
  // messages. scratch: a folder in which what is kept waits; empty: it waits in memory. All other arguments must
  // outlive the collector.
  TaskCollector(Task task, CostBits head_start, const BlockStages& stages, std::span<MeshSink* const> sinks,
                const RunControl& control, const Executor& executor, std::string name, const std::string& scratch);

  // Adds the counts of a task.
  void count(std::uint64_t task, const TaskFacts& facts);

  // Of a run to a number of triangles, whose tasks decide up to the cost of a head start: takes what a task keeps.
  void keep(KeptTriangles kept) { number_->keep(std::move(kept)); }
  std::uint64_t kept() const { return number_->kept(); }
  std::uint64_t number() const { return number_->number(); }

  // Of such a run, after check_counts(): ends the mesh at the number, and writes it. Returns the head start of the run
  // that has to take the place of this one, as its own was too high: nothing has been written then. Throws BadInput for
  // counts that give no lower one, and for parts that are not of one surface.
  std::optional<CostBits> end_at_number();

  // Whether all vertices that final triangles of a task name have been written.
  bool can_write(std::uint64_t task, const std::vector<std::vector<FinalPiece>>& pieces) const;

  // Writes the final triangles of a task. Throws BadInput for one that names vertices which have not been written.
  void write(std::uint64_t task, std::vector<std::vector<FinalPiece>> pieces);

  // Throws BadInput unless every triangle that was extracted has been removed or handed over, and what each stage has
  // left has been taken by the next one; OverMemory for more vertices than components can be counted of.
  void check_counts() const;

  // Finishes the sinks, and the report.
  MeshReport finish();

  std::uint64_t triangles() const { return totals_.back().triangles; }  // so far

 private:
  static constexpr std::uint64_t kNotWritten = ~std::uint64_t{0};

  std::optional<CostBits> decide_to_number();
  void start_report();
  void finish_report();
  void name_known(std::size_t level, FinalPiece& piece) const;
  [[noreturn]] void refuse(const char* what, std::uint64_t expected, std::uint64_t found) const;

  const Task task_;  // with the offset of the sinks
  const BlockStages& stages_;
  const TaskList tasks_;
  const RunControl& control_;
  const Executor& executor_;
  const std::string name_;
  const World world_;
  const std::vector<MeshSink*> sinks_;
  std::vector<std::unique_ptr<FinalOutput>> outputs_;
  std::vector<std::vector<std::uint64_t>> firsts_;  // per level and task: the number of its first vertex
  std::vector<LevelCounts> totals_;                 // per level
  std::vector<std::uint64_t> left_;                 // triangles that each stage has left
  MeshReport report_;
  DecisionCounts decisions_;
  SampleRange range_;
  const CostBits head_start_;
  std::optional<BlocksToNumber> number_;  // of a run to a number of triangles
};

}  // namespace isoweave
