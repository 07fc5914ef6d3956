// The results of tasks in the files of a folder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/parts/task_work.hpp"

namespace isoweave {

// Writes the two files of a task. Throws CannotWrite.
void write_result(const std::string& folder, const TaskIdentity& identity, std::uint64_t task, TaskResult& result);

// Reads the counts of a task that is done, and its final triangles in each of so many levels. Throw BadInput.
TaskFacts read_facts(const std::string& folder, const TaskIdentity& identity, std::uint64_t task, std::size_t levels);
std::vector<std::vector<FinalPiece>> read_finals(const std::string& folder, const TaskIdentity& identity,
                                                 std::uint64_t task, std::size_t levels);

// Reads the result of a task that is done. shape: that of its parts. Throws BadInput.
TaskResult read_result(const std::string& folder, const TaskIdentity& identity, std::uint64_t task,
                       const PartShape& shape);

// Reads the parts that tasks which are done have left for another one. Throws BadInput.
std::vector<ZonePart> read_parts_for(const std::string& folder, const TaskIdentity& identity, std::uint64_t task,
                                     const std::vector<std::uint64_t>& from, const PartShape& shape);

}  // namespace isoweave
