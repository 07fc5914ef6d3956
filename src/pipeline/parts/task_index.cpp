#include "pipeline/parts/task_index.hpp"

#include <algorithm>

#include "isoweave/error.hpp"
#include "system/file_facts.hpp"

namespace isoweave {

bool TaskIndex::is_complete(const std::string& folder, const TaskList& tasks, std::size_t stage) {
  const std::uint64_t first = tasks.first_of(stage);
  for (std::uint64_t task = first; task < first + tasks.stages[stage]; ++task) {
    if (!has_rest(folder, task)) return false;
  }
  return true;
}

TaskIndex::TaskIndex(const std::string& folder, const TaskIdentity& identity, const TaskList& tasks, std::size_t stage,
                     std::size_t levels)
    : folder_(folder), identity_(identity), levels_(levels) {
  const std::string path = folder + "/stage-" + std::to_string(stage) + ".index";
  if (system::facts_of_file(path)) {
    StateReader reader(path, "index of a stage");
    identity_.require(reader, stage);
    reader.list(links_);
    reader.require_end();
    return;
  }
  make(tasks, stage);
  StateWriter writer(path);
  identity_.write(writer, stage);
  writer.list(links_);
  writer.commit();
}

void TaskIndex::make(const TaskList& tasks, std::size_t stage) {
  const std::uint64_t first = tasks.first_of(stage);
  for (std::uint64_t task = first; task < first + tasks.stages[stage]; ++task) {
    StateReader reader(rest_file(folder_, task), "file of a task");
    identity_.require(reader, task);
    TaskFacts facts;
    facts.read(reader, levels_);
    for (const TaskPart& part : facts.parts) links_.push_back({part.task, task});
  }
  std::sort(links_.begin(), links_.end());
}

std::vector<std::uint64_t> TaskIndex::sources_of(std::uint64_t task) const {
  std::vector<std::uint64_t> sources;
  const auto first = std::lower_bound(links_.begin(), links_.end(), Link{task, 0});
  for (auto link = first; link != links_.end() && link->to == task; ++link) sources.push_back(link->from);
  return sources;
}

ZonePart TaskIndex::read_part(std::uint64_t from, std::uint64_t to, const PartShape& shape) const {
  StateReader reader(rest_file(folder_, from), "file of a task");
  identity_.require(reader, from);
  TaskFacts facts;
  facts.read(reader, levels_);
  for (const TaskPart& part : facts.parts) {
    ZonePart found = read_cut_part(reader, shape);
    if (part.task == to) return found;
  }
  throw BadInput(rest_file(folder_, from) + ": expected a part for task " + std::to_string(to) + ", found none");
}

}  // namespace isoweave
