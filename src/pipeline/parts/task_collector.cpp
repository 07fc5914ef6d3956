#include "pipeline/parts/task_collector.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "isoweave/error.hpp"
#include "pipeline/parts/task_work.hpp"
#include "pipeline/run_report.hpp"
#include "system/process_memory.hpp"

namespace isoweave {
namespace {

// A piece as a source of final triangles. It has labels for all vertices, which are never too many.
class KeptPiece final : public FinalSource {
 public:
  explicit KeptPiece(FinalPiece& piece) : piece_(piece) {}

  void take_final(const Receipt&, FinalPiece& piece) override { std::swap(piece, piece_); }
  std::size_t held_vertices() const override { return std::numeric_limits<std::size_t>::max(); }
  void change_labels(const std::function<void(std::span<std::uint32_t*>)>&) override {}

 private:
  FinalPiece& piece_;
};

Task with_offset(Task task, const std::array<double, 3>& offset) {
  task.offset = offset;
  return task;
}

std::uint64_t task_of(const KnownVertex& vertex) { return vertex.receipt.number >> kPlaceBits; }

}  // namespace

TaskCollector::TaskCollector(Task task, CostBits head_start, const BlockStages& stages,
                             std::span<MeshSink* const> sinks, const RunControl& control, const Executor& executor,
                             std::string name, const std::string& scratch)
    : task_(with_offset(std::move(task), common_offset(sinks))),
      stages_(stages),
      tasks_(stages.tasks()),
      control_(control),
      executor_(executor),
      name_(std::move(name)),
      world_(task_.volume.geometry, task_.space, task_.offset),
      sinks_(sinks.begin(), sinks.end()),
      firsts_(sinks.size(), std::vector<std::uint64_t>(tasks_.count(), kNotWritten)),
      totals_(sinks.size()),
      left_(tasks_.stages.size(), 0),
      head_start_(head_start) {
  for (MeshSink* sink : sinks_) {
    outputs_.push_back(std::make_unique<FinalOutput>(world_, *sink, executor_, control.measure));
  }
  start_report();
  if (!task_.simplify.goal.given()) return;
  number_.emplace(task_, stages_, scratch, control_, executor_, report_);
  number_->begin(limit_of_tasks(task_.simplify, head_start));
}

void TaskCollector::start_report() {
  report_.threads = executor_.threads();
  report_errors(task_.simplify, report_);
  warn_of_space(task_, report_);
  warn_of_rounding(task_, report_);
  report_.blocks.resize(tasks_.stages.size());
  for (std::size_t stage = 0; stage < report_.blocks.size(); ++stage) {
    report_.blocks[stage].size = stages_.grids[stage].size;
  }
}

void TaskCollector::count(std::uint64_t task, const TaskFacts& facts) {
  for (std::size_t level = 0; level < totals_.size(); ++level) {
    totals_[level].vertices += facts.levels[level].vertices;
    totals_[level].triangles += facts.levels[level].triangles;
    totals_[level].defects += facts.levels[level].defects;
  }
  const TaskCounts& counts = facts.counts;
  const std::size_t stage = tasks_.stage_of(task);
  report_.cells_crossed += counts.cells;
  report_.triangles_extracted += counts.triangles_extracted;
  report_.vertices_extracted += counts.vertices_extracted;
  report_.rounds += counts.rounds;
  report_.blocks[stage].blocks += static_cast<std::uint64_t>(counts.taken > 0);
  report_.blocks[stage].triangles += counts.taken;
  left_[stage] += counts.left;
  decisions_ += counts.decisions;
  range_.merge(counts.range);
}

bool TaskCollector::can_write(std::uint64_t task, const std::vector<std::vector<FinalPiece>>& pieces) const {
  for (std::size_t level = 0; level < pieces.size(); ++level) {
    for (const FinalPiece& piece : pieces[level]) {
      const bool written = std::all_of(piece.known.begin(), piece.known.end(), [&](const KnownVertex& vertex) {
        const std::uint64_t from = task_of(vertex);
        return from == task || (from < tasks_.count() && firsts_[level][to_size(from)] != kNotWritten);
      });
      if (!written) return false;
    }
  }
  return true;
}

void TaskCollector::write(std::uint64_t task, std::vector<std::vector<FinalPiece>> pieces) {
  for (std::size_t level = 0; level < outputs_.size(); ++level) {
    firsts_[level][to_size(task)] = outputs_[level]->end().number;
    for (FinalPiece& piece : pieces[level]) {
      name_known(level, piece);
      KeptPiece source(piece);
      outputs_[level]->take(source);
    }
  }
}

// Gives the known vertices of a piece their numbers in the mesh.
void TaskCollector::name_known(std::size_t level, FinalPiece& piece) const {
  const std::uint64_t end = outputs_[level]->end().number;
  for (KnownVertex& vertex : piece.known) {
    const std::uint64_t from = task_of(vertex);
    const std::uint64_t place = vertex.receipt.number & ((std::uint64_t{1} << kPlaceBits) - 1);
    const std::uint64_t first = from < tasks_.count() ? firsts_[level][to_size(from)] : kNotWritten;
    if (first == kNotWritten || place >= end - first) {
      throw BadInput(name_ + ": final triangles are damaged: expected vertices that have been handed over before");
    }
    vertex.receipt.number = first + place;
    vertex.receipt.label = static_cast<std::uint32_t>(vertex.receipt.number);
  }
}

void TaskCollector::check_counts() const {
  const std::uint64_t expected = report_.triangles_extracted - decisions_.removed;
  const std::uint64_t found = number_ ? number_->kept() : totals_.back().triangles;
  if (found != expected) refuse("triangles", expected, found);
  if (number_ && number_->totals().removed.items() != decisions_.removed) {
    refuse("removed triangles with their costs", decisions_.removed, number_->totals().removed.items());
  }
  for (std::size_t stage = 0; stage + 1 < left_.size(); ++stage) {
    const std::uint64_t taken = report_.blocks[stage + 1].triangles;
    if (left_[stage] != taken) refuse("triangles that a stage takes over", left_[stage], taken);
  }
  if (control_.measure && totals_.back().vertices >= std::numeric_limits<std::uint32_t>::max()) {
    throw OverMemory(name_ + ": expected fewer than 2^32 vertices where components are counted, found " +
                     std::to_string(totals_.back().vertices));
  }
}

std::optional<CostBits> TaskCollector::end_at_number() {
  try {
    return decide_to_number();
  } catch (const UnfitParts& unfit) {
    throw BadInput(name_ + ": the results of the tasks do not fit together: " + unfit.what());
  }
}

std::optional<CostBits> TaskCollector::decide_to_number() {
  BlockTotals tasks;
  tasks.decisions = decisions_;
  tasks.rounds = report_.rounds;
  number_->count(tasks);
  if (const std::optional<CostBits> lower = number_->thin()) {
    if (*lower < head_start_) return lower;
    throw BadInput(name_ + ": the results of the tasks do not fit together: expected costs that tell how far to go");
  }
  const std::unique_ptr<Simplifier> simplifier = number_->finish();
  check_memory_of_blocks(task_, control_, stages_.grids[0].size);
  outputs_.back()->take(simplifier->final_source());
  decisions_ = number_->totals().decisions;
  report_.rounds = number_->totals().rounds;
  totals_.back().defects = simplifier->defects();
  return std::nullopt;
}

void TaskCollector::refuse(const char* what, std::uint64_t expected, std::uint64_t found) const {
  throw BadInput(name_ + ": the results of the tasks do not fit together: expected " + std::to_string(expected) + ' ' +
                 what + ", found " + std::to_string(found));
}

void TaskCollector::finish_report() {
  for (const auto& output : outputs_) output->wait();
  for (std::size_t level = 0; level < outputs_.size(); ++level) {
    SurfaceReport& mesh = level + 1 == outputs_.size() ? report_ : report_.levels[level];
    outputs_[level]->report(mesh);
    report_defects(totals_[level].defects, mesh);
  }
  report_decisions(decisions_, report_);
  report_samples(task_.volume, range_, report_);
  if (number_) report_target(decisions_, task_.simplify, number_->number(), report_);
  while (report_.blocks.size() > 1 && report_.blocks.back().blocks == 0) report_.blocks.pop_back();
  warn_of_border(task_, report_);
  warn_of_nothing(task_, control_.allow_empty, report_);
}

MeshReport TaskCollector::finish() {
  finish_report();
  for (MeshSink* sink : sinks_) sink->finish();
  report_.peak_bytes = system::peak_bytes();
  return std::move(report_);
}

}  // namespace isoweave
