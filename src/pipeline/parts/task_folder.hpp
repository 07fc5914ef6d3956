// The results of tasks in the files of a folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/parts/task_work.hpp"

namespace isoweave {

// Writes the two files of a task. Throws CannotWrite.
void write_result(const std::string& folder, const TaskIdentity& identity, std::uint64_t task, TaskResult& result);

// The files that tasks of a mesh have left in a folder. The arguments must outlive it.
class TaskFolder {
 public:
  TaskFolder(const std::string& folder, const TaskIdentity& identity, const SimplifyTask& task)
      : folder_(folder), identity_(identity), shape_(cut_part_shape(task)), to_number_(task.goal.given()) {}

  // The counts of a task that is done, and its result without the parts for others. Throw BadInput.
  TaskFacts facts(std::uint64_t task) const;
  TaskResult mesh(std::uint64_t task) const;

  // Reads the whole result of a task that is done. Throws BadInput.
  TaskResult result(std::uint64_t task) const;

  // Reads the parts that tasks which are done have left for another one. Throws BadInput.
  std::vector<ZonePart> parts_for(std::uint64_t task, const std::vector<std::uint64_t>& from) const;

 private:
  TaskFacts read_facts(StateReader& reader, std::uint64_t task) const;

  const std::string& folder_;
  const TaskIdentity& identity_;
  const PartShape shape_;
  const bool to_number_;
};

}  // namespace isoweave
