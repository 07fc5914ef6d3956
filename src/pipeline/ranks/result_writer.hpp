// Rank 0's side of the results: they come in any order, and are written when those that they follow have been.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/parts/task_collector.hpp"
#include "pipeline/parts/task_work.hpp"

namespace isoweave {

class ResultWriter {
 public:
  explicit ResultWriter(TaskCollector& collector) : collector_(collector) {}

  // Takes the counts of a task, and its part of the mesh. Of a run to a number of triangles nothing is written yet.
  void take(std::uint64_t task, TaskResult result);

  std::uint64_t tasks() const { return tasks_; }  // taken so far
  bool waits() const { return !waiting_.empty(); }

 private:
  struct Waiting {
    std::uint64_t task;
    std::vector<std::vector<FinalPiece>> pieces;
  };

  bool write_some();

  TaskCollector& collector_;
  std::vector<Waiting> waiting_;
  std::uint64_t tasks_ = 0;
};

}  // namespace isoweave
