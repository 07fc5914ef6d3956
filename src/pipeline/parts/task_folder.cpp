#include "pipeline/parts/task_folder.hpp"

#include <algorithm>
#include <utility>

#include "isoweave/error.hpp"

namespace isoweave {
namespace {

constexpr const char* kKind = "file of a task";

TaskFacts facts_in(StateReader& reader, const TaskIdentity& identity, std::uint64_t task, std::size_t levels) {
  identity.require(reader, task);
  TaskFacts facts;
  facts.read(reader, levels);
  return facts;
}

}  // namespace

void write_result(const std::string& folder, const TaskIdentity& identity, std::uint64_t task, TaskResult& result) {
  StateWriter final(final_file(folder, task));
  identity.write(final, task);
  for (const std::vector<FinalPiece>& level : result.pieces) write_final_pieces(final, level);
  final.commit();
  StateWriter rest(rest_file(folder, task));
  identity.write(rest, task);
  result.facts.write(rest);
  for (SplitPart& part : result.parts) write_part(rest, part.part);
  rest.commit();
}

TaskFacts read_facts(const std::string& folder, const TaskIdentity& identity, std::uint64_t task, std::size_t levels) {
  StateReader reader(rest_file(folder, task), kKind);
  return facts_in(reader, identity, task, levels);
}

std::vector<std::vector<FinalPiece>> read_finals(const std::string& folder, const TaskIdentity& identity,
                                                 std::uint64_t task, std::size_t levels) {
  StateReader reader(final_file(folder, task), kKind);
  identity.require(reader, task);
  std::vector<std::vector<FinalPiece>> pieces(levels);
  for (std::vector<FinalPiece>& level : pieces) read_final_pieces(reader, level);
  reader.require_end();
  return pieces;
}

TaskResult read_result(const std::string& folder, const TaskIdentity& identity, std::uint64_t task,
                       const PartShape& shape) {
  TaskResult result;
  StateReader reader(rest_file(folder, task), kKind);
  result.facts = facts_in(reader, identity, task, shape.ends.size());
  for (const TaskPart& part : result.facts.parts) result.parts.push_back({part.task, read_cut_part(reader, shape)});
  result.pieces = read_finals(folder, identity, task, shape.ends.size());
  return result;
}

std::vector<ZonePart> read_parts_for(const std::string& folder, const TaskIdentity& identity, std::uint64_t task,
                                     const std::vector<std::uint64_t>& from, const PartShape& shape) {
  std::vector<ZonePart> parts;
  for (const std::uint64_t giver : from) {
    StateReader reader(rest_file(folder, giver), kKind);
    const TaskFacts facts = facts_in(reader, identity, giver, shape.ends.size());
    const auto ours =
        std::find_if(facts.parts.begin(), facts.parts.end(), [&](const TaskPart& part) { return part.task == task; });
    if (ours == facts.parts.end()) continue;
    for (auto part = facts.parts.begin(); part != ours; ++part) read_cut_part(reader, shape);
    parts.push_back(read_cut_part(reader, shape));
  }
  return parts;
}

}  // namespace isoweave
