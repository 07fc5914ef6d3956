// Which tasks of a stage have left parts for which tasks of the next one.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "isoweave/tasks.hpp"
#include "pipeline/parts/task_file.hpp"
#include "simplify/zone_part.hpp"

namespace isoweave {

class TaskIndex {
 public:
  // Whether all tasks of a stage are done.
  static bool is_complete(const std::string& folder, const TaskList& tasks, std::size_t stage);

  // Reads the index of a stage that is complete, or makes it and keeps it for other tasks: it is the same whoever makes
  // it. Throws BadInput for a file of the folder that is damaged or of another mesh. All arguments but the list of
  // tasks must outlive the index.
  TaskIndex(const std::string& folder, const TaskIdentity& identity, const TaskList& tasks, std::size_t stage,
            std::size_t levels);

  // The tasks that have left a part for a task, ascending.
  std::vector<std::uint64_t> sources_of(std::uint64_t task) const;

  // Reads the part that one task has left for another.
  ZonePart read_part(std::uint64_t from, std::uint64_t to, const PartShape& shape) const;

 private:
  struct Link {
    std::uint64_t to = 0, from = 0;

    bool operator<(const Link& other) const { return to != other.to ? to < other.to : from < other.from; }
  };

  void make(const TaskList& tasks, std::size_t stage);

  const std::string& folder_;
  const TaskIdentity& identity_;
  const std::size_t levels_;
  std::vector<Link> links_;  // ascending
};

}  // namespace isoweave
