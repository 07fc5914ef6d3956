#include "pipeline/parts/task_folder.hpp"

#include <algorithm>
#include <utility>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr const char* kKind = "file of a task";

}  // namespace

void write_result(const std::string& folder, const TaskIdentity& identity, std::uint64_t task, TaskResult& result) {
  StateWriter final(final_file(folder, task));
  identity.write(final, task);
  result.write_mesh(final);
  final.commit();
  StateWriter rest(rest_file(folder, task));
  identity.write(rest, task);
  result.facts.write(rest);
  for (SplitPart& part : result.parts) write_part(rest, part.part);
  rest.commit();
}

TaskFacts TaskFolder::read_facts(StateReader& reader, std::uint64_t task) const {
  identity_.require(reader, task);
  TaskFacts facts;
  facts.read(reader, shape_.ends.size());
  return facts;
}

TaskFacts TaskFolder::facts(std::uint64_t task) const {
  StateReader reader(rest_file(folder_, task), kKind);
  return read_facts(reader, task);
}

TaskResult TaskFolder::mesh(std::uint64_t task) const {
  StateReader reader(final_file(folder_, task), kKind);
  identity_.require(reader, task);
  TaskResult result;
  result.read_mesh(reader, shape_, to_number_);
  reader.require_end();
  return result;
}

TaskResult TaskFolder::result(std::uint64_t task) const {
  TaskResult result = mesh(task);
  StateReader reader(rest_file(folder_, task), kKind);
  result.facts = read_facts(reader, task);
  for (const TaskPart& part : result.facts.parts) result.parts.push_back({part.task, read_cut_part(reader, shape_)});
  return result;
}

std::vector<ZonePart> TaskFolder::parts_for(std::uint64_t task, const std::vector<std::uint64_t>& from) const {
  std::vector<ZonePart> parts;
  for (const std::uint64_t giver : from) {
    StateReader reader(rest_file(folder_, giver), kKind);
    const TaskFacts facts = read_facts(reader, giver);
    const auto ours =
        std::find_if(facts.parts.begin(), facts.parts.end(), [&](const TaskPart& part) { return part.task == task; });
    if (ours == facts.parts.end()) continue;
    for (auto part = facts.parts.begin(); part != ours; ++part) read_cut_part(reader, shape_);
    parts.push_back(read_cut_part(reader, shape_));
  }
  return parts;
}

}  // namespace isoweave
