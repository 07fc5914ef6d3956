#include "pipeline/parts/task_work.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace isoweave {

void TaskResult::write_mesh(StateWriter& state) {
  if (kept) return kept->write(state);
  for (const std::vector<FinalPiece>& level : pieces) write_final_pieces(state, level);
}

void TaskResult::read_mesh(StateReader& state, const PartShape& shape, bool to_number) {
  pieces.resize(shape.ends.size());
  if (to_number) return kept.emplace().read(state, shape);
  for (std::vector<FinalPiece>& level : pieces) read_final_pieces(state, level);
}

CostBits limit_of_tasks(const SimplifyTask& task, CostBits head_start) {
  return task.goal.given() ? std::min(head_start, task.zone.retire) : task.zone.retire;
}

TaskWork::TaskWork(const Task& task, CostBits limit, const BlockStages& stages, std::uint64_t number,
                   const RunControl& control, const Executor& executor, std::function<void()> between)
    : task_(task),
      stages_(stages),
      number_(number),
      tasks_(stages.tasks()),
      stage_(tasks_.stage_of(number)),
      between_(std::move(between)),
      worker_(task, limit, stages.all, control, executor, report_,
              [this](Simplifier& simplifier, std::size_t level) { take(simplifier, level); }) {
  if (task.simplify.goal.given()) result_.kept.emplace();
  result_.pieces.resize(task.simplify.level_costs.size() + 1);
  result_.facts.levels.resize(result_.pieces.size());
}

TaskResult TaskWork::extract(const VolumeOpener& open) {
  const CellBox cells = stages_.grids[0].cells(stages_.block(0, number_), stages_.all);
  if (cells.empty()) return std::move(result_);
  SlabRecord record;
  return result_of(worker_.extract(open(), cells, 0, record));
}

TaskResult TaskWork::glue(std::vector<ZonePart> parts) {
  if (parts.empty()) return std::move(result_);
  return result_of(worker_.glue(std::move(parts)));
}

void TaskWork::take(Simplifier& simplifier, std::size_t level) {
  if (!result_.kept) {
    keep_final(simplifier, level);
  } else if (ZonePart part = simplifier.take_settled(result_.kept->least); part.triangles.size() > 0) {
    result_.kept->parts.push_back(std::move(part));
  }
  between_();
}

// Keeps what is final in a level until the task is done.
void TaskWork::keep_final(Simplifier& simplifier, std::size_t level) {
  LevelCounts& counts = result_.facts.levels[level];
  FinalSource& source = simplifier.final_source(level);
  do {
    FinalPiece piece;
    source.take_final({(number_ << kPlaceBits) + counts.vertices, 0}, piece);
    counts.vertices += piece.positions.size();
    counts.triangles += piece.triangles.size();
    counts.open_edges += piece.open_edges;
    if (piece.positions.size() + piece.triangles.size() > 0) result_.pieces[level].push_back(std::move(piece));
  } while (source.has_more());
}

TaskResult TaskWork::result_of(ZonePart rest) {
  if (rest.triangles.size() > 0) result_.parts = split(std::move(rest));
  count();
  return std::move(result_);
}

std::vector<SplitPart> TaskWork::split(ZonePart rest) const {
  if (stage_ + 1 == tasks_.stages.size()) {
    throw std::logic_error(std::to_string(rest.triangles.size()) + " triangles are left undecided");
  }
  const std::uint64_t first = tasks_.first_of(stage_ + 1);
  const BlockRange takers = stages_.takers(stage_, stages_.block(stage_, number_ - tasks_.first_of(stage_)));
  const VertexNumbering& numbering = task_.simplify.zone.numbering;
  return split_part(std::move(rest), [&](std::uint64_t id) {
    const BlockIndex block = takers.nearest(stages_.grids[stage_ + 1].block_of(numbering.place(id).low));
    return static_cast<std::size_t>(first + stages_.number(stage_ + 1, block));
  });
}

void TaskWork::count() {
  const BlockTotals& totals = worker_.totals();
  TaskCounts& counts = result_.facts.counts;
  counts.cells = report_.cells_crossed;
  counts.triangles_extracted = report_.triangles_extracted;
  counts.vertices_extracted = report_.vertices_extracted;
  counts.taken = totals.triangles;
  counts.rounds = totals.rounds;
  counts.decisions = totals.decisions;
  counts.range = totals.range;
  if (result_.kept) result_.kept->removed.merge(totals.removed);
  for (std::size_t level = 0; level < result_.pieces.size(); ++level) {
    result_.facts.levels[level].defects = totals.defects[level];
  }
  for (const SplitPart& part : result_.parts) {
    counts.left += part.part.triangles.size();
    result_.facts.parts.push_back({part.owner, part.part.triangles.size()});
  }
}

}  // namespace isoweave
